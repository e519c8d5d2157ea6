/*
 * solve/opencl.c: a device by OpenCL 1.2 [solve/device.h]. A launch solves contacts that do not depend on each
 * other, and waits for the one before it: the queue is in order.
 */
#include "solve/device.h"
#include "solve/local_exact.h"
#include "solve/opencl_api.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    TEAM = 64,      /* work-items of a group: as in opencl/kernels.cl */
    STAGE = 4096,   /* bundles that are gathered for a transfer: 3 MB */
    PLATFORMS = 16, /* that are looked at */
    DEVICES = 64    /* of all platforms */
};

/* The arrays there. KEPT_R + k, KEPT_U + k: the iterate that is kept in place k */
enum opencl_role {
    BUNDLES,
    LIST,   /* of the slots, level after level */
    BESIDE, /* what stands behind them; none: nothing does */
    REBOUND,
    BODIES,
    FREE, /* bodies without reactions */
    R,
    U,
    W_CC, /* struct problem's w */
    RHO,
    BLOCK,
    ROW_FIRST,
    ROW_COL,
    ROW_BLOCK,
    ROW_Q,
    ROW_R,
    QUESTION,
    QUESTIONS,
    PART,
    TALLY,
    JUDGED,
    JUDGED_SUM,
    ROOM,
    MIXED,
    MIXED_SUM,
    FRAME_MEMORY_R,
    FRAME_MEMORY_U = FRAME_MEMORY_R + DEVICE_KEPT,
    ROLES = FRAME_MEMORY_U + DEVICE_KEPT
};

enum kernel_id {
    SWEEP,
    SWEEP_ANSWERED,
    TALLY_COUNTS,
    PUSH,
    VELOCITIES,
    JUDGE,
    SUM_PARTS,
    CLEAR,
    SCATTER,
    REMEMBER,
    CHANGES,
    PRODUCTS,
    REACT,
    KERNELS
};
static const char *const kernel_name[KERNELS] = {
    "sweep", "sweep_answered", "tally_counts", "push",    "velocities", "judge", "sum_parts",
    "clear", "scatter",        "remember",     "changes", "products",   "react"
};

/* What is asked of exact_search(), and its answer: as in opencl/kernels.cl */
struct question {
    double W[9], b[3], mu, r[3];
    int64_t slot;
    int32_t singular, found;
};
struct opencl_counts {
    double change, newton, safeguarded, gave_up;
};

/* The variants of a program */
enum variant { VARIANT_BODIES, VARIANT_DIAGONALS, VARIANT_BLOCKS, VARIANTS };

struct program {
    void *program, *kernel[KERNELS];
};

struct buffer {
    void *memory;
    size_t size; /* bytes */
};

struct opencl {
    struct device device; /* first: it is what the functions are given */
    const struct opencl_api *api;
    void *id, *context, *queue;
    uint64_t memory, largest; /* bytes: of the device, and of one buffer */
    struct buffer buffer[ROLES];
    struct program program[METHOD_COUNT][VARIANTS];
    const struct program *now; /* of the problem that is held */
    enum method_id method;
    enum variant variant;
    int64_t levels; /* contacts of a level are solved at once */
    int64_t *first; /* [levels + 1] level k: list[first[k]] .. list[first[k+1]-1] */
    int32_t *list;  /* [contacts] slots */
    int64_t parts;  /* teams of a sweep */
    int64_t vector; /* numbers of a vector of Anderson's */
    void *stage;    /* [STAGE] bundles */
};

/* ---- failures ---- */

/* Whether it works still; else why it does not */
static bool good(struct opencl *o, int32_t error, const char *what)
{
    struct failure *lost = &o->device.lost;
    if (error && !lost->status)
        failure_set(
            lost, EX_UNAVAILABLE,
            "--device opencl: %s: it has failed: %s: %s: start again, or leave --device out",
            o->device.name, what, opencl_error(error));
    return !lost->status;
}

static bool lost(const struct opencl *o)
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

static int opencl_list(FILE *to, struct failure *failure)
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

static void close_device(struct device *d)
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
    if (!good(o, error, "no context")) return false;
    o->queue = api->clCreateCommandQueue(o->context, o->id, 0, &error);
    return good(o, error, "no queue");
}

static struct device *opencl_open_device(int number, struct failure *failure)
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
    close_device(&o->device);
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
static const struct program *program_of(struct opencl *o, enum method_id method, enum variant v)
{
    struct program *g = &o->program[method][v];
    char options[200];
    int32_t error = 0;
    if (g->program) return g;
    char *text = opencl_text();
    if (!text) return good(o, -6, "kernels"), NULL;
    g->program =
        o->api->clCreateProgramWithSource(o->context, 1, (const char *[]){ text }, NULL, &error);
    free(text);
    if (!good(o, error, "kernels")) return NULL;
    snprintf(options, sizeof options, "-cl-std=CL1.2 -DMETHOD=%s -DEXACT=%d -DGIVEN=%d -DFULL=%d",
             methods[method]->name, method == METHOD_exact, v != VARIANT_BODIES,
             v == VARIANT_BLOCKS);
    error = o->api->clBuildProgram(g->program, 1, &o->id, options, NULL, NULL);
    if (error) return report_build(o, g->program, error), NULL;
    for (int k = 0; k < KERNELS; k++) {
        g->kernel[k] = o->api->clCreateKernel(g->program, kernel_name[k], &error);
        if (!good(o, error, kernel_name[k])) return NULL;
    }
    return g;
}

/* ---- launches ---- */

/* An argument of a kernel */
struct argument {
    size_t size;
    union {
        void *memory;
        int32_t integer;
        int64_t whole;
        double real;
    } value;
};

static struct argument memory_of(const struct opencl *o, enum opencl_role role)
{
    return (struct argument){ sizeof(void *), { .memory = o->buffer[role].memory } };
}
static struct argument integer(int32_t x)
{
    return (struct argument){ sizeof x, { .integer = x } };
}
static struct argument opencl_whole(int64_t x)
{
    return (struct argument){ sizeof x, { .whole = x } };
}
static struct argument real(double x)
{
    return (struct argument){ sizeof x, { .real = x } };
}

#define MEMORY(role) memory_of(o, role)
#define ROWS_OF_W                                                                                  \
    MEMORY(ROW_FIRST), MEMORY(ROW_COL), MEMORY(ROW_BLOCK), MEMORY(ROW_Q), MEMORY(ROW_R),           \
        MEMORY(BLOCK)

/* Sets arguments of a kernel, from this index on; returns the index after them. */
#define SET(k, from, ...)                                                                          \
    opencl_set(o, k, from, (const struct argument[]){ __VA_ARGS__, { 0, { NULL } } })

static uint32_t opencl_set(struct opencl *o, enum kernel_id k, uint32_t from,
                           const struct argument *a)
{
    for (; a->size; a++, from++)
        if (!lost(o))
            good(o, o->api->clSetKernelArg(o->now->kernel[k], from, a->size, &a->value),
                 kernel_name[k]);
    return from;
}

/* At least n work-items, in teams */
static void launch(struct opencl *o, enum kernel_id k, int64_t n)
{
    size_t team = TEAM, all = (size_t)((n + TEAM - 1) / TEAM) * TEAM;
    if (lost(o) || n <= 0) return;
    o->device.account.kernels++;
    good(o,
         o->api->clEnqueueNDRangeKernel(o->queue, o->now->kernel[k], 1, NULL, &all, &team, 0, NULL,
                                        NULL),
         kernel_name[k]);
}

/* ---- memory ---- */

/* A buffer of at least this size; one that is larger stays */
static bool need(struct opencl *o, enum opencl_role role, size_t size)
{
    struct buffer *b = &o->buffer[role];
    int32_t error = 0;
    double GB = 1e-9;
    size = size ? size : 1;
    if (b->size >= size || lost(o)) return !lost(o);
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
    if (good(o, error, "no memory on the device")) b->size = size;
    return !lost(o);
}

static void opencl_forget(struct opencl *o, enum opencl_role role)
{
    if (o->buffer[role].memory) o->api->clReleaseMemObject(o->buffer[role].memory);
    o->buffer[role] = (struct buffer){ 0 };
}

static void opencl_put(struct opencl *o, enum opencl_role role, size_t offset, const void *from,
                       size_t size)
{
    if (lost(o) || !size) return;
    o->device.account.to += (double)size;
    good(o,
         o->api->clEnqueueWriteBuffer(o->queue, o->buffer[role].memory, OCL_TRUE, offset, size,
                                      from, 0, NULL, NULL),
         "writing to it");
}

static void opencl_take(struct opencl *o, enum opencl_role role, size_t offset, void *to,
                        size_t size)
{
    if (lost(o) || !size) return;
    o->device.account.from += (double)size, o->device.account.waits++;
    good(o,
         o->api->clEnqueueReadBuffer(o->queue, o->buffer[role].memory, OCL_TRUE, offset, size, to,
                                     0, NULL, NULL),
         "reading from it");
}

static void opencl_copy(struct opencl *o, enum opencl_role from, enum opencl_role to, size_t size)
{
    if (lost(o)) return;
    good(o,
         o->api->clEnqueueCopyBuffer(o->queue, o->buffer[from].memory, o->buffer[to].memory, 0, 0,
                                     size, 0, NULL, NULL),
         "copying");
}

/* A buffer with these bytes; none, where there are none */
static void opencl_give(struct opencl *o, enum opencl_role role, const void *from, size_t size)
{
    if (!from)
        opencl_forget(o, role);
    else if (need(o, role, size))
        opencl_put(o, role, 0, from, size);
}

/* ---- a problem ---- */

static enum variant variant_of(const struct problem *p)
{
    if (!p->kind.given_by_W) return VARIANT_BODIES;
    return p->kind.full ? VARIANT_BLOCKS : VARIANT_DIAGONALS;
}

/*
 * The level of slot i: one after the last contact before it that shares a body that moves, as its bodies' `after` has
 * it; given by W the group, which was made so. Colours of a large pile are those of a stretch of contacts after another
 * [solve/schedule.c], too few at once for a device. Their contacts meet at the borders alone: levels are few and
 * large, and each body gets its changes in the order of the groups, so the bits are the same.
 */
static int32_t opencl_level_of(const struct problem *p, int64_t i, int64_t group, int32_t *after)
{
    if (!p->body) return (int32_t)group;
    const struct bundle *c = slot_bundle(p, i);
    int64_t a = body_index(c->a[slot_lane(i)]), b = body_index(c->b[slot_lane(i)]);
    int32_t level = after[a] > after[b] ? after[a] : after[b];
    if (p->body[a].im > 0) after[a] = level + 1;
    if (p->body[b].im > 0) after[b] = level + 1;
    return level;
}

/* o->first[] and o->list[] from the level of each slot, -1: no contact */
static void list_levels(struct opencl *o, int64_t slots, const int32_t *level)
{
    for (int64_t k = 0; k <= o->levels; k++) o->first[k] = 0;
    for (int64_t i = 0; i < slots; i++)
        if (level[i] >= 0) o->first[level[i] + 1]++;
    o->parts = 0;
    for (int64_t k = 0; k < o->levels; k++) {
        o->parts += (o->first[k + 1] + TEAM - 1) / TEAM;
        o->first[k + 1] += o->first[k];
    }
    for (int64_t i = 0; i < slots; i++)
        if (level[i] >= 0) o->list[o->first[level[i]]++] = (int32_t)i;
    for (int64_t k = o->levels; k > 0; k--) o->first[k] = o->first[k - 1];
    o->first[0] = 0;
}

/* Contacts that the device solves at once, level after level; false when memory is short */
static bool make_levels(struct opencl *o, const struct problem *p)
{
    int32_t *level = malloc((size_t)(p->slots + 1) * sizeof *level);
    int32_t *after = calloc((size_t)p->bodies + 1, sizeof *after);
    int32_t *all = realloc(o->list, (size_t)(p->slots + 1) * sizeof *all);
    if (all) o->list = all;
    int64_t *first = realloc(o->first, (size_t)(p->groups + 2) * sizeof *first);
    if (first) o->first = first;
    bool room = level && after && all && first;
    o->levels = 0;
    for (int64_t i = 0; room && i < p->slots; i++) level[i] = -1;
    for (int64_t g = 0; room && g < p->groups; g++)
        for (int64_t i = p->group[g] * BUNDLE; i < p->group[g + 1] * BUNDLE; i++) {
            level[i] = p->contact[i] < 0 ? -1 : opencl_level_of(p, i, g, after);
            if (level[i] >= o->levels) o->levels = level[i] + 1;
        }
    if (room) list_levels(o, p->slots, level);
    free(level), free(after);
    return room;
}

static int64_t in_level(const struct opencl *o, int64_t k)
{
    return o->first[k + 1] - o->first[k];
}

/* Bundles, and apart from them what stands behind them */
static void give_bundles(struct opencl *o, const struct problem *p)
{
    struct bundle *stage = o->stage;
    struct beside *behind = o->stage;
    for (int64_t i = 0; i < p->bundles && !lost(o); i += STAGE) {
        int64_t n = p->bundles - i < STAGE ? p->bundles - i : STAGE;
        for (int64_t k = 0; k < n; k++) stage[k] = *bundle_at(p, i + k);
        opencl_put(o, BUNDLES, (size_t)i * sizeof *stage, stage, (size_t)n * sizeof *stage);
        for (int64_t k = 0; k < n && p->kind.near; k++)
            behind[k] = *bundle_beside(p, bundle_at(p, i + k));
        if (p->kind.near)
            opencl_put(o, BESIDE, (size_t)i * sizeof *behind, behind, (size_t)n * sizeof *behind);
    }
}

/* The bodies as they move without reactions; of a packing, else as they are */
static bool give_free_motion(struct opencl *o, struct problem *p)
{
    size_t size = (size_t)p->bodies * sizeof *p->body;
    struct body *now = p->packing ? malloc(size) : NULL;
    if (p->packing && !now) return false;
    if (now) memcpy(now, p->body, size), problem_set_free_motion(p);
    opencl_give(o, FREE, p->body, size);
    if (now) memcpy(p->body, now, size);
    free(now);
    return need(o, BODIES, size);
}

static void give_rows(struct opencl *o, const struct problem *p)
{
    const struct delassus *W = &p->sorted;
    size_t d = (size_t)p->d, slots = (size_t)p->slots, blocks = (size_t)W->first[p->slots];
    opencl_give(o, ROW_FIRST, W->first, (slots + 1) * sizeof *W->first);
    opencl_give(o, ROW_COL, W->col, blocks * sizeof *W->col);
    opencl_give(o, ROW_BLOCK, W->block, blocks * d * d * sizeof *W->block);
    opencl_give(o, ROW_Q, W->q, slots * d * sizeof *W->q);
    opencl_give(o, BLOCK, p->block, (size_t)p->bundles * sizeof *p->block);
    need(o, ROW_R, (size_t)p->n * d * sizeof *p->W->r);
}

static int64_t largest_level(const struct opencl *o)
{
    int64_t most = 1;
    for (int64_t k = 0; k < o->levels; k++) most = in_level(o, k) > most ? in_level(o, k) : most;
    return most;
}

static int hold(struct device *d, struct problem *p, enum method_id method, struct failure *failure)
{
    struct opencl *o = (struct opencl *)d;
    const size_t bundles = (size_t)p->bundles;
    const int32_t zero = 0;
    o->method = method, o->variant = variant_of(p);
    o->now = program_of(o, method, o->variant);
    bool room = make_levels(o, p);
    need(o, BUNDLES, bundles * sizeof(struct bundle));
    if (p->kind.near)
        need(o, BESIDE, bundles * sizeof(struct beside));
    else
        opencl_forget(o, BESIDE);
    if (room) give_bundles(o, p);
    if (room) opencl_give(o, LIST, o->list, (size_t)o->first[o->levels] * sizeof *o->list);
    opencl_give(o, REBOUND, p->rebound, bundles * sizeof *p->rebound);
    opencl_give(o, W_CC, p->w, bundles * sizeof *p->w);
    opencl_give(o, RHO, p->rho, bundles * sizeof *p->rho);
    need(o, R, bundles * sizeof *p->u), need(o, U, bundles * sizeof *p->u);
    if (room && p->kind.given_by_W)
        give_rows(o, p);
    else
        room = room && give_free_motion(o, p);
    need(o, PART, (size_t)(o->parts + 1) * sizeof(struct opencl_counts));
    need(o, TALLY, sizeof(struct opencl_counts));
    if (room)
        need(o, QUESTION, (size_t)(p->kind.full ? largest_level(o) : 1) * sizeof(struct question));
    opencl_give(o, QUESTIONS, &zero, sizeof zero);
    if (!room) return failure_set(failure, EX_SOFTWARE, "--device opencl: no memory");
    return d->lost.status ? failure_set(failure, d->lost.status, "%s", d->lost.text) : 0;
}

static void upload(struct device *d, const struct problem *p)
{
    struct opencl *o = (struct opencl *)d;
    double(*stage)[3][BUNDLE] = o->stage;
    for (int64_t i = 0; i < p->bundles; i += STAGE) {
        int64_t n = p->bundles - i < STAGE ? p->bundles - i : STAGE;
        for (int64_t k = 0; k < n; k++) memcpy(stage[k], bundle_at(p, i + k)->r, sizeof *stage);
        opencl_put(o, R, (size_t)i * sizeof *stage, stage, (size_t)n * sizeof *stage);
    }
    opencl_put(o, U, 0, p->u, (size_t)p->bundles * sizeof *p->u);
    if (p->kind.given_by_W)
        opencl_put(o, ROW_R, 0, p->W->r, (size_t)(p->n * p->d) * sizeof *p->W->r);
    else
        opencl_put(o, BODIES, 0, p->body, (size_t)p->bodies * sizeof *p->body);
}

static void download(struct device *d, struct problem *p, bool bodies)
{
    struct opencl *o = (struct opencl *)d;
    double(*stage)[3][BUNDLE] = o->stage;
    for (int64_t i = 0; i < p->bundles; i += STAGE) {
        int64_t n = p->bundles - i < STAGE ? p->bundles - i : STAGE;
        opencl_take(o, R, (size_t)i * sizeof *stage, stage, (size_t)n * sizeof *stage);
        for (int64_t k = 0; k < n && !lost(o); k++)
            memcpy(bundle_at(p, i + k)->r, stage[k], sizeof *stage);
    }
    opencl_take(o, U, 0, p->u, (size_t)p->bundles * sizeof *p->u);
    if (p->kind.given_by_W)
        opencl_take(o, ROW_R, 0, p->W->r, (size_t)(p->n * p->d) * sizeof *p->W->r);
    else if (bodies)
        opencl_take(o, BODIES, 0, p->body, (size_t)p->bodies * sizeof *p->body);
}

/* ---- sweeps ---- */

/* What sweep and sweep_answered begin with; returns the index of the next argument */
static uint32_t set_sweep(struct opencl *o, enum kernel_id k, const struct problem *p,
                          const struct sweep_opt *s)
{
    return SET(k, 0, MEMORY(BUNDLES), MEMORY(BESIDE), MEMORY(REBOUND), MEMORY(BODIES), MEMORY(R),
               MEMORY(U), MEMORY(W_CC), MEMORY(RHO), ROWS_OF_W, integer(p->d), real(s->relax),
               real(s->local.newton_eps), real(s->local.newton_abs), integer(s->local.newton_max),
               integer(s->local.plain), integer(s->keep), MEMORY(QUESTION), MEMORY(QUESTIONS),
               MEMORY(PART));
}

/* Answers what contacts of the group have asked, and lets them be solved. */
static void opencl_answer(struct opencl *o, int d, uint32_t next, int64_t part)
{
    int32_t n = 0;
    const int32_t zero = 0;
    opencl_take(o, QUESTIONS, 0, &n, sizeof n);
    if (n <= 0 || (size_t)n * sizeof(struct question) > o->buffer[QUESTION].size || lost(o)) return;
    struct question *q = malloc((size_t)n * sizeof *q);
    if (!q) {
        good(o, -6, "answers");
        return;
    }
    opencl_take(o, QUESTION, 0, q, (size_t)n * sizeof *q);
    for (int32_t k = 0; k < n && !lost(o); k++)
        q[k].found = exact_search(d, q[k].W, q[k].b, q[k].mu, q[k].singular, q[k].r);
    opencl_put(o, QUESTION, 0, q, (size_t)n * sizeof *q);
    opencl_put(o, QUESTIONS, 0, &zero, sizeof zero);
    free(q);
    SET(SWEEP_ANSWERED, next, integer(n), opencl_whole(part));
    launch(o, SWEEP_ANSWERED, 1);
}

static void opencl_sweep(struct device *d, struct problem *p, const struct sweep_opt *s,
                         struct tally *t)
{
    struct opencl *o = (struct opencl *)d;
    bool asks = o->variant == VARIANT_BLOCKS && methods[o->method]->believes;
    uint32_t next = set_sweep(o, SWEEP, p, s);
    struct opencl_counts c = { 0, 0, 0, 0 };
    int64_t part = 0;
    if (asks) set_sweep(o, SWEEP_ANSWERED, p, s);
    for (int64_t k = 0; k < o->levels && !lost(o); k++) {
        SET(SWEEP, next, MEMORY(LIST), opencl_whole(o->first[k]), integer((int32_t)in_level(o, k)),
            opencl_whole(part));
        launch(o, SWEEP, in_level(o, k));
        if (asks) opencl_answer(o, p->d, next, part);
        part += (in_level(o, k) + TEAM - 1) / TEAM;
    }
    SET(TALLY_COUNTS, 0, MEMORY(PART), opencl_whole(part), MEMORY(TALLY));
    launch(o, TALLY_COUNTS, 1);
    opencl_take(o, TALLY, 0, &c, sizeof c);
    if (lost(o)) return;
    t->change[0] = fmax(t->change[0], c.change), t->newton[0] += c.newton;
    t->safeguarded[0] += c.safeguarded, t->gave_up[0] += c.gave_up;
}

static void opencl_renew(struct device *d, const struct problem *p)
{
    struct opencl *o = (struct opencl *)d;
    if (p->kind.given_by_W) return;
    opencl_copy(o, FREE, BODIES, (size_t)p->bodies * sizeof *p->body);
    SET(PUSH, 0, MEMORY(LIST), MEMORY(BUNDLES), MEMORY(BESIDE), MEMORY(BODIES), MEMORY(R),
        MEMORY(ROW_R), integer(p->d));
    for (int64_t k = 0; k < o->levels; k++) {
        SET(PUSH, 7, opencl_whole(o->first[k]), integer((int32_t)in_level(o, k)));
        launch(o, PUSH, in_level(o, k));
    }
}

static void opencl_velocities(struct device *d, const struct problem *p)
{
    struct opencl *o = (struct opencl *)d;
    SET(VELOCITIES, 0, MEMORY(BUNDLES), MEMORY(BESIDE), MEMORY(REBOUND), MEMORY(BODIES), MEMORY(R),
        MEMORY(U), ROWS_OF_W, integer(p->d), opencl_whole(p->slots));
    launch(o, VELOCITIES, p->slots);
}

/* ---- sums ---- */

/* Columns of parts: n of them, all to be added but those of which the largest is taken, most_first .. most_end-1 */
struct opencl_columns {
    int n, most_first, most_end;
};

/* to[c.n] = the sums of n parts of that many numbers, and the largest of some */
static void sum_parts(struct opencl *o, enum opencl_role parts, int64_t n, struct opencl_columns c,
                      enum opencl_role sum, double *to)
{
    if (!need(o, sum, (size_t)c.n * sizeof *to)) return;
    SET(SUM_PARTS, 0, MEMORY(parts), opencl_whole(n), integer(c.n), integer(c.most_first),
        integer(c.most_end), MEMORY(sum));
    launch(o, SUM_PARTS, c.n);
    opencl_take(o, sum, 0, to, (size_t)c.n * sizeof *to);
}

#define COLUMN(member) ((int)(offsetof(struct sums, member) / sizeof(double)))
enum { SUM_COLUMNS = sizeof(struct sums) / sizeof(double) };
static_assert(SUM_COLUMNS == 12 * BUNDLE, "struct sums is what the kernel judge writes");
static_assert(offsetof(struct sums, max_pen) == 8 * BUNDLE * sizeof(double) &&
                  offsetof(struct sums, jammed) == 11 * BUNDLE * sizeof(double),
              "and in its order");

static void opencl_judge(struct device *d, const struct problem *p, bool believes,
                         enum err_terms which, int64_t per_block, struct sums *s)
{
    struct opencl *o = (struct opencl *)d;
    int64_t blocks = (p->bundles + per_block - 1) / per_block;
    const double *end = p->endless, misses = MISSES * p->unit;
    if (!need(o, JUDGED, (size_t)blocks * sizeof *s)) return;
    SET(JUDGE, 0, MEMORY(BUNDLES), MEMORY(BESIDE), MEMORY(REBOUND), MEMORY(BODIES), MEMORY(R),
        MEMORY(U), MEMORY(W_CC), ROWS_OF_W, integer(p->d), opencl_whole(p->bundles),
        integer((int32_t)per_block), integer(believes), integer((which & ERR_TERMS) != 0),
        integer((which & ERR_NATURAL) != 0), real(ROUNDING_OF_R * ROUNDING_OF_R),
        real(p->rounded * p->rounded), real(end[0] * end[0]), real(end[1] * end[1]),
        real(misses * misses), real(p->wild * p->wild), MEMORY(JUDGED));
    launch(o, JUDGE, blocks * BUNDLE);
    const struct opencl_columns columns = { SUM_COLUMNS, COLUMN(max_pen), COLUMN(jammed) };
    sum_parts(o, JUDGED, blocks, columns, JUDGED_SUM, s->motion);
}

/* ---- iterates that are kept ---- */

static void opencl_keep(struct device *d, const struct problem *p, int place, bool u)
{
    struct opencl *o = (struct opencl *)d;
    size_t size = (size_t)p->bundles * sizeof *p->u;
    enum opencl_role r = (enum opencl_role)(FRAME_MEMORY_R + place),
                     v = (enum opencl_role)(FRAME_MEMORY_U + place);
    if (need(o, r, size)) opencl_copy(o, R, r, size);
    if (u && need(o, v, size)) opencl_copy(o, U, v, size);
}

static void opencl_restore(struct device *d, const struct problem *p, int place, bool u)
{
    struct opencl *o = (struct opencl *)d;
    size_t size = (size_t)p->bundles * sizeof *p->u;
    opencl_copy(o, (enum opencl_role)(FRAME_MEMORY_R + place), R, size);
    if (u) opencl_copy(o, (enum opencl_role)(FRAME_MEMORY_U + place), U, size);
    if (p->kind.given_by_W) {
        SET(SCATTER, 0, MEMORY(BUNDLES), MEMORY(R), MEMORY(ROW_R), integer(p->d),
            opencl_whole(p->slots));
        launch(o, SCATTER, p->slots);
    }
    opencl_renew(d, p);
}

/* ---- Anderson's mixing: f, and then dg[k], df[k] in turn ---- */

static int64_t dg_at(const struct opencl *o, int k)
{
    return (1 + 2 * k) * o->vector;
}
static int64_t df_at(const struct opencl *o, int k)
{
    return (2 + 2 * k) * o->vector;
}

static int mixing(struct device *d, const struct problem *p, int depth)
{
    struct opencl *o = (struct opencl *)d;
    o->vector = p->slots * p->d;
    int64_t all = (1 + 2 * depth) * o->vector;
    if (!need(o, ROOM, (size_t)all * sizeof(double))) return 0; // it is lost: the solve ends
    SET(CLEAR, 0, MEMORY(ROOM), opencl_whole(all));
    launch(o, CLEAR, all);
    return 0;
}

static void opencl_remember(struct device *d, const struct problem *p, int next)
{
    struct opencl *o = (struct opencl *)d;
    SET(REMEMBER, 0, MEMORY(R), integer(p->d), opencl_whole(o->vector), MEMORY(ROOM),
        opencl_whole(df_at(o, next)));
    launch(o, REMEMBER, o->vector);
}

enum { MIXING_COLUMNS = sizeof(struct mixing_sums) / sizeof(double) };
static_assert(MIXING_COLUMNS == (1 + 2 * MIXING_DEPTH) * BUNDLE && MIXING_DEPTH == 5,
              "struct mixing_sums is what the kernel products writes");

static void opencl_measure(struct device *d, const struct problem *p, const struct mixing *m,
                           int64_t per_chunk, struct mixing_sums *sums)
{
    struct opencl *o = (struct opencl *)d;
    int64_t chunks = (p->bundles + per_chunk - 1) / per_chunk;
    if (!need(o, MIXED, (size_t)chunks * sizeof *sums)) return;
    SET(CHANGES, 0, MEMORY(R), integer(p->d), opencl_whole(o->vector), MEMORY(ROOM),
        opencl_whole(0), opencl_whole(dg_at(o, m->next)), opencl_whole(df_at(o, m->next)));
    launch(o, CHANGES, o->vector);
    SET(PRODUCTS, 0, MEMORY(ROOM), MEMORY(W_CC), integer(p->d), integer(m->depth),
        opencl_whole(p->bundles), integer((int32_t)per_chunk), opencl_whole(0),
        opencl_whole(df_at(o, m->next)), opencl_whole(o->vector), MEMORY(MIXED));
    launch(o, PRODUCTS, chunks * MIXING_COLUMNS);
    sum_parts(o, MIXED, chunks, (struct opencl_columns){ MIXING_COLUMNS, 0, 0 }, MIXED_SUM,
              sums->f2);
}

static void opencl_react(struct device *d, const struct problem *p, const struct mixing *m,
                         double leap, const double gamma[MIXING_DEPTH])
{
    struct opencl *o = (struct opencl *)d;
    uint32_t next = SET(REACT, 0, MEMORY(LIST), MEMORY(BUNDLES), MEMORY(BESIDE), MEMORY(BODIES),
                        MEMORY(R), MEMORY(ROW_R), integer(p->d), MEMORY(ROOM), opencl_whole(0),
                        opencl_whole(o->vector), integer(m->depth), integer(m->next), real(leap));
    for (int k = 0; k < MIXING_DEPTH; k++) next = SET(REACT, next, real(gamma[k]));
    for (int64_t k = 0; k < o->levels; k++) {
        SET(REACT, next, opencl_whole(o->first[k]), integer((int32_t)in_level(o, k)));
        launch(o, REACT, in_level(o, k));
    }
}

const struct device_kind device_opencl = {
    .name = "opencl",
    .list = opencl_list,
    .open = opencl_open_device,
    .close = close_device,
    .hold = hold,
    .upload = upload,
    .download = download,
    .sweep = opencl_sweep,
    .judge = opencl_judge,
    .velocities = opencl_velocities,
    .renew = opencl_renew,
    .keep = opencl_keep,
    .restore = opencl_restore,
    .mixing = mixing,
    .remember = opencl_remember,
    .measure = opencl_measure,
    .react = opencl_react,
};
