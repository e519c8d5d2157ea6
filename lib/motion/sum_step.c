#include "motion/sum_step.h"

#include "bodies/face_of.h"
#include "bodies/top.h"

#include <stdlib.h>

/* m/s, rad/s: the mean velocities of body i over the step, as the balances have them [motion/balance.c] */
static void mean_of(const struct packing *p, const struct impulses *sum, int64_t i, vec3 *v,
                    vec3 *w)
{
    *v = p->v[i], *w = p->w[i];
    if (!(p->mass[i] > 0)) return;
    vec3 dv = v3_axpy(v3_scale(p->dt, p->g), 1 / p->mass[i], sum->force[i]);
    if (sum->flow.changes) dv = v3_add(dv, cell_flow_gain(&sum->flow, packing_predict(p, i)));
    quat q = top_is(p, i) ? top_predict(p, i) : p->q[i];
    *v = v3_axpy(*v, 0.5, dv);
    *w = v3_axpy(top_predict_spin(p, i, q), 0.5, top_spin(p, i, q, sum->moment[i]));
}

/* m/s: of the boundary's material at a contact, the mean over the step, with what its load makes of it */
static vec3 wall_mean(const struct packing *p, const struct impulses *sum, const struct contact *c)
{
    vec3 v = wall_held(p, &p->wall[-1 - c->a], c->x);
    for (int32_t k = 0; k < sum->freedoms.n; k++) {
        const struct freedom *f = &sum->freedoms.f[k];
        if (f->boundary != -1 - c->a && !f->lever) continue;
        double speed = f->speed + 0.5 * impulses_change(sum, p, k);
        v = v3_axpy(v, -speed, freedom_direction(f, p, c, sum->ahead, sum->edge));
    }
    return v;
}

static void add(struct face_sums *to, const struct packing *p, const struct contacts *s, int64_t i,
                const struct impulses *sum)
{
    const struct contact *c = &s->c[i];
    const double *r = s->found[i].r;
    const struct push o = push_of(p, sum->ahead, sum->edge, c, r);
    vec3 v, w, wall = wall_mean(p, sum, c);
    mean_of(p, sum, c->b, &v, &w);
    struct arms arm = { 0 };
    if (o.shaped) arm = arm_vectors(p, c, sum->ahead, sum->edge);
    vec3 at_b = v3_add(v, v3_cross(w, o.shaped ? arm.b : v3_scale(-o.lb, c->n)));
    vec3 u = v3_sub(v3_add(at_b, cell_shift(p->cell.rate, c->shift)), wall);
    double ut[2] = { v3_dot(u, c->t1), v3_dot(u, contact_t2(c)) };
    to->impulse = v3_sub(to->impulse, o.f);
    to->moment = v3_sub(to->moment, v3_cross(c->x, o.f));
    if (s->moment) to->moment = v3_sub(to->moment, contact_in_space(c, s->moment[i]));
    to->normal += r[0], to->tangential += hypot(r[1], r[2]);
    to->work -= v3_dot(o.f, wall);
    to->friction -= r[1] * ut[0] + r[2] * ut[1];
    if (r[0] > 0) to->rub += r[0] * hypot(ut[0], ut[1]);
}

int sum_step(struct packing *p, const struct contacts *s, const struct impulses *sum,
             struct why *why)
{
    if (!p->sums.n) return 0;
    if (!p->sums.faces) {
        if (!(p->sums.faces = calloc(1, sizeof *p->sums.faces)))
            return why_set(why, EX_SOFTWARE, "no memory for the sums");
        if (face_of_init(p->sums.faces, p, true, why)) return why->status;
    }
    const struct wall_faces *f = p->sums.faces;
    for (int64_t i = 0; i < s->n && s->c[i].a < 0; i++) { // boundaries come first
        const double *r = s->found[i].r;
        if (r[0] == 0 && r[1] == 0 && r[2] == 0) continue;
        int32_t face = face_of_contact(f, p, &s->c[i], sum->ahead);
        add(&p->sums.face[f->first[-1 - s->c[i].a] + face], p, s, i, sum);
    }
    return 0;
}
