/* prox.c: the solvers that factorise, each alone: Newton within proximal steps, and interior point. */
#include "ipm.h"

static int prox(struct solve *s)
{
    struct newton w;
    if (nlgs_sweeps(s, 100, s->o->relax > 0 ? s->o->relax : 1)) return -1;
    if (solve_met(s) || solve_spent(s) || newton_init(&w, s->p)) return 0;
    newton_polish(&w, s, 1e-4, 200);
    newton_free(&w);
    return 0;
}

static int ipm(struct solve *s)
{
    struct newton w;
    if (nlgs_sweeps(s, 500, s->o->relax > 0 ? s->o->relax : 1.3)) return -1;
    if (solve_met(s) || solve_spent(s) || newton_init(&w, s->p)) return 0;
    struct ipm *m = ipm_new(&w, s);
    bool more = m != NULL;
    for (double near = IPM_NEAR; more && near > 1e-12 && !solve_met(s) && !solve_spent(s);
         near /= 10) {
        more = ipm_approach(m, s, near, 120);
        if (!solve_met(s)) newton_polish(&w, s, 1e-7, 6);
    }
    ipm_free(m);
    newton_free(&w);
    return 0;
}

const struct solver solver_prox = { "prox", 0, prox };
const struct solver solver_ipm = { "ipm", 0, ipm };
