/*
 * solve/judge.h: the inner loops over bundles that ask how well reactions satisfy the law: velocities,
 * and the terms of the errors. Compiled for each vector width, as solve/sweep.c is.
 */
#pragma once

#include "solve/problem.h"

/* Sums and maxima over contacts, each in eight parts: lane k of every bundle goes into part k. */
struct sums {
    double motion[BUNDLE], proj[BUNDLE], bipotential[BUNDLE], penetration[BUNDLE];
    double natural2[BUNDLE], siconos2[BUNDLE], velocity2[BUNDLE], r2[BUNDLE];
    double max_pen[BUNDLE], max_true[BUNDLE];
    double
        max_velocity2[BUNDLE]; /* m^2/s^2: the largest term of velocity2, but of jammed contacts */
    double jammed[BUNDLE];     /* contacts whose reactions grow without end */
};

/*
 * A contact is jammed where its reaction is without end [problem_is_endless()] and it misses the law by more than
 * MISSES units all the same: the bodies cannot give way. A light ball between heavy ones has a lambda r of their
 * mass ratio times their velocity, and a solution, so that r counts as well, by the heaviest mass. Leaps along the
 * growth [solve/anderson.c] soon make more of a contact that has no solution. Where they have gone too far, bodies
 * give way wildly, and nothing is jammed.
 */
#define MISSES 1e-3
/* Of |lambda r|: below it, what a contact seems to miss the law by is rounding. */
#define ROUNDING_OF_R 3.6e-15

enum err_terms { ERR_TERMS = 1, ERR_NATURAL = 2, ERR_ALL = 3 };

/* The loops for one vector width */
struct judge {
    /* Bundles first .. end-1: adds to the sums what solve/err.h defines. */
    void (*judge)(const struct problem *p, int64_t first, int64_t end, bool believes,
                  enum err_terms terms, struct sums *s);
    /* Bundles first .. end-1: u of the slots becomes the motion's. */
    void (*velocities)(struct problem *p, int64_t first, int64_t end);
};
