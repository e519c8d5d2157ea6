/* move.c: see bodies/move.h. */
#include "bodies/move.h"

#include "base/team.h"
#include "bodies/project.h"
#include "bodies/tie.h"
#include "bodies/top.h"

#include <stdlib.h>

enum {
    SOME = 1024 /* bodies that are worth a thread: 100 us of work */
};

static quat turn(quat q, double dt, vec3 w)
{
    return quat_mul(quat_rotation(v3_scale(dt, w)), q);
}

/* A body that keeps its angular momentum, not its angular velocity [bodies/top.h]; back: the inverse. */
static void top_move(struct packing *p, int64_t i, vec3 moment, bool back)
{
    double first = (1 - p->theta) * p->dt, then = p->theta * p->dt;
    vec3 L = top_momentum(p, i, p->q[i], p->w[i]);
    p->q[i] = top_turn(p, i, p->q[i], L, back ? -then : first);
    L = v3_axpy(L, back ? -1 : 1, moment);
    p->q[i] = top_turn(p, i, p->q[i], L, back ? -first : then);
    p->w[i] = top_spin(p, i, p->q[i], L);
}

/* Body i through the second half of the step, with its impulse and moment. */
static void body_move(struct packing *p, const struct cell_flow *flow, int64_t i, vec3 force,
                      vec3 moment)
{
    double before = (1 - p->theta) * p->dt, after = p->theta * p->dt;
    bool top = top_is(p, i);
    if (top) top_move(p, i, moment, false);
    p->x[i] = packing_predict(p, i);
    if (!top) p->q[i] = turn(p->q[i], before, p->w[i]);
    if (p->mass[i] > 0) {
        p->v[i] = v3_axpy(v3_axpy(p->v[i], p->dt, p->g), 1 / p->mass[i], force);
        if (flow->changes) p->v[i] = v3_add(p->v[i], cell_flow_gain(flow, p->x[i]));
        if (!top) p->w[i] = v3_axpy(p->w[i], 1 / p->inertia[i], moment);
    }
    p->x[i] = v3_axpy(p->x[i], after, p->v[i]);
    if (!top) p->q[i] = quat_unit(turn(p->q[i], after, p->w[i]));
}

/* The inverse. */
static void body_unmove(struct packing *p, const struct cell_flow *flow, int64_t i, vec3 force,
                        vec3 moment)
{
    double before = (1 - p->theta) * p->dt, after = p->theta * p->dt;
    bool top = top_is(p, i);
    if (top) top_move(p, i, moment, true);
    p->x[i] = v3_axpy(p->x[i], -after, p->v[i]);
    if (!top) p->q[i] = turn(p->q[i], -after, p->w[i]);
    if (p->mass[i] > 0) {
        p->v[i] = v3_axpy(v3_axpy(p->v[i], -p->dt, p->g), -1 / p->mass[i], force);
        if (flow->changes) p->v[i] = v3_sub(p->v[i], cell_flow_gain(flow, p->x[i]));
        if (!top) p->w[i] = v3_axpy(p->w[i], -1 / p->inertia[i], moment);
    }
    p->x[i] = v3_axpy(p->x[i], -before, p->v[i]);
    if (!top) p->q[i] = quat_unit(turn(p->q[i], -before, p->w[i]));
}

static void move_freedoms(struct packing *p, const struct impulses *sum, bool back)
{
    for (int32_t k = 0; k < sum->freedoms.n; k++)
        freedom_move(&sum->freedoms.f[k], p, impulses_change(sum, p, k), back);
}

/* Bodies that move */
struct moving {
    struct packing *p;
    const struct impulses *sum;
};

static void move_some(void *arg, int64_t first, int64_t end)
{
    const struct moving *m = arg;
    for (int64_t i = first; i < end; i++)
        body_move(m->p, &m->sum->flow, i, m->sum->force[i], m->sum->moment[i]);
}

int move_by(struct packing *p, const struct contacts *s, const struct impulses *sum,
            struct why *why)
{
    if (packing_check_clock(p, why) || (p->law && ties_keep(p, s, why)) ||
        memory_keep(&p->memory, s, why))
        return why->status;
    struct moving m = { p, sum };
    team_share(team_size(), p->n, SOME, move_some, &m);
    cell_move(&p->cell, p->dt, p->theta, sum->next);
    move_freedoms(p, sum, false);
    p->step++;
    p->t = packing_time(p, p->step);
    return overlap_projects(p->overlap) ? project_apart(p, s, why) : 0;
}

int move_step(struct packing *p, const struct contacts *s, struct why *why)
{
    struct impulses sum;
    if (!impulses_init(&sum, p, s, false, why)) move_by(p, s, &sum, why);
    impulses_free(&sum);
    return why->status;
}

static void unmove_by(struct packing *p, struct impulses *sum)
{
    vec3 gain[3];
    for (int k = 0; k < 3; k++) gain[k] = p->cell.rate[k];
    move_freedoms(p, sum, true);
    cell_unmove(&p->cell, p->t - p->dt, p->dt, p->theta);
    for (int k = 0; k < 3; k++) gain[k] = v3_sub(gain[k], p->cell.rate[k]);
    cell_flow_init(&sum->flow, &p->cell, sum->edge, gain);
    for (int64_t i = 0; i < p->n; i++) body_unmove(p, &sum->flow, i, sum->force[i], sum->moment[i]);
    p->step--;
    p->t = packing_time(p, p->step);
}

int move_back(struct packing *p, const struct contacts *s, struct why *why)
{
    struct impulses sum;
    if (!impulses_init(&sum, p, s, true, why)) unmove_by(p, &sum);
    impulses_free(&sum);
    return why->status;
}
