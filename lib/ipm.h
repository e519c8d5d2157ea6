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

/*
 * From the rows' reactions on to where newton_polish() ends; where that does not, from other starts.
 * It uses w for its own. The best that it found is in the rows.
 */
void ipm_solve(struct newton *w, struct solve *);

#endif
