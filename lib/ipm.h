/*
 * ipm.h: a primal-dual interior point method for all contacts at once.
 *
 * In x = (mu r_n, r_t) and z = (u_n/mu + |u_t|, u_t) Coulomb's and Signorini's laws read
 *
 *     x in K,  z in K,  x o z = 0,     K = { |x_t| <= x_0 }                     [De Saxce's u^]
 *
 * with the product o of K's Jordan algebra, and the method follows x o z = g e to g = 0 with Newton
 * steps in Nesterov's and Todd's scaling: a step solves
 *
 *     (W + t E W + D T D) dr = ...,     T = the scaling, T x = z,  D = diag(mu, 1, 1),
 *
 * E the derivative of mu |u_t|, which makes the problem one of no minimum: t = 1 is Newton's, t = 0 the
 * fixed point of De Saxce. |u_t| is smoothed over a width of g. The path may fold, and then the step
 * with t = 1 leads nowhere: the next t is tried.
 */
#ifndef NSD_IPM_H
#define NSD_IPM_H

#include "newton.h"

struct ipm;

#define IPM_NEAR 2e-7 /* of the scaled natural map: from there on Newton sees the statuses */

/* From the rows' reactions; NULL when memory is short. It uses w for its own while it runs. */
struct ipm *ipm_new(struct newton *w, struct solve *);
void ipm_free(struct ipm *);

/*
 * On to where the scaled natural map is at most `natural`, within the reach of newton_polish(); false
 * where so many steps do not get it there. The best that it found is in the rows. May be called again for less.
 */
bool ipm_approach(struct ipm *, struct solve *, double natural, int steps);

#endif
