/* step/contact_motion.c: velocities at contacts, over a step [step/contact_motion.h]. */
#include "step/contact_motion.h"

#include "state/rotation.h"

struct velocity {
    vec3 v, w; /* m/s, rad/s */
};

/* The mean of body i over the step, as the balances have it [step/balance.c] */
static struct velocity of_body(const struct packing *p, const struct impulses *sum, int32_t i)
{
    if (!(p->mass[i] > 0)) return (struct velocity){ p->v[i], p->w[i] };
    vec3 dv = v3_axpy(v3_scale(p->dt, p->g), 1 / p->mass[i], sum->force[i]);
    if (sum->flow.changes) dv = v3_add(dv, cell_flow_gain(&sum->flow, packing_predict(p, i)));
    quat q = rotation_is(p, i) ? rotation_predict(p, i) : p->q[i];
    return (struct velocity){ v3_axpy(p->v[i], 0.5, dv),
                              v3_axpy(rotation_predict_spin(p, i, q), 0.5,
                                      rotation_spin(p, i, q, sum->moment[i])) };
}

/* m/s: of the wall's material, with what its load makes of it */
static vec3 of_wall(const struct packing *p, const struct impulses *sum, const struct contact *c)
{
    const struct wall *w = &p->wall[-1 - c->a];
    vec3 v = v3_add(wall_held(p, w, c->x), wall_belt(p, w, c->n));
    for (int32_t k = 0; k < sum->freedoms.n; k++) {
        const struct freedom *f = &sum->freedoms.f[k];
        if (f->wall != -1 - c->a && !f->lever) continue;
        double speed = f->speed + 0.5 * impulses_change(sum, p, k);
        v = v3_axpy(v, -speed, freedom_direction(f, p, c, sum->ahead, sum->edge));
    }
    return v;
}

/* m/s: what the edges of the cell add to the velocity of b */
static vec3 of_image(const struct packing *p, const struct impulses *sum, const struct contact *c)
{
    vec3 v = cell_shift(p->cell.rate, c->shift);
    if (!sum->flow.changes) return v;
    return v3_axpy(v, 0.5, cell_shift(sum->flow.gain, c->shift));
}

struct contact_motion contact_motion(const struct packing *p, const struct impulses *sum,
                                     const struct contact *c)
{
    struct contact_motion m = { 0 };
    const struct arms arm = arm_vectors(p, c, sum->ahead, sum->edge);
    struct velocity a, b = of_body(p, sum, c->b);
    vec3 at_b = v3_add(v3_add(b.v, v3_cross(b.w, arm.b)), of_image(p, sum, c)), at_a;
    if (c->a < 0) {
        m.wall = at_a = of_wall(p, sum, c);
        m.wall_spin = a.w = wall_spin(p, &p->wall[-1 - c->a]);
    } else {
        a = of_body(p, sum, c->a);
        at_a = v3_add(a.v, v3_cross(a.w, arm.a));
    }
    m.u = v3_sub(at_b, at_a), m.w = v3_sub(b.w, a.w);
    return m;
}

struct contact_loss contact_loss(const struct contact_motion *m, const struct contact *c,
                                 const double r[3], const double *moment)
{
    struct contact_loss l = { .impact = -r[0] * v3_dot(m->u, c->n) };
    l.friction = -(r[1] * v3_dot(m->u, c->t1) + r[2] * v3_dot(m->u, contact_t2(c)));
    if (moment) l.friction -= v3_dot(contact_in_space(c, moment), m->w);
    return l;
}

double contact_wall_work(const struct contact_motion *m, const struct contact *c, const double r[3],
                         const double *moment)
{
    double work = -v3_dot(contact_in_space(c, r), m->wall);
    return moment ? work - v3_dot(contact_in_space(c, moment), m->wall_spin) : work;
}
