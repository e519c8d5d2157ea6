/*
 * solve/err.h: how far (u, r) is from satisfying the law and the motion.
 *
 * eps_glob [estimator, corrected]: the mean over the contacts of
 *
 *     eps_motion = |u~ - (u~_free + W~ r)|       u~: what the local method believes
 *     eps_proj   = |r - proj(r, K_mu)|
 *     eps_bc     = |u~.r + mu r_n |u~_t||
 *     eps_pen    = -min(0, u~_n)
 *
 * with r as a force, r/dt. It is 0 where there is no contact. A method that has no u~ of its own
 * (SBP, SAL) is judged by the motion's u~, and eps_motion is 0. Where the law sees gaps u~_n is what
 * it sees, with the gap in it [state/offset.h]; all measures here are of that u~.
 */
#pragma once

#include "solve/judge.h"
#include "solve/problem.h"
#include "state/report.h"

/* Computes the terms asked for, of all contacts but without max_overlap; the rest is 0. believes: u
   is the local method's own. The same bits for any number of threads. */
void err_eval(struct err *e, const struct problem *p, bool believes, enum err_terms terms,
              int threads);

/* The number that a criterion is about: eps_glob, its scaled form, or the natural map */
double err_of(const struct err *e, enum criterion c);
/*
 * The number that a solve compares with eps: err_of(), except that a natural map does not count
 * where the error of the velocities is as large as the velocities that the contacts have to change
 * (err.stray). The map is relative to |r|, so reactions that grow without end make it small.
 */
double err_value(const struct err *e, enum criterion c, double eps);
enum err_terms err_terms_of(enum criterion c);
/* Has the problem no solution? Reactions grow without end, and bodies approach all the same; by the natural map, which is
   relative to the reactions, it only seems good. */
bool err_no_solution(const struct report *r);

/*
 * How nearly reactions hold one another,
 *
 *     |rho_a W r| / |r|,    rho_a = 1/lambda_max(W_aa),
 *
 * without units. Reactions r_0 in their cones with W r_0 = 0 move nothing: a self-stress. Where a
 * problem has one, its reactions are not unique, and those of a solve may grow without end; r/|r| then
 * tends to one. So where this number falls with eps, r/|r| is itself the certificate that contacts are
 * wedged. In ordinary piles it is 1e-2, and stays.
 */

/* Of the reactions in the problem's slots, without what bonds and rolling friction add; 0 where all are
   0. Returns 0, or -1 when memory is short. */
int self_stress(const struct problem *p, double *ratio);
/* work = r . W r / sum of lambda_a r_a^2: reactions without end have only their rounding, others the inverse of a mass
   ratio, or more. most: N s, of |r_a|. The same returns. */
int self_stress_work(const struct problem *p, double *work, double *most);
