/* solve/self_stress.c: the velocities that reactions make, beside them [solve/self_stress.h]. */
#include "solve/self_stress.h"

#include "solve/apply.h"

#include <math.h>
#include <stdlib.h>

/* y = W r of the slots */
static int err_move(const struct problem *p, double *r, double *y)
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

/* What reactions move, beside them */
struct moved {
    double steps, r2;    /* N^2 s^2: the squares of W r / lambda, and of r */
    double work, lambda; /* J: r . W r, and lambda r^2 */
    double most;         /* N s: the largest |r| of a contact */
};

static int err_measure(const struct problem *p, struct moved *m)
{
    size_t size = 3 * (size_t)p->slots + 1;
    double *r = calloc(size, sizeof *r), *y = calloc(size, sizeof *y);
    int e = r && y ? err_move(p, r, y) : -1;
    *m = (struct moved){ 0 };
    for (int64_t i = 0; !e && i < p->slots; i++) {
        if (p->contact[i] < 0) continue;
        double lambda = slot_lambda(p, i), r2 = 0;
        for (int k = 0; k < 3; k++) {
            double of = r[3 * i + k], to = y[3 * i + k], step = to / lambda;
            m->steps += step * step, m->work += of * to, r2 += of * of;
        }
        m->r2 += r2, m->lambda += lambda * r2, m->most = fmax(m->most, sqrt(r2));
    }
    free(r), free(y);
    return e;
}

int self_stress(const struct problem *p, double *ratio)
{
    struct moved m;
    int e = err_measure(p, &m);
    *ratio = m.r2 > 0 ? sqrt(m.steps / m.r2) : 0;
    return e;
}

int self_stress_work(const struct problem *p, double *work, double *most)
{
    struct moved m;
    int e = err_measure(p, &m);
    *work = m.lambda > 0 ? m.work / m.lambda : 0, *most = m.most;
    return e;
}
