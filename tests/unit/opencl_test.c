/* What is declared of OpenCL is what Khronos' headers declare, and each file of the kernels is in their text once. */
#include "tap.h"

#include "solve/opencl_api.h"

#include <stdlib.h>
#include <string.h>

#ifdef __has_include
#if __has_include(<CL/cl.h>)
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#endif
#endif

#ifdef CL_TARGET_OPENCL_VERSION
static void test_numbers(void)
{
    ok(OCL_TRUE == CL_TRUE && OCL_BUILD_PROGRAM_FAILURE == CL_BUILD_PROGRAM_FAILURE &&
           OCL_MEM_READ_WRITE == CL_MEM_READ_WRITE && OCL_PLATFORM_NAME == CL_PLATFORM_NAME &&
           OCL_DEVICE_TYPE == CL_DEVICE_TYPE && OCL_DEVICE_TYPE_CPU == CL_DEVICE_TYPE_CPU &&
           OCL_DEVICE_TYPE_GPU == CL_DEVICE_TYPE_GPU &&
           OCL_DEVICE_MAX_WORK_GROUP_SIZE == CL_DEVICE_MAX_WORK_GROUP_SIZE &&
           OCL_DEVICE_MAX_MEM_ALLOC_SIZE == CL_DEVICE_MAX_MEM_ALLOC_SIZE &&
           OCL_DEVICE_GLOBAL_MEM_SIZE == CL_DEVICE_GLOBAL_MEM_SIZE &&
           OCL_DEVICE_NAME == CL_DEVICE_NAME &&
           OCL_DEVICE_DOUBLE_FP_CONFIG == CL_DEVICE_DOUBLE_FP_CONFIG &&
           OCL_PROGRAM_BUILD_LOG == CL_PROGRAM_BUILD_LOG &&
           OCL_DEVICE_TYPE_ALL == CL_DEVICE_TYPE_ALL,
       "the constants are those of CL/cl.h");
    ok(sizeof(cl_int) == 4 && sizeof(cl_bool) == 4 && sizeof(cl_device_info) == 4 &&
           sizeof(cl_device_type) == 8 && sizeof(cl_mem_flags) == 8 &&
           sizeof(cl_command_queue_properties) == 8 && sizeof(cl_mem) == sizeof(void *),
       "so are the sizes of arguments");
}

static void test_errors(void)
{
    static const struct {
        int32_t error;
        const char *name;
    } errors[] = { { CL_OUT_OF_RESOURCES, "CL_OUT_OF_RESOURCES" },
                   { CL_MEM_OBJECT_ALLOCATION_FAILURE, "CL_MEM_OBJECT_ALLOCATION_FAILURE" },
                   { CL_OUT_OF_HOST_MEMORY, "CL_OUT_OF_HOST_MEMORY" },
                   { CL_INVALID_COMMAND_QUEUE, "CL_INVALID_COMMAND_QUEUE" },
                   { CL_INVALID_BUFFER_SIZE, "CL_INVALID_BUFFER_SIZE" },
                   { CL_INVALID_WORK_GROUP_SIZE, "CL_INVALID_WORK_GROUP_SIZE" },
                   { CL_DEVICE_NOT_AVAILABLE, "CL_DEVICE_NOT_AVAILABLE" },
                   { CL_INVALID_CONTEXT, "CL_INVALID_CONTEXT" } };
    bool good = true;
    for (size_t k = 0; k < sizeof errors / sizeof *errors; k++)
        good &= !strncmp(opencl_error(errors[k].error), errors[k].name, strlen(errors[k].name));
    ok(good, "errors have the names of CL/cl.h");
}
#endif

static int times(const char *text, const char *what)
{
    int n = 0;
    for (const char *at = text; (at = strstr(at, what)); at++) n++;
    return n;
}

static void test_text(void)
{
    char *text = opencl_text();
    ok(text && !strstr(text, "#include"), "the text of the kernels includes no other");
    ok(text && times(text, "void sbp_solve(") == 1 && times(text, "void sal_solve(") == 1 &&
           times(text, "void ebp_solve(") == 1 && times(text, "void eal_solve(") == 1 &&
           times(text, "void exact_solve(") == 1 && times(text, "void bundle_push(") == 1 &&
           times(text, "FP_CONTRACT OFF") == 1,
       "it has the methods and the geometry of the CPU, each once, and no contraction");
    free(text);
}

int main(void)
{
#ifdef CL_TARGET_OPENCL_VERSION
    test_numbers();
    test_errors();
#else
    ok(true, "declarations # SKIP there is no CL/cl.h: package opencl-c-headers");
#endif
    test_text();
    return tap_done();
}
