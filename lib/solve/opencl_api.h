/*
 * solve/opencl_api.h: what is called of OpenCL 1.2. The loader of its drivers, libOpenCL.so.1, is opened when a
 * device is asked for: no tool needs it, or a header of it, to be built or to start. The declarations are those of
 * Khronos' CL/cl.h; tests/unit/opencl_test.c compares them where that is installed.
 */
#ifndef NSD_OPENCL_API_H
#define NSD_OPENCL_API_H

#include "base/failure.h"

#include <stddef.h>
#include <stdint.h>

enum {
    OCL_TRUE = 1,
    OCL_BUILD_PROGRAM_FAILURE = -11,
    OCL_MEM_READ_WRITE = 1,
    OCL_PLATFORM_NAME = 0x0902,
    OCL_DEVICE_TYPE = 0x1000,
    OCL_DEVICE_TYPE_CPU = 2,
    OCL_DEVICE_TYPE_GPU = 4,
    OCL_DEVICE_MAX_WORK_GROUP_SIZE = 0x1004,
    OCL_DEVICE_MAX_MEM_ALLOC_SIZE = 0x1010,
    OCL_DEVICE_GLOBAL_MEM_SIZE = 0x101F,
    OCL_DEVICE_NAME = 0x102B,
    OCL_DEVICE_DOUBLE_FP_CONFIG = 0x1032,
    OCL_PROGRAM_BUILD_LOG = 0x1183
};
#define OCL_DEVICE_TYPE_ALL 0xFFFFFFFFU

/* X(result, name, arguments), handles as void pointers */
#define EACH_OPENCL_CALL(X)                                                                        \
    X(int32_t, clGetPlatformIDs, (uint32_t room, void **platform, uint32_t *n))                    \
    X(int32_t, clGetPlatformInfo,                                                                  \
      (void *platform, uint32_t what, size_t room, void *to, size_t *n))                           \
    X(int32_t, clGetDeviceIDs,                                                                     \
      (void *platform, uint64_t type, uint32_t room, void **device, uint32_t *n))                  \
    X(int32_t, clGetDeviceInfo, (void *device, uint32_t what, size_t room, void *to, size_t *n))   \
    X(void *, clCreateContext,                                                                     \
      (const intptr_t *properties, uint32_t n, void *const *device, void *notify, void *with,      \
       int32_t *error))                                                                            \
    X(int32_t, clReleaseContext, (void *context))                                                  \
    X(void *, clCreateCommandQueue,                                                                \
      (void *context, void *device, uint64_t properties, int32_t *error))                          \
    X(int32_t, clReleaseCommandQueue, (void *queue))                                               \
    X(void *, clCreateProgramWithSource,                                                           \
      (void *context, uint32_t n, const char **text, const size_t *length, int32_t *error))        \
    X(int32_t, clBuildProgram,                                                                     \
      (void *program, uint32_t n, void *const *device, const char *options, void *notify,          \
       void *with))                                                                                \
    X(int32_t, clGetProgramBuildInfo,                                                              \
      (void *program, void *device, uint32_t what, size_t room, void *to, size_t *n))              \
    X(int32_t, clReleaseProgram, (void *program))                                                  \
    X(void *, clCreateKernel, (void *program, const char *name, int32_t *error))                   \
    X(int32_t, clReleaseKernel, (void *kernel))                                                    \
    X(int32_t, clSetKernelArg, (void *kernel, uint32_t index, size_t size, const void *value))     \
    X(void *, clCreateBuffer,                                                                      \
      (void *context, uint64_t flags, size_t size, void *host, int32_t *error))                    \
    X(int32_t, clReleaseMemObject, (void *buffer))                                                 \
    X(int32_t, clEnqueueReadBuffer,                                                                \
      (void *queue, void *buffer, uint32_t blocking, size_t offset, size_t size, void *to,         \
       uint32_t n, void *const *wait, void **event))                                               \
    X(int32_t, clEnqueueWriteBuffer,                                                               \
      (void *queue, void *buffer, uint32_t blocking, size_t offset, size_t size, const void *from, \
       uint32_t n, void *const *wait, void **event))                                               \
    X(int32_t, clEnqueueCopyBuffer,                                                                \
      (void *queue, void *from, void *to, size_t offset_from, size_t offset_to, size_t size,       \
       uint32_t n, void *const *wait, void **event))                                               \
    X(int32_t, clEnqueueNDRangeKernel,                                                             \
      (void *queue, void *kernel, uint32_t dimensions, const size_t *offset, const size_t *global, \
       const size_t *local, uint32_t n, void *const *wait, void **event))                          \
    X(int32_t, clFinish, (void *queue))

struct opencl_api {
// NOLINTNEXTLINE(bugprone-macro-parentheses)
#define OPENCL_CALL(result, name, arguments) result(*name) arguments;
    EACH_OPENCL_CALL(OPENCL_CALL)
#undef OPENCL_CALL
};

/* The calls, of the loader that is opened at the first time; NULL and EX_UNAVAILABLE where there is none */
const struct opencl_api *opencl_api(struct failure *failure);
/* "CL_OUT_OF_RESOURCES (-5)" of an error; for messages, until the next call */
const char *opencl_error(int32_t error);

/* The text of a device's kernels: those of the CPU where C and OpenCL C agree, in their order. */

/* The text, without the includes, which are in it already; NULL when memory is short. To be freed. */
char *opencl_text(void);

#endif
