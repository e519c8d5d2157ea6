/*
 * solve/self_stress.h: how nearly reactions hold one another,
 *
 *     |rho_a W r| / |r|,    rho_a = 1/lambda_max(W_aa),
 *
 * without units. Reactions r_0 in their cones with W r_0 = 0 move nothing: a self-stress. Where a
 * problem has one, its reactions are not unique, and those of a solve may grow without end; r/|r| then
 * tends to one. So where this number falls with eps, r/|r| is itself the certificate that contacts are
 * wedged. In ordinary piles it is 1e-2, and stays.
 */
#ifndef NSD_SELF_STRESS_H
#define NSD_SELF_STRESS_H

#include "solve/problem.h"

/* Of the reactions in the problem's slots, without what bonds and rolling friction add; 0 where all are
   0. Returns 0, or -1 when memory is short. */
int self_stress(const struct problem *p, double *ratio);
/* work = r . W r / sum of lambda_a r_a^2: reactions without end have only their rounding, others the inverse of a mass
   ratio, or more. most: N s, of |r_a|. The same returns. */
int self_stress_work(const struct problem *p, double *work, double *most);

#endif
