/*
 * solve/sweep.h: the inner loops over bundles: local solves. sweep.c is compiled for three vector
 * widths; the width changes no bit of a result. The one used is the widest that the machine has and
 * the environment's NSD_LANES allows.
 */
#pragma once

#include "solve/method.h"
#include "solve/problem.h"

struct sweep_opt {
    struct local_opt local;
    double relax; /* omega: r + omega (r_new - r), back onto the cone */
    bool keep;    /* store u as the method believes it to be: needed only before a judgement */
};

/* Counts of a sweep, lane by lane [solve/local.h] */
struct tally {
    double change[BUNDLE]; /* m/s: the largest change of a normal velocity */
    double newton[BUNDLE], safeguarded[BUNDLE], gave_up[BUNDLE];
};

/* A sweep visits every slot once, group after group. This is the share of thread `me` of `threads`,
   all of which must call it. Two threads take a half each where the order has halves. */
typedef void sweep_text(struct problem *p, int me, int threads, const struct sweep_opt *o,
                        struct tally *t);

/* The loops for one vector width */
struct sweep {
    int lanes;
    /* One local solve per slot, r passed on at once to the bodies or W */
    sweep_text *sweep[METHOD_COUNT][PROBLEM_KINDS];
    /* Adds to the bodies' velocities what all reactions make of them. Shared by threads as a sweep
       is. */
    void (*push)(struct problem *p, int me, int threads);
};
