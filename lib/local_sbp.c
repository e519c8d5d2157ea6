/*
 * local_sbp.c: the standard bi-potential method, one step of Uzawa [uzawa1, uzawa2]
 *
 *     tau = r - rho (u + mu |u_t| n),     r = proj(tau, K_mu).
 *
 * It contracts when rho lambda_max(W_cc) < 2; the paper's rho < 2 m_red is enough for n alone: the
 * tangential eigenvalue of a ball is 3.5/m_red.
 */
#include "local_newton.h"

static void solve(struct local *l, const struct local_opt *opt)
{
    (void)opt;
    double tau[3];
    local_velocity(l);
    cone_predict(l->mu, l->rho, l->r, l->u, tau);
    cone_project(l->mu, tau, l->r);
    l->steps = 0, l->trouble = LOCAL_FINE;
}

const struct method local_sbp = { "sbp", "standard bi-potential: one projected step of Uzawa", 1.75,
                                  false, solve };
