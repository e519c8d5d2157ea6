/*
 * local_sal.c: the simple augmented Lagrangian, one step of the projected gradient [gradientAL]
 *
 *     tau = r - rho u,     r_n = max(0, tau_n),     r_t = min(1, mu r_n/|tau_t|) tau_t.
 *
 * Its rho is bounded as that of SBP.
 */
#include "local_newton.h"

static void solve(struct local *l, const struct local_opt *opt)
{
    (void)opt;
    double tau[3];
    local_velocity(l);
    disc_predict(l->rho, l->r, l->u, tau);
    disc_project(l->mu, tau, l->r);
    l->steps = 0, l->trouble = LOCAL_FINE;
}

const struct method local_sal = { "sal",
                                  "simple augmented Lagrangian: one projected step of the gradient",
                                  1.75, false, solve };
