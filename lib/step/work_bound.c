/* step/work_bound.c: see step/work_bound.h. */
#include "step/work_bound.h"

#include "state/rotation.h"
#include "step/balance.h"

#include <math.h>

/* Of r . W r/2: what rounding may leave */
#define LEAST 1e-9

/* J: r . W r/2, and what the motion without r and without forces is less than u_free, times r/2 */
struct own_work {
    double self, falls;
};

static struct own_work own_work(const struct packing *p, const struct impulses *all,
                                const struct impulses *only)
{
    struct own_work w = { 0 };
    for (int64_t i = 0; i < p->n; i++) {
        if (!(p->mass[i] > 0)) continue;
        const vec3 f = only->force[i], m = only->moment[i];
        const quat q = rotation_is(p, i) ? rotation_predict(p, i) : p->q[i];
        const vec3 others = v3_sub(all->force[i], f), turns = v3_sub(all->moment[i], m);
        const vec3 fall = v3_axpy(v3_scale(p->dt, p->g), 1 / p->mass[i], others);
        w.self += 0.5 * (v3_dot(f, f) / p->mass[i] + v3_dot(m, rotation_spin(p, i, q, m)));
        w.falls += 0.5 * (v3_dot(f, fall) + v3_dot(m, rotation_spin(p, i, q, turns)));
    }
    for (int32_t k = 0; k < only->freedoms.n; k++) {
        const struct freedom *f = &only->freedoms.f[k];
        w.self += 0.5 * only->yield[k] * only->yield[k] / f->mass;
        w.falls += 0.5 * only->yield[k] * p->dt * f->force / f->mass;
    }
    return w;
}

int work_reduce(const struct packing *p, struct contacts *s, bool *again, struct failure *failure)
{
    struct impulses all = { 0 }, only = { 0 };
    struct balance b = { 0 };
    struct packing without = *p; // forces from outside
    without.outside.force = without.outside.torque = NULL, without.pulls.n = 0;
    *again = false;
    if (!impulses_init(&all, p, s, false, failure) &&
        !impulses_init(&only, &without, s, false, failure) &&
        !balance_step(&b, p, s, &all, NULL, failure)) {
        const struct own_work w = own_work(p, &all, &only);
        const double excess = w.falls - b.dissipation - b.gained;
        const double times = fmax(0, 1 - excess / w.self);
        *again = excess > LEAST * w.self && isfinite(times);
        for (int64_t i = 0; *again && i < s->n; i++)
            for (int k = 0; k < 3; k++) {
                s->found[i].r[k] *= times;
                if (s->moment) s->moment[i][k] *= times;
            }
    }
    impulses_free(&all), impulses_free(&only);
    return failure->status;
}
