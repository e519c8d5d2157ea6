/*
 * solve/local_sbp.h: the standard bi-potential method, one step of Uzawa [uzawa1, uzawa2]
 *
 *     tau = r - rho (u + mu |u_t| n),     r = proj(tau, K_mu).
 *
 * It contracts when rho lambda_max(W_cc) < 2. The paper's rho < 2 m_red suffices along n only: the
 * tangential eigenvalue of a ball is 3.5/m_red.
 */
#ifndef NSD_LOCAL_SBP_H
#define NSD_LOCAL_SBP_H

#include "solve/local.h"

ALWAYS_INLINE void sbp_solve(struct local *l, const struct local_opt *opt)
{
    (void)opt;
    vd tau[3];
    local_clear_report(l);
    cone_predict(l->mu, l->rho, l->r, l->v, tau);
    cone_project(l->mu, tau, l->r);
}

#endif
