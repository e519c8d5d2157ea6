/* solve/opencl_api.c: the loader, opened at run time [solve/opencl_api.h]. */
#include "solve/opencl_api.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define LOADER "libOpenCL.so.1"

/* Of the process, as its loader is */
static struct opencl_api opencl_calls;
static bool opencl_open;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static void open_loader(struct failure *failure)
{
    void *opened = dlopen(LOADER, RTLD_NOW | RTLD_LOCAL);
    if (!opened) {
        failure_set(failure, EX_UNAVAILABLE,
                "--device opencl: no OpenCL here, %s: install ocl-icd-libopencl1 and the driver of "
                "the GPU, or leave --device out",
                dlerror());
        return;
    }
#define FIND(result, name, arguments)                                                              \
    {                                                                                              \
        void *at = dlsym(opened, #name);                                                           \
        if (!at) {                                                                                 \
            failure_set(failure, EX_UNAVAILABLE, "--device opencl: %s has no %s: it is no OpenCL 1.2",     \
                    LOADER, #name);                                                                \
            dlclose(opened);                                                                       \
            return;                                                                                \
        }                                                                                          \
        memcpy(&opencl_calls.name, &at, sizeof at);                                                \
    }
    EACH_OPENCL_CALL(FIND)
    opencl_open = true;
}

const struct opencl_api *opencl_api(struct failure *failure)
{
    pthread_mutex_lock(&lock);
    if (!opencl_open) open_loader(failure);
    bool there = opencl_open;
    pthread_mutex_unlock(&lock);
    return there ? &opencl_calls : NULL;
}

const char *opencl_error(int32_t error)
{
    static const struct {
        int32_t error;
        const char *name;
    } names[] = { { -1, "CL_DEVICE_NOT_FOUND" },
                  { -2, "CL_DEVICE_NOT_AVAILABLE" },
                  { -4, "CL_MEM_OBJECT_ALLOCATION_FAILURE" },
                  { -5, "CL_OUT_OF_RESOURCES" },
                  { -6, "CL_OUT_OF_HOST_MEMORY" },
                  { -11, "CL_BUILD_PROGRAM_FAILURE" },
                  { -14, "CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST" },
                  { -34, "CL_INVALID_CONTEXT" },
                  { -36, "CL_INVALID_COMMAND_QUEUE" },
                  { -54, "CL_INVALID_WORK_GROUP_SIZE" },
                  { -61, "CL_INVALID_BUFFER_SIZE" },
                  { -1001, "CL_PLATFORM_NOT_FOUND_KHR" } };
    static _Thread_local char text[80];
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (names[k].error == error) {
            snprintf(text, sizeof text, "%s (%d)", names[k].name, error);
            return text;
        }
    snprintf(text, sizeof text, "OpenCL error %d", error);
    return text;
}
