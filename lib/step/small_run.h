/*
 * step/small_run.h: the small steps of an interval, while they are made [step/small_loop.h].
 */
#pragma once

#include "step/small_list.h"

#include <pthread.h>

/* A wall in a small step */
struct small_wall {
    bool there;
    struct pose pose;
    vec3 at, v, spin; /* m; m/s, rad/s: of its material at that point */
    vec3 belt;        /* m/s */
};

/* The small steps of an interval */
struct small_run {
    struct packing *p; /* its dt and t are those of the small step in hand */
    struct small_list *l;
    const struct small_kernels *kernel;
    struct small_wall *wall; /* [walls] */
    vec3 *x, *turned;        /* [n] m; rad: by which bodies have turned */
    struct small_pull *pull; /* [n] NULL: no forces on bodies */
    double stored;           /* J: by attraction, where the interval begins */
    struct face_sums *sums;  /* [walls] NULL: none are kept */
    double h, ahead;         /* s */
    int64_t n, made, sweeps; /* small steps, and those made; sweeps of all */
    int64_t unsolved;        /* small steps that have ended with the limit of sweeps */
    int32_t swept;           /* of the step in hand */
    bool begins, stop;       /* the first step; the list serves no longer, or the step fails */
    bool uneven;             /* bodies have masses so different that sweeps are slow */
    bool failed;             /* the interval is to be made at once */
    _Atomic bool far;        /* a sweep has changed a body by more than is allowed */
    pthread_mutex_t lock;    /* of what follows */
    double fastest;          /* m^2/s^2: of bodies */
};
