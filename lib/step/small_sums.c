/* step/small_sums.c: sums of what bodies do to walls, in small steps [step/small_sums.h]. */
#include "step/small_sums.h"

#include "step/small_wall.h"

#include <stdlib.h>

int small_sums_init(struct small_run *r, struct failure *failure)
{
    if (!r->p->sums.n) return 0;
    r->sums = calloc((size_t)r->p->walls + 1, sizeof *r->sums);
    return r->sums ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for the sums");
}

/* The mean of what the body of a touch had before the step and has after it */
static vec3 small_mean(const double was[3], const double is[3])
{
    return v3_scale(0.5, v3_add(small_vec(was), small_vec(is)));
}

static void add_touch_sums(struct face_sums *to, const struct small_run *r,
                           const struct small_touch *t)
{
    const struct small *s = &r->l->s;
    const struct body *was = &s->before[t->body], *b = &s->body[t->body];
    const vec3 push = small_vec(t->f), m = small_vec(t->m), spin = r->wall[t->wall].spin;
    const vec3 f = v3_axpy(push, -t->hold[HOLD_PULL], t->n);
    const vec3 x = v3_axpy(small_vec(s->place[t->body].x), -t->arm, t->n);
    const vec3 w = small_mean(was->w, b->w), wall = v3_add(t->v, small_load_velocity(r, t));
    const vec3 v = v3_sub(small_mean(was->v, b->v), wall);
    const vec3 u = v3_axpy(v, -t->arm, v3_cross(w, t->n));
    const vec3 ut = v3_axpy(u, -v3_dot(u, t->n), t->n);
    const double rn = v3_dot(f, t->n);
    to->impulse = v3_sub(to->impulse, f);
    to->moment = v3_sub(to->moment, v3_add(v3_cross(x, f), m));
    to->normal += rn, to->tangential += v3_norm(v3_axpy(f, -rn, t->n));
    to->work -= v3_dot(f, wall) + v3_dot(m, spin);
    to->friction -= v3_dot(f, ut) + v3_dot(m, v3_sub(w, spin));
    if (rn > 0) to->rub += rn * v3_norm(ut);
}

void small_sums_step(struct small_run *r)
{
    for (int64_t i = 0; i < r->l->touches; i++) {
        const struct small_touch *t = &r->l->touch[i];
        if (t->near) add_touch_sums(&r->sums[t->wall], r, t);
    }
}

void small_sums_give(const struct small_run *r)
{
    for (int32_t w = 0; r->sums && w < r->p->walls; w++) {
        struct face_sums *to = &r->p->sums.face[w];
        const struct face_sums *x = &r->sums[w];
        to->impulse = v3_add(to->impulse, x->impulse), to->moment = v3_add(to->moment, x->moment);
        to->normal += x->normal, to->tangential += x->tangential;
        to->work += x->work, to->friction += x->friction, to->rub += x->rub;
    }
}
