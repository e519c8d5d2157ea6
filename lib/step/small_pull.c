/* step/small_pull.c: forces on bodies in small steps [step/small_pull.h]. */
#include "step/small_pull.h"

#include "state/rotation.h"
#include "step/small_cell.h"
#include "step/small_part.h"
#include "step/small_stress.h"

#include <math.h>
#include <stdlib.h>

static bool small_pull_acts(const struct packing *p)
{
    return p->outside.force || p->outside.torque || p->pulls.n;
}

int small_pull_init(struct small_run *r, struct failure *failure)
{
    if (!small_pull_acts(r->p) && !r->cell.moves) return 0;
    r->pull = calloc((size_t)r->p->n + 1, sizeof *r->pull);
    return r->pull ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for forces on bodies");
}

/* N; N m where `turns`: on body i at time t (s) */
static vec3 small_pull_on(const struct packing *p, int64_t i, double t, bool turns)
{
    const vec3 *outside = turns ? p->outside.torque : p->outside.force;
    vec3 f = outside ? outside[i] : v3(0, 0, 0);
    return p->pulls.n ? v3_add(f, packing_pull(p, i, t, turns)) : f;
}

/* Half of what the forces, and the flow of the cell, of its step do to body i, which moves as it does now */
static void add_half_work(const struct small_run *r, int64_t i, struct small_pull *to)
{
    const struct packing *p = r->p;
    const struct small_pull *y = &r->pull[i];
    const struct body *b = &r->l->s.body[i];
    if (!(b->im > 0)) return;
    const vec3 v = small_vec(b->v), w = small_vec(b->w), gain = small_vec(y->gain);
    const vec3 pushed = v3_sub(v3_axpy(small_vec(y->dv), -r->h, p->g), gain);
    const vec3 dw = small_vec(y->dw);
    const double turns = r->meets && rotation_is(p, i)
                             ? v3_dot(rotation_momentum(p, i, r->shapes.q[i], dw), w)
                             : p->inertia[i] * v3_dot(dw, w);
    to->work += 0.5 * (p->mass[i] * v3_dot(pushed, v) + turns);
    to->carried += 0.5 * p->mass[i] * v3_dot(gain, v);
}

/* The forces of the step that begins, in place of those of the last one */
static void next_forces(struct small_run *r, int64_t i)
{
    const struct packing *p = r->p;
    const struct body *b = &r->l->s.body[i];
    struct small_pull *y = &r->pull[i];
    const double t = p->t + r->h / 2;
    if (!(b->im > 0)) return;
    if (!r->begins) add_half_work(r, i, y);
    vec3 gain = v3(0, 0, 0);
    if (r->cell.flow.changes) gain = cell_flow_gain(&r->cell.flow, small_vec(r->l->s.place[i].x));
    const vec3 dv = v3_axpy(v3_scale(r->h, p->g), r->h * b->im, small_pull_on(p, i, t, false));
    const vec3 torque = small_pull_on(p, i, t, true);
    small_array(y->dv, v3_add(dv, gain)), small_array(y->gain, gain);
    small_array(y->dw, r->meets && rotation_is(p, i)
                           ? rotation_spin(p, i, r->shapes.q[i], v3_scale(r->h, torque))
                           : v3_scale(r->h * b->ii, torque));
    for (int k = 0; k < 3; k++) y->impulse[k] += p->mass[i] * y->gain[k];
    add_half_work(r, i, y);
}

double small_pull_bodies(struct small_run *r, double warm, int64_t first, int64_t end)
{
    double most = 0;
    for (int64_t k = first; k < end; k++) {
        const int64_t i = small_body_here(r, k);
        struct body *b = &r->l->s.body[i], *was = &r->l->s.before[i];
        const struct small_pull had = r->pull[i], *y = &r->pull[i];
        const vec3 v = small_vec(b->v), w = small_vec(b->w);
        next_forces(r, i);
        for (int j = 0; j < 3; j++) {
            b->v[j] += y->dv[j] + warm * (b->v[j] - was->v[j] - had.dv[j]);
            b->w[j] += y->dw[j] + warm * (b->w[j] - was->w[j] - had.dw[j]);
        }
        small_array(was->v, v), small_array(was->w, w);
        const vec3 moves = small_cell_peculiar(r, small_vec(r->l->s.place[i].x), v);
        const double turns = packing_shape(r->p, i) ? r->p->radius[i] * v3_norm(w) : 0;
        const double v2 = turns > 0 ? pow(v3_norm(moves) + turns, 2) : v3_dot(moves, moves);
        most = v2 <= most ? most : v2; // not a number: it is the largest
    }
    return most;
}

struct small_pull small_pull_sum(const struct small_run *r)
{
    struct small_pull sum = { 0 };
    for (int64_t i = 0; r->pull && i < r->p->n; i++) {
        sum.work += r->pull[i].work, sum.carried += r->pull[i].carried;
        for (int k = 0; k < 3; k++) sum.impulse[k] += r->pull[i].impulse[k];
        add_half_work(r, i, &sum);
    }
    return sum;
}

/* N: of loads that walls and the edges of a cell put on the bodies between them */
static double load_forces(const struct packing *p)
{
    double force = small_stress_forces(p);
    for (int32_t w = 0; w < p->walls; w++)
        if (p->wall[w].load.way && p->wall[w].load.way != LOAD_TURNS)
            force += fabs(wall_force(p, &p->wall[w], p->t + p->dt / 2));
    return force;
}

double small_pull_load(const struct packing *p)
{
    double mass = 0;
    if (!freedoms_in(p)) return 0;
    for (int64_t i = 0; i < p->n; i++) mass += p->mass[i];
    return mass > 0 ? load_forces(p) / mass : 0;
}

double small_pull_presses(const struct packing *p)
{
    double mass = 0, force = load_forces(p), wide = 0, lo[3], hi[3];
    if (!small_pull_acts(p) && !freedoms_in(p)) return 0;
    for (int k = 0; k < 3; k++) lo[k] = INFINITY, hi[k] = -INFINITY;
    for (int64_t i = 0; i < p->n; i++) {
        const double x[3] = { p->x[i].x, p->x[i].y, p->x[i].z };
        if (!(p->mass[i] > 0)) continue;
        mass += p->mass[i];
        force += v3_norm(small_pull_on(p, i, p->t + p->dt / 2, false));
        for (int k = 0; k < 3; k++) lo[k] = dmin(lo[k], x[k]), hi[k] = dmax(hi[k], x[k]);
    }
    for (int k = 0; k < 3; k++) wide = fmax(wide, hi[k] - lo[k]);
    if (!(mass > 0)) return 0;
    return p->outside.most + p->pulls_most +
           force / mass * (1 + wide / (2 * packing_whole(p).large));
}
