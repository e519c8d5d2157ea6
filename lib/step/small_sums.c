/* step/small_sums.c: sums of what bodies do to walls, in small steps [step/small_sums.h]. */
#include "step/small_sums.h"

#include "state/face_of.h"
#include "step/small_wall.h"
#include "step/sum_step.h"

#include <stdlib.h>

int small_sums_init(struct small_run *r, struct failure *failure)
{
    if (!r->p->sums.n) return 0;
    if (sum_step_faces(r->p, failure)) return failure->status;
    r->sums = calloc((size_t)r->p->sums.n + 1, sizeof *r->sums);
    return r->sums ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for the sums");
}

/* The mean of what a body had before the step and has after it */
static vec3 small_mean(const double was[3], const double is[3])
{
    return v3_scale(0.5, v3_add(small_vec(was), small_vec(is)));
}

/* What a body does to a wall at a place */
struct small_push {
    vec3 f, m, x, n; /* N s, N m s: on the body; m; towards it */
    vec3 v, u, w;    /* m/s: of the wall; m/s, rad/s: of the body there, against it, and its spin */
};

static void add_push(struct face_sums *to, const struct small_push *y, vec3 spin)
{
    const double rn = v3_dot(y->f, y->n);
    const vec3 ut = v3_axpy(y->u, -v3_dot(y->u, y->n), y->n);
    to->impulse = v3_sub(to->impulse, y->f);
    to->moment = v3_sub(to->moment, v3_add(v3_cross(y->x, y->f), y->m));
    to->normal += rn, to->tangential += v3_norm(v3_axpy(y->f, -rn, y->n));
    to->work -= v3_dot(y->f, y->v) + v3_dot(y->m, spin);
    to->friction -= v3_dot(y->f, ut) + v3_dot(y->m, v3_sub(y->w, spin));
    if (rn > 0) to->rub += rn * v3_norm(ut);
}

static void add_touch_sums(struct face_sums *to, const struct small_run *r,
                           const struct small_touch *t)
{
    const struct small *s = &r->l->s;
    const struct body *was = &s->before[t->body], *b = &s->body[t->body];
    struct small_push y = { .m = small_vec(t->m), .n = t->n, .w = small_mean(was->w, b->w) };
    y.v = v3_add(t->v, small_load_velocity(r, t));
    y.f = v3_axpy(small_vec(t->f), -t->hold[HOLD_PULL], t->n);
    y.x = v3_axpy(small_vec(s->place[t->body].x), -t->arm, t->n);
    y.u = v3_axpy(v3_sub(small_mean(was->v, b->v), y.v), -t->arm, v3_cross(y.w, t->n));
    add_push(to, &y, r->wall[t->wall].spin);
}

static void add_point_sums(const struct small_run *r, const struct small_meeting *m,
                           const struct small_point *t)
{
    const struct wall_faces *faces = r->p->sums.faces;
    const struct body *was = &r->l->s.before[m->key.b], *b = &r->l->s.body[m->key.b];
    const struct contact c = { .a = m->key.a, .b = m->key.b, .x = t->x, .gap = t->gap };
    const int32_t wall = -1 - m->key.a;
    struct small_push y = {
        .f = small_vec(t->f), .m = small_vec(t->m), .x = t->x, .n = t->n, .v = t->v
    };
    if (small_meeting_loaded(r, m)) y.v = v3_axpy(y.v, small_load_speed(r, wall), t->D);
    y.w = small_mean(was->w, b->w);
    y.u = v3_add(v3_sub(small_mean(was->v, b->v), y.v), v3_cross(y.w, t->b));
    const int32_t face = faces->first[wall] + face_of_contact(faces, r->p, &c, r->ahead);
    add_push(&r->sums[face], &y, r->wall[wall].spin);
}

void small_sums_step(struct small_run *r)
{
    for (int64_t i = 0; i < r->l->touches; i++) {
        const struct small_touch *t = &r->l->touch[i];
        if (t->near) add_touch_sums(&r->sums[r->p->sums.faces->first[t->wall]], r, t);
    }
    for (int64_t i = 0; i < r->l->meetings.n; i++) {
        const struct small_meeting *m = &r->l->meetings.of[i];
        for (int64_t k = 0; m->key.a < 0 && k < m->points; k++)
            if (m->point[k].near && !small_is_zero(m->point[k].f))
                add_point_sums(r, m, &m->point[k]);
    }
}

void small_sums_give(const struct small_run *r)
{
    for (int32_t k = 0; r->sums && k < r->p->sums.n; k++) {
        struct face_sums *to = &r->p->sums.face[k];
        const struct face_sums *x = &r->sums[k];
        to->impulse = v3_add(to->impulse, x->impulse), to->moment = v3_add(to->moment, x->moment);
        to->normal += x->normal, to->tangential += x->tangential;
        to->work += x->work, to->friction += x->friction, to->rub += x->rub;
    }
}
