/* problem/self_stress.c: the velocities that reactions make, beside them [problem/self_stress.h]. */
#include "problem/self_stress.h"

#include "problem/apply.h"

#include <math.h>
#include <stdlib.h>

/* y = W r of the slots */
static int move(const struct problem *p, double *r, double *y)
{
    struct apply a;
    if (apply_init(&a, p)) return -1;
    for (int64_t i = 0; i < p->slots; i++) {
        double u[3];
        if (p->contact[i] >= 0) slot_get(p, i, r + 3 * i, u);
    }
    problem_apply(p, &a, r, y);
    apply_free(&a);
    return 0;
}

int self_stress(const struct problem *p, double *ratio)
{
    size_t size = 3 * (size_t)p->slots + 1;
    double *r = calloc(size, sizeof *r), *y = calloc(size, sizeof *y), moved = 0, all = 0;
    int e = r && y ? move(p, r, y) : -1;
    for (int64_t i = 0; !e && i < p->slots; i++) {
        if (p->contact[i] < 0) continue;
        double lambda = slot_lambda(p, i);
        for (int k = 0; k < 3; k++) {
            double step = y[3 * i + k] / lambda;
            moved += step * step, all += r[3 * i + k] * r[3 * i + k];
        }
    }
    free(r), free(y);
    *ratio = all > 0 ? sqrt(moved / all) : 0;
    return e;
}
