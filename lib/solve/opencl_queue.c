/* solve/opencl_queue.c: devices, programs, launches and memory by OpenCL 1.2 [solve/opencl_queue.h]. */
#include "solve/opencl_queue.h"

#include <stdlib.h>
#include <string.h>

enum {
    PLATFORMS = 16, /* that are looked at */
    DEVICES = 64    /* of all platforms */
};

static const char *const kernel_name[KERNELS] = {
    "sweep", "sweep_answered", "tally_counts", "push",    "velocities", "judge", "sum_parts",
    "clear", "scatter",        "remember",     "changes", "products",   "react"
};

/* ---- failures ---- */

/* Whether it works still; else why it does not */
bool opencl_good(struct opencl *o, int32_t error, const char *what)
{
    struct failure *lost = &o->device.lost;
    if (error && !lost->status)
        failure_set(
            lost, EX_UNAVAILABLE,
            "--device opencl: %s: it has failed: %s: %s: start again, or leave --device out",
            o->device.name, what, opencl_error(error));
    return !lost->status;
}

bool opencl_lost(const struct opencl *o)
{
    return o->device.lost.status != 0;
}

/* ---- the devices of the machine ---- */

static void opencl_text_of(const struct opencl_api *api, void *device, void *platform, char *text,
                           size_t room)
{
    char name[120] = "?", of[60] = "?";
    api->clGetDeviceInfo(device, OCL_DEVICE_NAME, sizeof name - 1, name, NULL);
    api->clGetPlatformInfo(platform, OCL_PLATFORM_NAME, sizeof of - 1, of, NULL);
    snprintf(text, room, "%s (%s)", name, of);
    failure_plain(text);
}

/* All devices, in the order of their platforms; returns their number */
static int devices_of(const struct opencl_api *api, void *device[DEVICES], void *platform[DEVICES])
{
    void *all[PLATFORMS];
    uint32_t platforms = 0;
    int n = 0;
    if (api->clGetPlatformIDs(PLATFORMS, all, &platforms)) return 0;
    for (uint32_t k = 0; k < platforms && k < PLATFORMS; k++) {
        uint32_t more = 0;
        if (n == DEVICES || api->clGetDeviceIDs(all[k], OCL_DEVICE_TYPE_ALL,
                                                (uint32_t)(DEVICES - n), device + n, &more))
            continue;
        for (uint32_t i = 0; i < more && n < DEVICES; i++) platform[n++] = all[k];
    }
    return n;
}

static uint64_t opencl_number_of(const struct opencl_api *api, void *device, uint32_t what)
{
    uint64_t x = 0;
    api->clGetDeviceInfo(device, what, sizeof x, &x, NULL);
    return x;
}

static int none(struct failure *failure)
{
    return failure_set(failure, EX_UNAVAILABLE,
                       "--device opencl: no device has a driver here: install that of the GPU, or "
                       "leave --device out");
}

int opencl_list(FILE *to, struct failure *failure)
{
    void *device[DEVICES], *platform[DEVICES];
    const struct opencl_api *api = opencl_api(failure);
    int n = api ? devices_of(api, device, platform) : 0;
    if (!n) return none(failure);
    for (int k = 0; k < n; k++) {
        char name[200];
        opencl_text_of(api, device[k], platform[k], name, sizeof name);
        uint64_t type = opencl_number_of(api, device[k], OCL_DEVICE_TYPE);
        fprintf(to, "opencl:%d\t%s\t%s\t%.3g GB%s\n", k,
                type & OCL_DEVICE_TYPE_GPU   ? "GPU"
                : type & OCL_DEVICE_TYPE_CPU ? "CPU"
                                             : "other",
                name, 1e-9 * (double)opencl_number_of(api, device[k], OCL_DEVICE_GLOBAL_MEM_SIZE),
                opencl_number_of(api, device[k], OCL_DEVICE_DOUBLE_FP_CONFIG)
                    ? ""
                    : "\tno double precision: not for nsd");
    }
    return 0;
}

void opencl_close(struct device *d)
{
    struct opencl *o = (struct opencl *)d;
    const struct opencl_api *api = o->api;
    if (o->queue) api->clFinish(o->queue);
    for (int k = 0; k < ROLES; k++)
        if (o->buffer[k].memory) api->clReleaseMemObject(o->buffer[k].memory);
    for (int m = 0; m < METHOD_COUNT; m++)
        for (int v = 0; v < VARIANTS; v++) {
            for (int k = 0; k < KERNELS; k++)
                if (o->program[m][v].kernel[k]) api->clReleaseKernel(o->program[m][v].kernel[k]);
            if (o->program[m][v].program) api->clReleaseProgram(o->program[m][v].program);
        }
    if (o->queue) api->clReleaseCommandQueue(o->queue);
    if (o->context) api->clReleaseContext(o->context);
    free(o->first), free(o->list), free(o->stage), free(o);
}

/* Whether the device can do what is asked of it, and a queue for it */
static bool opencl_begin(struct opencl *o)
{
    const struct opencl_api *api = o->api;
    struct failure *failure = &o->device.lost;
    size_t team = 0;
    int32_t error = 0;
    if (!opencl_number_of(api, o->id, OCL_DEVICE_DOUBLE_FP_CONFIG)) {
        failure_set(failure, EX_UNAVAILABLE,
                    "--device opencl: %s: no double precision (fp64): take another, --device list",
                    o->device.name);
        return false;
    }
    api->clGetDeviceInfo(o->id, OCL_DEVICE_MAX_WORK_GROUP_SIZE, sizeof team, &team, NULL);
    if (team < TEAM) {
        failure_set(failure, EX_UNAVAILABLE,
                    "--device opencl: %s: work-groups of %d at most, not %d", o->device.name,
                    (int)team, TEAM);
        return false;
    }
    o->memory = opencl_number_of(api, o->id, OCL_DEVICE_GLOBAL_MEM_SIZE);
    o->largest = opencl_number_of(api, o->id, OCL_DEVICE_MAX_MEM_ALLOC_SIZE);
    o->context = api->clCreateContext(NULL, 1, &o->id, NULL, NULL, &error);
    if (!opencl_good(o, error, "no context")) return false;
    o->queue = api->clCreateCommandQueue(o->context, o->id, 0, &error);
    return opencl_good(o, error, "no queue");
}

struct device *opencl_open_device(int number, struct failure *failure)
{
    void *device[DEVICES], *platform[DEVICES];
    const struct opencl_api *api = opencl_api(failure);
    if (!api) return NULL;
    int n = devices_of(api, device, platform);
    if (!n) return none(failure), NULL;
    if (number >= n) {
        failure_set(failure, EX_UNAVAILABLE,
                    "--device opencl:%d: there are %d, from opencl:0 on: --device list", number, n);
        return NULL;
    }
    struct opencl *o = calloc(1, sizeof *o);
    if (!o || !(o->stage = malloc(STAGE * sizeof(struct bundle)))) {
        free(o);
        return failure_set(failure, EX_SOFTWARE, "--device opencl: no memory"), NULL;
    }
    o->device.kind = &device_opencl, o->api = api, o->id = device[number];
    opencl_text_of(api, device[number], platform[number], o->device.name, sizeof o->device.name);
    if (opencl_begin(o)) return &o->device;
    failure_set(failure, o->device.lost.status, "%s", o->device.lost.text);
    opencl_close(&o->device);
    return NULL;
}

/* ---- programs ---- */

static void report_build(struct opencl *o, void *program, int32_t error)
{
    size_t n = 0;
    o->api->clGetProgramBuildInfo(program, o->id, OCL_PROGRAM_BUILD_LOG, 0, NULL, &n);
    char *log = calloc(n + 1, 1), *line = log ? log : "";
    if (log) o->api->clGetProgramBuildInfo(program, o->id, OCL_PROGRAM_BUILD_LOG, n, log, NULL);
    line += strspn(line, " \t\r\n");
    failure_set(
        &o->device.lost, EX_UNAVAILABLE,
        "--device opencl: %s: its driver does not compile the kernels: %s: %.*s: take another "
        "driver, or leave --device out",
        o->device.name, opencl_error(error), (int)strcspn(line, "\n") % 150, line);
    free(log);
}

/* The kernels for a method and a variant; NULL where the driver does not compile them */
const struct program *opencl_program(struct opencl *o, enum method_id method, enum variant v)
{
    struct program *g = &o->program[method][v];
    char options[200];
    int32_t error = 0;
    if (g->program) return g;
    char *text = opencl_text();
    if (!text) return opencl_good(o, -6, "kernels"), NULL;
    g->program =
        o->api->clCreateProgramWithSource(o->context, 1, (const char *[]){ text }, NULL, &error);
    free(text);
    if (!opencl_good(o, error, "kernels")) return NULL;
    snprintf(options, sizeof options, "-cl-std=CL1.2 -DMETHOD=%s -DEXACT=%d -DGIVEN=%d -DFULL=%d",
             methods[method]->name, method == METHOD_exact, v != VARIANT_BODIES,
             v == VARIANT_BLOCKS);
    error = o->api->clBuildProgram(g->program, 1, &o->id, options, NULL, NULL);
    if (error) return report_build(o, g->program, error), NULL;
    for (int k = 0; k < KERNELS; k++) {
        g->kernel[k] = o->api->clCreateKernel(g->program, kernel_name[k], &error);
        if (!opencl_good(o, error, kernel_name[k])) return NULL;
    }
    return g;
}

/* ---- launches ---- */

uint32_t opencl_set(struct opencl *o, enum kernel_id k, uint32_t from, const struct argument *a)
{
    for (; a->size; a++, from++)
        if (!opencl_lost(o))
            opencl_good(o, o->api->clSetKernelArg(o->now->kernel[k], from, a->size, &a->value),
                        kernel_name[k]);
    return from;
}

/* At least n work-items, in teams */
void opencl_launch(struct opencl *o, enum kernel_id k, int64_t n)
{
    size_t team = TEAM, all = (size_t)((n + TEAM - 1) / TEAM) * TEAM;
    if (opencl_lost(o) || n <= 0) return;
    o->device.account.kernels++;
    opencl_good(o,
                o->api->clEnqueueNDRangeKernel(o->queue, o->now->kernel[k], 1, NULL, &all, &team, 0,
                                               NULL, NULL),
                kernel_name[k]);
}

/* ---- memory ---- */

/* A buffer of at least this size; one that is larger stays */
bool opencl_need(struct opencl *o, enum opencl_role role, size_t size)
{
    struct buffer *b = &o->buffer[role];
    int32_t error = 0;
    double GB = 1e-9;
    size = size ? size : 1;
    if (b->size >= size || opencl_lost(o)) return !opencl_lost(o);
    if (b->memory) o->api->clReleaseMemObject(b->memory);
    b->memory = NULL, b->size = 0;
    size_t all = size;
    for (int k = 0; k < ROLES; k++) all += o->buffer[k].size;
    if (all > o->memory || size > o->largest) {
        failure_set(
            &o->device.lost, EX_UNAVAILABLE,
            "--device opencl: %s: needs %.3g GB, and %.3g GB of it in one piece: it has %.3g "
            "and %.3g: leave --device out",
            o->device.name, GB * (double)all, GB * (double)size, GB * (double)o->memory,
            GB * (double)o->largest);
        return false;
    }
    b->memory = o->api->clCreateBuffer(o->context, OCL_MEM_READ_WRITE, size, NULL, &error);
    if (opencl_good(o, error, "no memory on the device")) b->size = size;
    return !opencl_lost(o);
}

void opencl_forget(struct opencl *o, enum opencl_role role)
{
    if (o->buffer[role].memory) o->api->clReleaseMemObject(o->buffer[role].memory);
    o->buffer[role] = (struct buffer){ 0 };
}

void opencl_put(struct opencl *o, enum opencl_role role, size_t offset, const void *from,
                size_t size)
{
    if (opencl_lost(o) || !size) return;
    o->device.account.to += (double)size;
    opencl_good(o,
                o->api->clEnqueueWriteBuffer(o->queue, o->buffer[role].memory, OCL_TRUE, offset,
                                             size, from, 0, NULL, NULL),
                "writing to it");
}

void opencl_take(struct opencl *o, enum opencl_role role, size_t offset, void *to, size_t size)
{
    if (opencl_lost(o) || !size) return;
    o->device.account.from += (double)size, o->device.account.waits++;
    opencl_good(o,
                o->api->clEnqueueReadBuffer(o->queue, o->buffer[role].memory, OCL_TRUE, offset,
                                            size, to, 0, NULL, NULL),
                "reading from it");
}

void opencl_copy(struct opencl *o, enum opencl_role from, enum opencl_role to, size_t size)
{
    if (opencl_lost(o)) return;
    opencl_good(o,
                o->api->clEnqueueCopyBuffer(o->queue, o->buffer[from].memory, o->buffer[to].memory,
                                            0, 0, size, 0, NULL, NULL),
                "copying");
}

/* A buffer with these bytes; none, where there are none */
void opencl_give(struct opencl *o, enum opencl_role role, const void *from, size_t size)
{
    if (!from)
        opencl_forget(o, role);
    else if (opencl_need(o, role, size))
        opencl_put(o, role, 0, from, size);
}
