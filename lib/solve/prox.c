/*
 * solve/prox.c: Newton's steps on all contacts at once, within proximal steps [solve/newton.h],
 * with sweeps before and between them.
 */
#include "solve/newton.h"
#include "solve/nlgs.h"

enum {
    SWEEPS = 100,  /* sweeps before the first step: most statuses are right by then */
    PATIENCE = 200 /* steps in a row that do not halve the criterion: it gives up */
};
#define ALPHA 1e-4 /* a at first, in multiples of W's mean diagonal */

static int run(struct solve *s)
{
    struct newton w;
    const char *reason;
    if (nlgs_sweeps(s, SWEEPS, s->o->relax > 0 ? s->o->relax : 1)) return -1;
    if (solve_over(s)) return 0;
    int e = newton_init(&w, s, &reason);
    if (e) return e < 0 ? -1 : nlgs_fall_back(s, reason);
    e = solve_keep_best(s);
    if (!e) newton_polish(&w, s, ALPHA, PATIENCE);
    newton_free(&w);
    return e;
}

const struct solver solver_prox = { "prox", "Newton within proximal steps on all contacts at once",
                                    0, run };
