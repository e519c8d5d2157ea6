/*
 * fake_opencl.c: the machine's libOpenCL.so.1 with a fault of FAKE_OPENCL: "none", no device; "nofp64"; "memory", 64 KB
 * of it; "wrong", products are contracted with sums; "broken", kernels that do not compile; "lost:N", the device is
 * lost at the Nth launch. FAKE_OPENCL_REAL is the path of the real one. Tests put it into LD_LIBRARY_PATH.
 */
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *real(const char *name)
{
    static void *loader;
    if (!loader) loader = dlopen(getenv("FAKE_OPENCL_REAL"), RTLD_NOW);
    void *at = loader ? dlsym(loader, name) : NULL;
    if (!at) fprintf(stderr, "fake_opencl: no %s\n", name), abort();
    return at;
}

static int is(const char *fault)
{
    const char *asked = getenv("FAKE_OPENCL");
    return asked && !strcmp(asked, fault);
}

/* Every call as it is: up to nine integers and pointers, all of which go in registers or on the stack alike */
#define FORWARD(name)                                                                              \
    intptr_t name(intptr_t a, intptr_t b, intptr_t c, intptr_t d, intptr_t e, intptr_t f,          \
                  intptr_t g, intptr_t h, intptr_t i)                                              \
    {                                                                                              \
        intptr_t (*to)(intptr_t, intptr_t, intptr_t, intptr_t, intptr_t, intptr_t, intptr_t,       \
                       intptr_t, intptr_t) = real(#name);                                          \
        return to(a, b, c, d, e, f, g, h, i);                                                      \
    }
FORWARD(clGetPlatformInfo)
FORWARD(clGetDeviceIDs)
FORWARD(clCreateContext)
FORWARD(clReleaseContext)
FORWARD(clCreateCommandQueue)
FORWARD(clReleaseCommandQueue)
FORWARD(clBuildProgram)
FORWARD(clGetProgramBuildInfo)
FORWARD(clReleaseProgram)
FORWARD(clCreateKernel)
FORWARD(clReleaseKernel)
FORWARD(clSetKernelArg)
FORWARD(clCreateBuffer)
FORWARD(clReleaseMemObject)
FORWARD(clEnqueueReadBuffer)
FORWARD(clEnqueueWriteBuffer)
FORWARD(clEnqueueCopyBuffer)
FORWARD(clFinish)

int32_t clGetPlatformIDs(uint32_t room, void **platform, uint32_t *n)
{
    int32_t (*to)(uint32_t, void **, uint32_t *) = real("clGetPlatformIDs");
    if (!is("none")) return to(room, platform, n);
    *n = 0;
    return -1001;
}

int32_t clGetDeviceInfo(void *device, uint32_t what, size_t room, void *value, size_t *n)
{
    int32_t (*to)(void *, uint32_t, size_t, void *, size_t *) = real("clGetDeviceInfo");
    int32_t error = to(device, what, room, value, n);
    uint64_t zero = 0, little = 65536;
    if (!error && value && is("nofp64") && what == 0x1032) memcpy(value, &zero, sizeof zero);
    if (!error && value && is("memory") && what == 0x101F) memcpy(value, &little, sizeof little);
    return error;
}

void *clCreateProgramWithSource(void *context, uint32_t n, const char **text, const size_t *length,
                                int32_t *error)
{
    void *(*to)(void *, uint32_t, const char **, const size_t *, int32_t *) =
        real("clCreateProgramWithSource");
    char *own = strdup(text[0]), *at = strstr(own, "FP_CONTRACT OFF");
    if (is("wrong")) memcpy(at, "FP_CONTRACT ON ", 15);
    if (is("broken")) memcpy(own, "not C ", 6);
    void *program = to(context, n, (const char *[]){ own }, length, error);
    free(own);
    return program;
}

int32_t clEnqueueNDRangeKernel(void *queue, void *kernel, uint32_t dimensions, const size_t *offset,
                               const size_t *global, const size_t *local, uint32_t waits,
                               void *const *wait, void **event)
{
    int32_t (*to)(void *, void *, uint32_t, const size_t *, const size_t *, const size_t *,
                  uint32_t, void *const *, void **) = real("clEnqueueNDRangeKernel");
    static long launches;
    const char *fault = getenv("FAKE_OPENCL");
    launches++;
    if (fault && !strncmp(fault, "lost:", 5) && launches >= atol(fault + 5)) return -36;
    return to(queue, kernel, dimensions, offset, global, local, waits, wait, event);
}
