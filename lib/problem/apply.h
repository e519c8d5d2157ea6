/*
 * problem/apply.h: what reactions make of velocities, for all contacts at once: W r without W, and the
 * bodies' velocities made anew.
 */
#ifndef NSD_APPLY_H
#define NSD_APPLY_H

#include "problem/problem.h"

/* Room for a product */
struct apply {
    struct body *body; /* of a packing: a copy, whose velocities are those of the factor alone */
    double *factor, *out, *zero; /* [n d] of a problem given by W */
};

int apply_init(struct apply *a, const struct problem *p); /* 0; -1 when memory is short */
void apply_free(struct apply *a);

/* y[slots][3] = W~ x[slots][3], m/s of N s; slots without a contact are passed over. */
void problem_apply(const struct problem *p, struct apply *a, const double *x, double *y);

/*
 * The bodies' velocities anew, v_free + M^-1 P r, from the reactions alone: those to which every sweep
 * has added carry the rounding of all of its additions. Given by W there is nothing to do. The same bits
 * for any number of threads.
 */
void problem_renew(struct problem *p, int threads);

/* r[slots][3] (N s) become the reactions; the bodies' velocities follow from them alone. */
void problem_react(struct problem *p, const double *r, int threads);

#endif
