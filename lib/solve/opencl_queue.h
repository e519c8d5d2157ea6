/*
 * solve/opencl_queue.h: what the sweeps of solve/opencl.c are made of: a device's arrays and kernels, and their launches. A
 * failure stays in the struct device: all that follows does nothing.
 */
#pragma once

#include "solve/device.h"
#include "solve/opencl_api.h"

enum {
    TEAM = 64,    /* work-items of a group: as in opencl/kernels.cl */
    STAGE = 4096, /* bundles that are gathered for a transfer: 3 MB */
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
    KEPT_R,
    KEPT_U = KEPT_R + DEVICE_KEPT,
    ROLES = KEPT_U + DEVICE_KEPT
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

/* Whether it works still, after a call that returned this error; else why it does not */
bool opencl_good(struct opencl *o, int32_t error, const char *what);
bool opencl_lost(const struct opencl *o);

/* As struct device_kind has them */
int opencl_list(FILE *to, struct failure *failure);
struct device *opencl_open_device(int number, struct failure *failure);
void opencl_close(struct device *d);

/* The kernels for a method and a variant; NULL where the driver does not compile them */
const struct program *opencl_program(struct opencl *o, enum method_id method, enum variant v);

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

static inline struct argument opencl_memory(const struct opencl *o, enum opencl_role role)
{
    return (struct argument){ sizeof(void *), { .memory = o->buffer[role].memory } };
}
static inline struct argument opencl_integer(int32_t x)
{
    return (struct argument){ sizeof x, { .integer = x } };
}
static inline struct argument opencl_whole(int64_t x)
{
    return (struct argument){ sizeof x, { .whole = x } };
}
static inline struct argument opencl_real(double x)
{
    return (struct argument){ sizeof x, { .real = x } };
}

#define MEMORY(role) opencl_memory(o, role)
#define ROWS_OF_W                                                                                  \
    MEMORY(ROW_FIRST), MEMORY(ROW_COL), MEMORY(ROW_BLOCK), MEMORY(ROW_Q), MEMORY(ROW_R),           \
        MEMORY(BLOCK)

/* Sets arguments of a kernel, from this index on; returns the index after them. */
#define SET(k, from, ...)                                                                          \
    opencl_set(o, k, from, (const struct argument[]){ __VA_ARGS__, { 0, { NULL } } })
uint32_t opencl_set(struct opencl *o, enum kernel_id k, uint32_t from, const struct argument *a);

/* At least n work-items, in teams */
void opencl_launch(struct opencl *o, enum kernel_id k, int64_t n);

/* A buffer of at least this size (bytes); one that is larger stays */
bool opencl_need(struct opencl *o, enum opencl_role role, size_t size);
void opencl_forget(struct opencl *o, enum opencl_role role);
void opencl_put(struct opencl *o, enum opencl_role role, size_t offset, const void *from,
                size_t size);
void opencl_take(struct opencl *o, enum opencl_role role, size_t offset, void *to, size_t size);
void opencl_copy(struct opencl *o, enum opencl_role from, enum opencl_role to, size_t size);
/* A buffer with these bytes; none, where there are none */
void opencl_give(struct opencl *o, enum opencl_role role, const void *from, size_t size);
