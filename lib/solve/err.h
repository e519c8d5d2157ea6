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
#ifndef NSD_ERR_H
#define NSD_ERR_H

#include "solve/judge.h"
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

#endif
