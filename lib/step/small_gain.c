/* step/small_gain.c: the work of reactions in a small step [step/small_gain.h]. */
#include "step/small_gain.h"

#include "state/rotation.h"

#include <math.h>

/* Of the work of all bodies, without regard to its sign: a gain that is an error of the sweeps */
#define GAIN 1e-3

bool small_gain_is_bounded(const struct small_run *r)
{
    if (!r->meets || r->l->s.hold || packing_has_springs(r->p) || r->loads.of || r->cell.moves)
        return false;
    for (int64_t i = 0; i < r->p->n; i++) {
        const vec3 v = r->p->v[i], w = r->p->w[i];
        if (!(r->p->mass[i] > 0) && v3_dot(v, v) + v3_dot(w, w) > 0) return false;
    }
    return true;
}

/* J: of reactions on body i, which moves */
static double work_on(const struct small_run *r, int64_t i)
{
    const struct packing *p = r->p;
    const struct body *b = &r->l->s.body[i], *was = &r->l->s.before[i];
    const vec3 dv = r->pull ? small_vec(r->pull[i].dv) : v3_scale(r->h, p->g);
    const vec3 dw = r->pull ? small_vec(r->pull[i].dw) : v3(0, 0, 0);
    const vec3 v = small_vec(b->v), w = small_vec(b->w);
    const vec3 v_free = v3_add(small_vec(was->v), dv), w_free = v3_add(small_vec(was->w), dw);
    const vec3 gains = v3_sub(w, w_free), turn = v3_add(w, w_free);
    const double turns = rotation_is(p, i)
                             ? v3_dot(rotation_momentum(p, i, r->shapes.q[i], gains), turn)
                             : p->inertia[i] * v3_dot(gains, turn);
    return 0.5 * (p->mass[i] * v3_dot(v3_sub(v, v_free), v3_add(v, v_free)) + turns);
}

/* J: of walls on bodies */
static double work_of_walls(const struct small_run *r)
{
    const struct small_list *l = r->l;
    double work = 0;
    for (int64_t i = 0; i < l->touches; i++) {
        const struct small_touch *t = &l->touch[i];
        work += v3_dot(small_vec(t->f), t->v);
        work += v3_dot(small_vec(t->m), r->wall[t->wall].spin);
    }
    for (int64_t i = 0; i < l->meetings.n; i++) {
        const struct small_meeting *m = &l->meetings.of[i];
        for (int64_t k = 0; m->key.a < 0 && k < m->points; k++) {
            const struct small_point *t = &m->point[k];
            if (!t->near) continue;
            work += v3_dot(small_vec(t->f), t->v);
            work += v3_dot(small_vec(t->m), r->wall[-1 - m->key.a].spin);
        }
    }
    return work;
}

bool small_gain_exceeds(const struct small_run *r, double *last)
{
    double gain = 0, all = 0;
    for (int64_t i = 0; i < r->p->n; i++) {
        if (!(r->l->s.body[i].im > 0)) continue;
        const double work = work_on(r, i);
        gain += work, all += fabs(work);
    }
    const double supply = work_of_walls(r);
    gain -= supply;
    const bool exceeds = gain > GAIN * (all + fabs(supply)) && gain < 0.9 * *last;
    *last = gain;
    return exceeds;
}
