/* step/small_wall.c: where walls are in a small step, and how they move [step/small_wall.h]. */
#include "step/small_wall.h"

#include <math.h>
#include <string.h>

void small_walls_set(struct small_run *r)
{
    const struct packing *p = r->p;
    const double t = p->t + r->ahead;
    for (int32_t w = 0; w < p->walls; w++) {
        const struct wall *wall = &p->wall[w];
        const vec3 at = wall_at(p, wall, t);
        const double way = r->wall[w].way + r->h * wall_top_speed(p, wall);
        r->wall[w] = (struct small_wall){ .there = wall_there(wall, t),
                                          .pose = wall_pose(p, wall, t),
                                          .at = at,
                                          .v = wall_held(p, wall, at),
                                          .spin = wall_spin(p, wall),
                                          .way = way };
        r->wall[w].belt = quat_turn(wall_pose(p, wall, p->t + p->dt / 2).q, wall->belt);
    }
}

vec3 small_wall_velocity(const struct small_wall *w, vec3 x, vec3 n)
{
    const vec3 v = v3_add(w->v, v3_cross(w->spin, v3_sub(x, w->at)));
    return v3_add(v, v3_axpy(w->belt, -v3_dot(w->belt, n), n));
}

bool small_look_at_touch(const struct small_run *r, struct small_touch *t, double reach)
{
    const struct small_wall *w = &r->wall[t->wall];
    const struct small_place *b = &r->l->s.place[t->body];
    const vec3 x = small_vec(b->x);
    if (!w->there) return false;
    vec3 n;
    const double arm = small_wall_distance(r->p, &w->pose, t->wall, x, b->r + reach, &n);
    if (!(arm - b->r <= reach)) return false;
    t->arm = arm, t->n = n;
    t->v = small_wall_velocity(w, v3_axpy(x, -t->arm, t->n), t->n);
    return true;
}

vec3 small_touch_velocity(const struct small_touch *t, const struct body *b)
{
    vec3 v = v3_sub(small_vec(b->v), t->v);
    return v3_axpy(v, -t->arm, v3_cross(small_vec(b->w), t->n));
}

void small_touch_law(const struct small_run *r, const struct small_touch *t, struct small_law *l)
{
    const struct small *s = &r->l->s;
    const struct body *b = &s->body[t->body];
    *l = (struct small_law){ .mu = t->mu,
                             .calm = s->rate.calm,
                             .gap = t->arm - s->place[t->body].r };
    small_array(l->n, t->n), small_array(l->u, small_touch_velocity(t, b));
    l->wn = b->im, l->wt = b->im + t->arm * t->arm * b->ii;
    l->cn = s->rate.soft * l->wn, l->ct = s->rate.soft * l->wt;
    memcpy(l->f, t->f, sizeof l->f), memcpy(l->q, t->q, sizeof l->q);
}

double small_wall_speed(const struct packing *p)
{
    double most = 0;
    for (int32_t w = 0; w < p->walls; w++)
        most = fmax(most, wall_top_speed(p, &p->wall[w]) + v3_norm(p->wall[w].belt));
    return most;
}
