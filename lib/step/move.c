/* move.c: see step/move.h. */
#include "step/move.h"

#include "base/team.h"
#include "contact/contact_law.h"
#include "state/rotation.h"
#include "state/servo_box.h"
#include "step/project.h"

#include <math.h>
#include <stdlib.h>

enum {
    BODIES_PER_THREAD = 1024 /* the fewest bodies that are worth a thread: 100 us of work */
};

static quat move_turn(quat q, double dt, vec3 w)
{
    return quat_mul(quat_rotation(v3_scale(dt, w)), q);
}

/* The parts of a step in the order in which bodies take them: forward, or back to before it */
struct move_way {
    double first, then; /* s */
    double sign;        /* of what gravity and reactions add to velocities */
};

static struct move_way move_way_of(const struct packing *p, bool back)
{
    if (back) return (struct move_way){ -step_after(p), -step_ahead(p), -1 };
    return (struct move_way){ step_ahead(p), step_after(p), 1 };
}

/* A body that keeps its angular momentum, not its angular velocity [state/rotation.h] */
static void rotation_move(struct packing *p, const struct move_way *y, int64_t i, vec3 moment)
{
    vec3 L = rotation_momentum(p, i, p->q[i], p->w[i]);
    p->q[i] = rotation_turn(p, i, p->q[i], L, y->first);
    L = v3_axpy(L, y->sign, moment);
    p->q[i] = rotation_turn(p, i, p->q[i], L, y->then);
    p->w[i] = rotation_spin(p, i, p->q[i], L);
}

/* m/s: of body i after the step */
static vec3 velocity_after(const struct packing *p, const struct cell_flow *flow, double sign,
                           int64_t i, vec3 x, vec3 force)
{
    vec3 v = v3_axpy(v3_axpy(p->v[i], sign * p->dt, p->g), sign / p->mass[i], force);
    return flow->changes ? v3_axpy(v, sign, cell_flow_gain(flow, x)) : v;
}

/* Body i through the step, with its impulse and moment, which act between its parts. */
static void body_move(struct packing *p, const struct cell_flow *flow, const struct move_way *y,
                      int64_t i, vec3 force, vec3 moment)
{
    bool top = rotation_is(p, i);
    if (top) rotation_move(p, y, i, moment);
    p->x[i] = v3_axpy(p->x[i], y->first, p->v[i]);
    if (!top) p->q[i] = move_turn(p->q[i], y->first, p->w[i]);
    if (p->mass[i] > 0) {
        p->v[i] = velocity_after(p, flow, y->sign, i, p->x[i], force);
        if (!top) p->w[i] = v3_axpy(p->w[i], y->sign / p->inertia[i], moment);
    }
    p->x[i] = v3_axpy(p->x[i], y->then, p->v[i]);
    if (!top) p->q[i] = quat_unit(move_turn(p->q[i], y->then, p->w[i]));
}

static void move_freedoms(struct packing *p, const struct impulses *sum, bool back)
{
    for (int32_t k = 0; k < sum->freedoms.n; k++)
        freedom_move(&sum->freedoms.f[k], p, impulses_change(sum, p, k), back);
    freedoms_move_rates(&sum->freedoms, p, back);
}

/* Bodies that move */
struct move_moving {
    struct packing *p;
    const struct impulses *sum;
    struct move_way way;
};

static void move_some(void *arg, int64_t first, int64_t end)
{
    const struct move_moving *m = arg;
    for (int64_t i = first; i < end; i++)
        body_move(m->p, &m->sum->flow, &m->way, i, m->sum->force[i], m->sum->moment[i]);
}

static void move_bodies(struct packing *p, const struct impulses *sum, bool back)
{
    struct move_moving m = { p, sum, move_way_of(p, back) };
    team_share(team_size(), p->n, BODIES_PER_THREAD, move_some, &m);
}

/* ---- what would not be finite ---- */

static enum endless_what body_after(const struct packing *p, const struct impulses *sum, int64_t i)
{
    vec3 x = v3_axpy(p->x[i], step_ahead(p), p->v[i]), v = p->v[i], w = p->w[i];
    const bool moves = p->mass[i] > 0;
    if (moves) v = velocity_after(p, &sum->flow, 1, i, x, sum->force[i]);
    if (moves) w = v3_axpy(w, 1 / p->inertia[i], sum->moment[i]);
    x = v3_axpy(x, step_after(p), v);
    if (!v3_finite(v)) return ENDLESS_VELOCITY;
    if (!v3_finite(w) || !isfinite(v3_dot(w, w))) return ENDLESS_SPIN;
    if (!v3_finite(x)) return ENDLESS_POSITION;
    double energy = p->mass[i] * (v3_dot(v, v) - v3_dot(p->g, x)) + p->inertia[i] * v3_dot(w, w);
    return moves && !isfinite(energy) ? ENDLESS_ENERGY : ENDLESS_NOTHING;
}

static bool walls_last(const struct packing *p, int32_t w)
{
    const double t = packing_next_time(p);
    const vec3 x = wall_at(p, &p->wall[w], t);
    return v3_finite(x) && v3_finite(wall_velocity(p, &p->wall[w], x));
}

struct endless endless_after(const struct packing *p, const struct impulses *sum)
{
    for (int64_t i = 0; i < p->n; i++) {
        enum endless_what what = body_after(p, sum, i);
        if (what) return (struct endless){ what, p->id[i] };
    }
    for (int32_t w = 0; w < p->walls; w++)
        if (!walls_last(p, w)) return (struct endless){ ENDLESS_WALL, -1 - w };
    for (int32_t k = 0; k < sum->freedoms.n; k++) {
        const struct freedom *f = &sum->freedoms.f[k];
        const double speed = f->speed + impulses_change(sum, p, k);
        if (!isfinite(speed) || !isfinite(speed * p->dt))
            return f->wall >= 0 ? (struct endless){ ENDLESS_WALL, -1 - f->wall }
                                : (struct endless){ ENDLESS_CELL, 0 };
    }
    for (int k = 0; k < 3 && cell_repeats(&p->cell); k++)
        if (!v3_finite(v3_axpy(p->cell.edge[k], p->dt, sum->next[k])))
            return (struct endless){ ENDLESS_CELL, 0 };
    return (struct endless){ 0 };
}

int move_by(struct packing *p, const struct contacts *s, const struct impulses *sum,
            struct failure *failure)
{
    if (packing_check_clock(p, failure) || (p->law && contact_laws_keep(p, s, failure)) ||
        memory_keep(&p->memory, s, failure))
        return failure->status;
    move_bodies(p, sum, false);
    cell_move(&p->cell, step_ahead(p), step_after(p), sum->next);
    move_freedoms(p, sum, false);
    p->step++;
    p->t = packing_time(p, p->step);
    return servo_box_check_growth(p, failure);
}

int move_step(struct packing *p, const struct contacts *s, struct projected *did,
              struct failure *failure)
{
    struct impulses sum;
    if (!impulses_init(&sum, p, s, false, failure) && !move_by(p, s, &sum, failure) &&
        overlap_projects(p->overlap))
        project_apart(p, s, did, failure);
    impulses_free(&sum);
    return failure->status;
}

static void unmove_by(struct packing *p, struct impulses *sum)
{
    vec3 gain[3];
    for (int k = 0; k < 3; k++) gain[k] = p->cell.rate[k];
    move_freedoms(p, sum, true);
    cell_unmove(&p->cell, p->t - p->dt, step_ahead(p), step_after(p));
    for (int k = 0; k < 3; k++) gain[k] = v3_sub(gain[k], p->cell.rate[k]);
    cell_flow_init(&sum->flow, &p->cell, sum->edge, gain);
    move_bodies(p, sum, true);
    p->step--;
    p->t = packing_time(p, p->step);
}

int move_back(struct packing *p, const struct contacts *s, struct failure *failure)
{
    struct impulses sum;
    if (!impulses_init(&sum, p, s, true, failure)) unmove_by(p, &sum);
    impulses_free(&sum);
    return failure->status;
}
