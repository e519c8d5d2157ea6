#include "measure/step_motion.h"

#include "measure/branch.h"
#include "measure/boundaries.h"

#include <stdlib.h>

/* m: the lever arms that the step has used [bodies/kinematics.h] */
static double arm_b(const struct packing *p, const struct contact *c)
{
    return c->a < 0 && p->overlap > OVERLAP_KEEP ? p->radius[c->b] : branch_b(p, c);
}

/* The velocity of a body changes in the step by d; half of it leads from the frame to the mean. */
static void add_impulse(struct step_motion *m, const struct packing *p, int64_t body, double sign,
                        double arm, vec3 f, vec3 moment)
{
    if (!(p->mass[body] > 0)) return;
    m->v[body] = v3_axpy(m->v[body], sign / p->mass[body], f);
    m->w[body] = v3_axpy(m->w[body], arm / p->inertia[body], moment);
}

int step_motion_init(struct step_motion *m, const struct snapshot *s)
{
    const struct packing *p = s->p;
    const double half = s->moved ? -0.5 : 0.5;
    m->v = calloc((size_t)p->n + 1, sizeof *m->v), m->w = calloc((size_t)p->n + 1, sizeof *m->w);
    if (!m->v || !m->w) return -1;
    for (int64_t i = 0; i < s->s->n; i++) {
        const struct contact *c = &s->s->c[i];
        const double *r = s->s->found[i].r;
        vec3 f = contact_in_space(c, r);
        vec3 moment = v3_axpy(v3_scale(r[2], c->t1), -r[1], contact_t2(c)); // -n x r
        add_impulse(m, p, c->b, 1, arm_b(p, c), f, moment);
        if (c->a >= 0) add_impulse(m, p, c->a, -1, branch_a(p, c), f, moment);
    }
    for (int64_t i = 0; i < p->n; i++) {
        vec3 change = p->mass[i] > 0 ? v3_axpy(m->v[i], p->dt, p->g) : v3(0, 0, 0);
        m->v[i] = v3_axpy(p->v[i], half, change), m->w[i] = v3_axpy(p->w[i], half, m->w[i]);
    }
    return 0;
}

void step_motion_free(struct step_motion *m)
{
    free(m->v), free(m->w);
}

void step_motion_at(const struct step_motion *m, const struct snapshot *s, int64_t i, double u[3])
{
    const struct packing *p = s->p;
    const struct contact *c = &s->s->c[i];
    vec3 n = c->n, t2 = contact_t2(c);
    vec3 at_b = v3_axpy(m->v[c->b], -arm_b(p, c), v3_cross(m->w[c->b], n));
    vec3 at_a = c->a < 0 ? boundary_velocity(p, c->a, c->x)
                         : v3_axpy(m->v[c->a], branch_a(p, c), v3_cross(m->w[c->a], n));
    vec3 v = v3_add(v3_sub(at_b, at_a), cell_shift(p->cell.rate, c->shift));
    u[0] = v3_dot(v, n), u[1] = v3_dot(v, c->t1), u[2] = v3_dot(v, t2);
}
