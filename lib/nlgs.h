/*
 * nlgs.h: the non-linear Gauss-Seidel method [paper, 3.1]: sweep over the contacts, each solved by a
 * local method with the others held still, until the criterion is met.
 */
#ifndef NSD_NLGS_H
#define NSD_NLGS_H

#include "err.h"
#include "method.h"

struct nlgs_opt {
    const struct method *method;
    struct local_opt local;
    enum criterion criterion;
    double eps;
    int32_t max_sweeps;
    double relax; /* omega: r + omega (r_new - r), back onto the cone */
    int threads;
    bool every_sweep; /* evaluate the criterion after every sweep, not only when it may be met */
    bool history;     /* keep the terms of every sweep (implies every_sweep) */
    void (*progress)(int32_t sweeps, double value); /* told of each evaluation; or NULL */
};

/*
 * Sweeps problem from the r that it has until the criterion is at most eps, or max_sweeps. The rows
 * then hold r and u. Fills err (all of it but max_overlap), criterion, eps, sweeps, converged,
 * counts, seconds and history of the report. Returns 0, or -1 when memory is short.
 *
 * The criterion is evaluated after each of the first 40 sweeps, when the largest change of a sweep,
 * gathered on the way, says that it may be met, and every 25 sweeps. What is reported is always its
 * true value.
 */
int nlgs_solve(struct problem *, const struct nlgs_opt *, struct report *);

#endif
