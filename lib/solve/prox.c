/* solve/prox.c: the solvers that factorise, each alone: Newton within proximal steps, and interior point.
   What is too large for factors gets sweeps. */
#include "solve/ipm.h"

static double omega(const struct solve *s, double usual)
{
    return s->o->relax > 0 ? s->o->relax : usual;
}

static int prox(struct solve *s)
{
    struct newton w;
    if (nlgs_sweeps(s, 100, omega(s, 1))) return -1;
    if (solve_met(s) || solve_spent(s)) return 0;
    if (newton_init(&w, s->p)) return nlgs_sweeps(s, s->o->max_sweeps, omega(s, 1));
    newton_polish(&w, s, 1e-4, 200);
    newton_free(&w);
    return 0;
}

static int ipm(struct solve *s)
{
    struct newton w;
    if (nlgs_sweeps(s, 500, omega(s, 1.3))) return -1;
    if (solve_met(s) || solve_spent(s)) return 0;
    if (newton_init(&w, s->p)) return nlgs_sweeps(s, s->o->max_sweeps, omega(s, 1));
    ipm_solve(&w, s);
    newton_back(&w, s);
    newton_free(&w);
    return 0;
}

const struct solver solver_prox = { "prox", 0, prox };
const struct solver solver_ipm = { "ipm", 0, ipm };
