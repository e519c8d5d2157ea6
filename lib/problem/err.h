/*
 * problem/err.h: how far (u, r) is from the law and from the motion.
 *
 * eps_glob [estimator, corrected]: the mean over the contacts of
 *
 *     eps_motion = |u~ - (u~_free + W~ r)|       u~: what the local method believes
 *     eps_proj   = |r - proj(r, K_mu)|
 *     eps_bc     = |u~.r + mu r_n |u~_t||
 *     eps_pen    = -min(0, u~_n)
 *
 * r as a force, r/dt. It is 0 where there is no contact. A method that believes nothing of its own
 * (SBP, SAL) is judged by the motion's u~, and eps_motion vanishes.
 */
#ifndef NSD_ERR_H
#define NSD_ERR_H

#include "problem/report.h"
#include "problem/sweep.h"

/* All of *e but max_overlap, or only a part of it (the rest 0). The same bits for any threads. */
void err_eval(struct err *e, const struct problem *p, bool believes, enum err_terms terms,
              int threads);

/* The number that a criterion is about */
double err_of(const struct err *e, enum criterion c);
/*
 * The number that a solve compares with eps. It is err_of(), but that a natural map is not believed where
 * what is wrong with the velocities is as large as what the contacts have to change (err.stray): the map is
 * relative to |r|, and reactions that grow without end make it small.
 */
double err_value(const struct err *e, enum criterion c, double eps);
enum err_terms err_terms_of(enum criterion c);

#endif
