/*
 * solve/apply.h: the velocities that reactions make, for all contacts at once: W r, which
 * needs no assembled W, and the bodies' velocities computed again.
 */
#pragma once

#include "solve/problem.h"

/* Work space of problem_apply() */
struct apply {
    struct body *body;           /* of a packing: a copy, with the velocities that x alone makes */
    double *factor, *out, *zero; /* [n d] of a problem given by W */
};

int apply_init(struct apply *a, const struct problem *p); /* 0; -1 when memory is short */
void apply_free(struct apply *a);

/* y[slots][3] (m/s) = W~ x[slots][3] (N s); slots without a contact are left out. */
void problem_apply(const struct problem *p, struct apply *a, const double *x, double *y);

/*
 * Computes the bodies' velocities again from the reactions alone, v_free + M^-1 P r: those to which
 * every sweep has added carry the rounding of all these additions. Does nothing for a problem given
 * by W. The result has the same bits for any number of threads.
 */
void problem_renew(struct problem *p, int threads);

/* r[slots][3] (N s) become the reactions, and the bodies' velocities are computed from them. */
void problem_react(struct problem *p, const double *r, int threads);
