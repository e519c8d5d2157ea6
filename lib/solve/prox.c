/*
 * solve/prox.c: Newton's steps on all contacts at once, within proximal steps [solve/newton.h],
 * with sweeps before and between them.
 */
#include "solve/newton.h"

enum {
    SWEEPS = 100,  /* sweeps before the first step: most statuses are right by then */
    PATIENCE = 200 /* steps in a row that do not halve the criterion: it gives up */
};
#define ALPHA 1e-4 /* a at first, in multiples of W's mean diagonal */

static void polish(struct newton *w, struct solve *s)
{
    newton_polish(w, s, ALPHA, PATIENCE);
}

static int prox_run(struct solve *s)
{
    return newton_after_sweeps(s, SWEEPS, 1, polish);
}

const struct solver solver_prox = { "prox", "Newton within proximal steps on all contacts at once",
                                    0, prox_run };
