/*
 * solve/local_sal.h: the simple augmented Lagrangian, one step of the projected gradient [gradientAL]
 *
 *     tau = r - rho u,     r_n = max(0, tau_n),     r_t = min(1, mu r_n/|tau_t|) tau_t.
 *
 * The bound on rho is that of SBP.
 */
#ifndef NSD_LOCAL_SAL_H
#define NSD_LOCAL_SAL_H

#include "solve/local.h"

ALWAYS_INLINE void sal_solve(struct local *l, const struct local_opt *opt)
{
    (void)opt;
    vd tau[3];
    local_clear_report(l);
    disc_predict(l->rho, l->r, l->v, tau);
    disc_project(l->mu, tau, l->r);
}

#endif
