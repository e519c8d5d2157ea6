/* solve/opencl_api.c: the loader, opened at run time [solve/opencl_api.h]. */
#include "solve/opencl_api.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
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
        failure_set(
            failure, EX_UNAVAILABLE,
            "--device opencl: no OpenCL here, %s: install ocl-icd-libopencl1 and the driver of "
            "the GPU, or leave --device out",
            dlerror());
        return;
    }
#define FIND(result, name, arguments)                                                              \
    {                                                                                              \
        void *at = dlsym(opened, #name);                                                           \
        if (!at) {                                                                                 \
            failure_set(failure, EX_UNAVAILABLE,                                                   \
                        "--device opencl: %s has no %s: it is no OpenCL 1.2", LOADER, #name);      \
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

/* ---- the assembler takes the files in as they are ---- */

#define EACH_TEXT(X)                                                                               \
    X(begin, "lib/solve/opencl/begin.cl")                                                          \
    X(lanes, "lib/base/lanes.h")                                                                   \
    X(local, "lib/solve/local.h")                                                                  \
    X(sbp, "lib/solve/local_sbp.h")                                                                \
    X(sal, "lib/solve/local_sal.h")                                                                \
    X(exact, "lib/solve/local_exact.h")                                                            \
    X(newton, "lib/solve/local_newton.h")                                                          \
    X(ebp, "lib/solve/local_ebp.h")                                                                \
    X(eal, "lib/solve/local_eal.h")                                                                \
    X(bundle, "lib/solve/bundle.h")                                                                \
    X(kernels, "lib/solve/opencl/kernels.cl")

#define TAKE_IN(name, file)                                                                        \
    __asm__(".section .rodata\n.hidden nsd_cl_" #name "\n.globl nsd_cl_" #name "\nnsd_cl_" #name   \
            ":\n.incbin \"" file "\"\n.byte 0\n.previous\n");                                      \
    extern const char nsd_cl_##name[];
EACH_TEXT(TAKE_IN)

#define TEXT(name, file) nsd_cl_##name,
static const char *const texts[] = { EACH_TEXT(TEXT) };
enum { TEXTS = sizeof texts / sizeof *texts };

/* Appends a text but for its includes, whose lines stay, empty. */
static char *opencl_api_append(char *to, const char *text)
{
    while (*text) {
        size_t n = strcspn(text, "\n");
        if (strncmp(text, "#include", 8)) memcpy(to, text, n), to += n;
        *to++ = '\n';
        text += n + (text[n] == '\n');
    }
    return to;
}

char *opencl_text(void)
{
    size_t size = 1;
    for (int k = 0; k < TEXTS; k++) size += strlen(texts[k]) + 1;
    char *all = malloc(size), *end = all;
    for (int k = 0; all && k < TEXTS; k++) end = opencl_api_append(end, texts[k]);
    if (all) *end = 0;
    return all;
}
