/*
 * run/run_total.h: what the steps of a run of nsd-step add up to, and what is said of them on standard error: once, where
 * something first goes worse than it may, and at the end.
 */
#pragma once

#include "file/frame.h"
#include "run/options.h"
#include "state/account.h"

/* All zero to begin with, but for radii and silent */
struct run_total {
    int64_t sweeps, safeguarded, gave_up;
    int64_t missed, first_missed; /* steps that have not converged, and the first's number */
    double worst;                 /* the largest error of those */
    enum criterion criterion;     /* which error that is */
    double eps;                   /* and what was asked of it */
    int64_t growing;              /* of those the ones whose reactions grow and only seem good */
    double approach;              /* m/s: of bodies in these steps, the largest */
    int64_t abandoned;            /* steps whose solver knew no further way */
    int64_t divided, substeps;    /* steps that were divided, and into how many in all */
    int64_t small, small_steps;   /* steps that were made in small ones, and in how many in all; */
    double missing, missing_mean; /* impulse, of the steps whose errors are known: the largest */
    int64_t missing_step, missing_id;
    double distance; /* of reactions of kept frames from converged ones, the largest */
    int64_t distance_step;
    int64_t limited; /* of those the ones that ended at the limit of their sweeps */
    int64_t waited;  /* steps in which more grains were due than may break in one */
    double radii;    /* of small steps, as asked for; 0: there are none */
    bool silent;     /* words would get between the frames */
    bool lacks;      /* small steps do not have all of the packing */
    double seconds;
    struct account account; /* of this run */
    int64_t ended;          /* the step that failed, with which the run has ended; 0: none */
};

/* Before a step of this packing: what small steps cannot do, what waits to break. distributed: no process has all bodies */
void run_total_begin_step(struct run_total *total, const struct packing *p, bool distributed);
/* Adds a step's report, and to the frame's account and that of the run; made: the bodies have moved. Returns whether the run
   ends with it. */
bool run_total_add(struct run_total *total, struct frame *f, bool made);
/* At the end: of the steps made, then of the packing, then the worst */
void run_total_say_steps(const struct run_total *total, int64_t made);
void run_total_say_packing(const struct run_total *total, const struct packing *p);
void run_total_say_worst(const struct run_total *total, const struct names *names);
