/* move.c: see bodies/move.h. */
#include "bodies/move.h"

#include "bodies/kinematics.h"
#include "bodies/project.h"

#include <stdlib.h>

/* The reactions' impulses and their moments about the centres, which are at x + ahead v when the
   contacts act; summed in the contacts' order. */
static void impulses(const struct packing *p, double ahead, const struct contacts *s, vec3 *force,
                     vec3 *moment)
{
    for (int64_t i = 0; i < s->n; i++) {
        const struct contact *c = &s->c[i];
        double la, lb;
        arms_of(p, c, ahead, &la, &lb);
        const double *r = s->found[i].r;
        vec3 t2 = contact_t2(c), f = v3_axpy(v3_axpy(v3_scale(r[0], c->n), r[1], c->t1), r[2], t2);
        vec3 m = v3_axpy(v3_scale(r[2], c->t1), -r[1], t2); // -n x r
        force[c->b] = v3_add(force[c->b], f);
        moment[c->b] = v3_axpy(moment[c->b], lb, m);
        if (c->a < 0) continue;
        force[c->a] = v3_sub(force[c->a], f);
        moment[c->a] = v3_axpy(moment[c->a], la, m);
    }
}

static quat turn(quat q, double dt, vec3 w)
{
    return quat_mul(quat_rotation(v3_scale(dt, w)), q);
}

/* Body i through the second half of the step, with its impulse and moment. */
static void body_move(struct packing *p, int64_t i, vec3 force, vec3 moment)
{
    double before = (1 - p->theta) * p->dt, after = p->theta * p->dt;
    p->x[i] = packing_predict(p, i);
    p->q[i] = turn(p->q[i], before, p->w[i]);
    if (p->mass[i] > 0) {
        p->v[i] = v3_axpy(v3_axpy(p->v[i], p->dt, p->g), 1 / p->mass[i], force);
        p->w[i] = v3_axpy(p->w[i], 1 / p->inertia[i], moment);
    }
    p->x[i] = v3_axpy(p->x[i], after, p->v[i]);
    p->q[i] = quat_unit(turn(p->q[i], after, p->w[i]));
}

/* The inverse. */
static void body_unmove(struct packing *p, int64_t i, vec3 force, vec3 moment)
{
    double before = (1 - p->theta) * p->dt, after = p->theta * p->dt;
    p->x[i] = v3_axpy(p->x[i], -after, p->v[i]);
    p->q[i] = turn(p->q[i], -after, p->w[i]);
    if (p->mass[i] > 0) {
        p->v[i] = v3_axpy(v3_axpy(p->v[i], -p->dt, p->g), -1 / p->mass[i], force);
        p->w[i] = v3_axpy(p->w[i], -1 / p->inertia[i], moment);
    }
    p->x[i] = v3_axpy(p->x[i], -before, p->v[i]);
    p->q[i] = quat_unit(turn(p->q[i], -before, p->w[i]));
}

/* body() on each, with its impulse and moment; the contacts act where the bodies are `ahead` (s)
   from here. */
static int move(struct packing *p, double ahead, const struct contacts *s,
                void (*body)(struct packing *, int64_t, vec3, vec3), struct why *why)
{
    size_t n = (size_t)p->n + 1;
    vec3 *force = calloc(n, sizeof *force), *moment = calloc(n, sizeof *moment);
    bool room = force && moment;
    if (room) impulses(p, ahead, s, force, moment);
    for (int64_t i = 0; room && i < p->n; i++) body(p, i, force[i], moment[i]);
    free(force), free(moment);
    return room ? 0 : why_set(why, EX_SOFTWARE, "no memory to move the bodies");
}

int move_step(struct packing *p, const struct contacts *s, struct why *why)
{
    if (move(p, (1 - p->theta) * p->dt, s, body_move, why) ||
        (overlap_projects(p->overlap) && project_apart(p, s, why)))
        return why->status;
    p->step++;
    p->t += p->dt;
    return 0;
}

int move_back(struct packing *p, const struct contacts *s, struct why *why)
{
    if (move(p, -p->theta * p->dt, s, body_unmove, why)) return why->status;
    p->step--;
    p->t -= p->dt;
    return 0;
}
