/*
 * solve/device.h: a device that makes the sweeps of a solve in its own memory: a GPU, or a CPU by the same driver.
 *
 * A solve gives it the problem, and the iterate lies there until the solve ends. Sweeps, judgements, renewed velocities
 * and Anderson's mixing are made there with the bits of the CPU; numbers come back, not vectors. Code that needs the
 * iterate in the problem's slots asks for it by device_home().
 *
 * A failure of the device stays: later calls do nothing, errors are NaN, so that solvers end, and device_failed() has
 * the reason. Nothing goes on elsewhere.
 *
 * Another kind of device is a file with its struct device_kind, and a row of device_kinds[] in device.c.
 */
#pragma once

#include "base/failure.h"
#include "solve/judge.h"
#include "solve/mixing.h"
#include "solve/sweep.h"

#include <stdio.h>

/* What went over the bus, and what was started there */
struct device_account {
    double to, from; /* bytes */
    int64_t kernels; /* started */
    int64_t waits;   /* of the CPU for the device */
};

enum {
    DEVICE_KEPT = 4 /* iterates that a solve keeps there, at most */
};

struct device {
    const struct device_kind *kind;
    char name[200];                 /* as the driver has it */
    struct failure lost;            /* status 0: it works */
    struct problem *problem;        /* whose iterate it has; NULL: none */
    bool here, there;               /* the iterate of the host is current; that of the device is */
    int kept;                       /* iterates that are kept */
    unsigned checked[METHOD_COUNT]; /* bits of the kinds of problems that it has shown to solve */
    struct device_account account;
};

/* All but open and list belong to a device that works. */
struct device_kind {
    const char *name; /* as --device has it */
    /* One line for each device of the machine; EX_UNAVAILABLE where there are none */
    int (*list)(FILE *to, struct failure *failure);
    /* The device of this number; NULL and EX_UNAVAILABLE */
    struct device *(*open)(int number, struct failure *failure);
    void (*close)(struct device *d);
    /* Memory and kernels for a problem, and all but its iterate */
    int (*hold)(struct device *d, struct problem *p, enum method_id method,
                struct failure *failure);
    /* The iterate to the device, and from it: reactions, u, W->r, and velocities of bodies if wanted */
    void (*upload)(struct device *d, const struct problem *p);
    void (*download)(struct device *d, struct problem *p, bool bodies);
    void (*sweep)(struct device *d, struct problem *p, const struct sweep_opt *o, struct tally *t);
    void (*judge)(struct device *d, const struct problem *p, bool believes, enum err_terms which,
                  int64_t per_block, struct sums *s);
    void (*velocities)(struct device *d, const struct problem *p);
    void (*renew)(struct device *d, const struct problem *p);
    void (*keep)(struct device *d, const struct problem *p, int place, bool u);
    void (*restore)(struct device *d, const struct problem *p, int place, bool u);
    int (*mixing)(struct device *d, const struct problem *p, int depth);
    void (*remember)(struct device *d, const struct problem *p, int next);
    void (*measure)(struct device *d, const struct problem *p, const struct mixing *m,
                    int64_t per_chunk, struct mixing_sums *sums);
    void (*react)(struct device *d, const struct problem *p, const struct mixing *m, double leap,
                  const double gamma[MIXING_DEPTH]);
};
extern const struct device_kind device_opencl;

/* Whether this names a device, there or not: "opencl" or "opencl:1", 0 by default; else EX_USAGE */
int device_named(const char *name, struct failure *failure);
/* The device of that number; NULL, and EX_USAGE or EX_UNAVAILABLE */
struct device *device_open(const char *name, struct failure *failure);
/* The devices of all kinds, a line each; EX_UNAVAILABLE where there are none */
int device_list(FILE *to, struct failure *failure);
void device_close(struct device *d); /* may be NULL */

/* Why the CPU has to solve this problem, a literal; NULL: devices can */
const char *device_declines(const struct problem *p);

/* From now on p's iterate is on the device: p->device = d. Returns 0, or EX_UNAVAILABLE: then it is not. */
int device_hold(struct device *d, struct problem *p, enum method_id method,
                struct failure *failure);
/* The end of that: r, u and W->r are in the slots again. EX_UNAVAILABLE where the device was lost */
int device_release(struct problem *p, struct failure *failure);
/* The iterate is in the slots, and may be changed there if `writes`. Nothing without a device */
void device_home(struct problem *p, bool writes);

/* ---- of a problem on a device ---- */

/* As a sweep_text by all threads */
void device_sweep(struct problem *p, const struct sweep_opt *o, struct tally *t);
/* The sums of all bundles, per_block of them a partial sum, as err_eval() adds them */
void device_judge(const struct problem *p, bool believes, enum err_terms which, int64_t per_block,
                  struct sums *s);
void device_velocities(const struct problem *p);
void device_renew(struct problem *p);
/* A place for an iterate, -1 where there is no room; the iterate there, u too where that is wanted; back to it */
int device_place(struct device *d);
void device_keep(struct problem *p, int place, bool u);
void device_restore(struct problem *p, int place, bool u);
/* Anderson's vectors, 0; -1 when memory is short */
int device_mixing(struct problem *p, int depth);
/* df[next] = r; as mixing_loops.measure and .react of all bundles, per_chunk bundles a partial sum */
void device_remember(struct problem *p, int next);
void device_measure(struct problem *p, const struct mixing *m, int64_t per_chunk,
                    struct mixing_sums *sums);
void device_react(struct problem *p, const struct mixing *m, double leap,
                  const double gamma[MIXING_DEPTH]);

/*
 * Whether a device has the bits of the CPU: a small problem of known numbers is swept, judged
 * and mixed on both. A driver that contracts, or rounds otherwise, fails here and not in a result.
 */

/* EX_UNAVAILABLE where they differ, for problems of this kind and this method; once for each */
int device_check(struct device *d, const struct problem_kind *kind, enum method_id method,
                 struct failure *failure);
