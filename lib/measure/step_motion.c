#include "measure/step_motion.h"

#include "measure/branch.h"
#include "motion/move.h"

int step_motion_init(struct step_motion *m, const struct snapshot *s, struct why *why)
{
    *m = (struct step_motion){ .p = s->p };
    if (packing_copy(&m->other, s->p, why)) return why->status;
    return s->moved ? move_back(&m->other, s->s, why) : move_step(&m->other, s->s, NULL, why);
}

void step_motion_free(struct step_motion *m)
{
    packing_free(&m->other);
}

/* m: the lever arm that the step has used [bodies/kinematics.h] */
static double arm_b(const struct packing *p, const struct contact *c)
{
    return c->a < 0 && p->overlap > OVERLAP_KEEP ? p->radius[c->b] : branch_b(p, c);
}

/* m/s: of the boundary where p is; what is prescribed is the step's mean, said where the step begins. */
static vec3 boundary(const struct step_motion *m, const struct packing *p, const struct contact *c)
{
    int32_t w = -1 - c->a;
    const struct packing *start = m->p->step < m->other.step ? m->p : &m->other;
    vec3 load = v3_sub(wall_velocity(p, &p->wall[w], c->x), wall_held(p, &p->wall[w], c->x));
    vec3 held =
        v3_add(wall_held(start, &start->wall[w], c->x), wall_belt(start, &start->wall[w], c->n));
    return v3_add(held, load);
}

/* m/s: of b relative to a, at the contact, in space */
static vec3 relative(const struct step_motion *m, const struct packing *p, const struct contact *c)
{
    if (contact_shaped(p, c)) {
        bool before = p->step < (p == m->p ? m->other.step : m->p->step);
        double ahead = before ? step_ahead(p) : -step_after(p); // to where the contact acts
        vec3 edge[3];
        cell_predict(&p->cell, ahead, edge);
        struct arms arm = arm_vectors(p, c, ahead, edge);
        vec3 of_b = v3_add(p->v[c->b], v3_cross(p->w[c->b], arm.b));
        vec3 of_a = c->a < 0 ? boundary(m, p, c) : v3_add(p->v[c->a], v3_cross(p->w[c->a], arm.a));
        return v3_add(v3_sub(of_b, of_a), cell_shift(p->cell.rate, c->shift));
    }
    vec3 b = v3_axpy(p->v[c->b], -arm_b(p, c), v3_cross(p->w[c->b], c->n));
    vec3 a = c->a < 0 ? boundary(m, p, c)
                      : v3_axpy(p->v[c->a], branch_a(p, c), v3_cross(p->w[c->a], c->n));
    return v3_add(v3_sub(b, a), cell_shift(p->cell.rate, c->shift));
}

void step_motion_at(const struct step_motion *m, const struct contact *c, double u[3])
{
    vec3 v = v3_scale(0.5, v3_add(relative(m, m->p, c), relative(m, &m->other, c)));
    u[0] = v3_dot(v, c->n), u[1] = v3_dot(v, c->t1), u[2] = v3_dot(v, contact_t2(c));
}

vec3 step_motion_boundary(const struct step_motion *m, const struct contact *c)
{
    return v3_scale(0.5, v3_add(boundary(m, m->p, c), boundary(m, &m->other, c)));
}
