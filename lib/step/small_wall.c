/* step/small_wall.c: where walls are in a small step, and how they move [step/small_wall.h]. */
#include "step/small_wall.h"

#include <math.h>
#include <string.h>

/* rad/s: what is prescribed */
static vec3 small_spin_held(const struct packing *p, const struct wall *w)
{
    const vec3 spin = wall_spin(p, w);
    return w->load.way == LOAD_TURNS ? v3_axpy(spin, -w->load.speed, w->load.axis) : spin;
}

void small_walls_set(struct small_run *r)
{
    const struct packing *p = r->p;
    const double t = p->t + r->ahead;
    for (int32_t w = 0; w < p->walls; w++) {
        const struct wall *wall = &p->wall[w];
        const vec3 at = wall_at(p, wall, t);
        const double top = wall_top_speed(p, wall), way = r->wall[w].way + r->h * top;
        r->wall[w] = (struct small_wall){ .there = wall_there(wall, t),
                                          .pose = wall_pose(p, wall, t),
                                          .at = at,
                                          .v = wall_held(p, wall, at),
                                          .spin = wall_spin(p, wall),
                                          .held = small_spin_held(p, wall),
                                          .top = top + v3_norm(wall->belt),
                                          .way = way };
        r->wall[w].belt = quat_turn(wall_pose(p, wall, p->t + p->dt / 2).q, wall->belt);
    }
}

vec3 small_wall_velocity(const struct small_wall *w, vec3 x, vec3 n)
{
    const vec3 v = v3_add(w->v, v3_cross(w->held, v3_sub(x, w->at)));
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

vec3 small_load_material(const struct small_run *r, int32_t wall, int32_t body, vec3 x)
{
    const struct contact c = { .a = -1 - wall, .b = body, .x = x };
    const struct freedom *f = &r->loads.list.f[r->loads.of[wall]];
    return v3_scale(-1, freedom_direction(f, r->p, &c, r->ahead, r->cell.edge));
}

vec3 small_load_direction(const struct small_run *r, const struct small_touch *t)
{
    const vec3 x = v3_axpy(small_vec(r->l->s.place[t->body].x), -t->arm, t->n);
    return small_load_material(r, t->wall, t->body, x);
}

void small_load_push(struct small_run *r, const struct small_touch *t, vec3 f)
{
    if (!small_is_loaded(r, t)) return;
    const int32_t k = r->loads.of[t->wall];
    r->loads.change[k] -= v3_dot(small_load_direction(r, t), f) / r->loads.list.f[k].mass;
}

double small_load_speed(const struct small_run *r, int32_t wall)
{
    const int32_t k = r->loads.of[wall];
    return r->loads.list.f[k].speed + 0.5 * r->loads.change[k];
}

vec3 small_load_velocity(const struct small_run *r, const struct small_touch *t)
{
    if (!small_is_loaded(r, t)) return v3(0, 0, 0);
    return v3_scale(small_load_speed(r, t->wall), small_load_direction(r, t));
}

vec3 small_touch_before(const struct small_run *r, const struct small_touch *t)
{
    const vec3 u = small_touch_velocity(t, &r->l->s.before[t->body]);
    if (!small_is_loaded(r, t)) return u;
    const double s = r->loads.list.f[r->loads.of[t->wall]].speed;
    return v3_axpy(u, -s, small_load_direction(r, t));
}

void small_touch_law(const struct small_run *r, const struct small_touch *t, struct small_law *l)
{
    const struct small *s = &r->l->s;
    const struct body *b = &s->body[t->body];
    *l = (struct small_law){ .mu = t->mu,
                             .calm = s->rate.calm,
                             .gap = t->arm - s->place[t->body].r };
    vec3 u = small_touch_velocity(t, b);
    if (small_is_loaded(r, t)) {
        const int32_t k = r->loads.of[t->wall];
        const double speed = r->loads.list.f[k].speed + r->loads.change[k];
        u = v3_axpy(u, -speed, small_load_direction(r, t));
    }
    small_array(l->n, t->n), small_array(l->u, u);
    l->wn = b->im, l->wt = b->im + t->arm * t->arm * b->ii;
    l->cn = s->rate.soft * l->wn, l->ct = s->rate.soft * l->wt;
    l->calm += 2 * l->wn * t->hold[HOLD_PULL];
    l->most = small_most(l, &s->rate, t->kept);
    memcpy(l->f, t->f, sizeof l->f), memcpy(l->q, t->q, sizeof l->q);
}

double small_wall_speed(const struct packing *p)
{
    double most = 0;
    for (int32_t w = 0; w < p->walls; w++)
        most = fmax(most, wall_top_speed(p, &p->wall[w]) + v3_norm(p->wall[w].belt));
    return most;
}
