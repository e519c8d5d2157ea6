/* measure/stress.c: the stress of Love and Weber, with the part of the bodies' motion. */
#include "measure/stress.h"

#include "measure/branch.h"
#include "measure/measures.h"

#include <math.h>

/* m/s: beside the flow that a cell's moving edges make */
static vec3 stress_beside(const struct packing *p, const struct period *period, int64_t i)
{
    return period->any ? v3_sub(p->v[i], period_flow(period, p->x[i])) : p->v[i];
}

void moving_of(struct moving *m, const struct snapshot *s, const struct region *r)
{
    const struct packing *p = s->p;
    double inertia = 0;
    *m = (struct moving){ 0 };
    for (int64_t i = 0; i < p->n; i++) {
        int times = p->mass[i] > 0 && snapshot_body(s, i) ? region_holds(r, p->x[i]) : 0;
        if (!times) continue;
        m->bodies += times, m->mass += times * p->mass[i], inertia += times * p->inertia[i];
        m->velocity = v3_axpy(m->velocity, times * p->mass[i], stress_beside(p, &r->period, i));
        m->spin = v3_axpy(m->spin, times * p->inertia[i], p->w[i]);
    }
    if (m->mass > 0) m->velocity = v3_scale(1 / m->mass, m->velocity);
    if (inertia > 0) m->spin = v3_scale(1 / inertia, m->spin);
    for (int64_t i = 0; i < p->n; i++) {
        int times = p->mass[i] > 0 && snapshot_body(s, i) ? region_holds(r, p->x[i]) : 0;
        if (!times) continue;
        vec3 v = v3_sub(stress_beside(p, &r->period, i), m->velocity), w = v3_sub(p->w[i], m->spin);
        tensor_add(&m->kinetic, times * p->mass[i], v, v);
        m->rotation += times * p->inertia[i] * v3_dot(w, w);
    }
}

struct tensor stress_contacts(const struct snapshot *s, const struct region *r)
{
    struct tensor T = { { { 0 } } };
    for (int64_t i = 0; i < s->s->n; i++) {
        const struct contact *c = &s->s->c[i];
        vec3 way = branch_way(s->p, c);
        double part = r->all ? 1 : region_way(r, branch_from(s->p, c), way);
        if (part > 0) tensor_add(&T, part, branch_force(s->p, s->s, i), way);
    }
    return T;
}

static const struct quantity quantities[] = {
    { "p", "Pa", 1, "mean pressure, a third of the trace (2D: half of it, N/m)" },
    { "q", "Pa", 1, "deviator, sqrt(3/2 s:s) (2D: half the difference of the principal values)" },
    { "tensor", "Pa", 9, "stress, compression positive (2D: N/m)" },
    { "contact_part", "Pa", 9, "part of the contacts" },
    { "kinetic", "Pa", 9, "part of the motion of bodies" },
    { "principal", "Pa", 3, "principal values of the stress, the largest first" },
    { 0 },
};

static int stress_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    const struct region *r = &s->region;
    struct moving m;
    double value[3], *at = table_row(t, failure);
    if (!at) return failure->status;
    if (!(r->volume > 0)) {
        table_null(t, "the region has no volume");
        return 0;
    }
    moving_of(&m, s, r);
    struct tensor contacts = stress_contacts(s, r), whole;
    tensor_scale(&contacts, 1 / r->volume), tensor_scale(&m.kinetic, 1 / r->volume);
    for (int k = 0; k < 9; k++)
        whole.x[k / 3][k % 3] = contacts.x[k / 3][k % 3] + m.kinetic.x[k / 3][k % 3];
    tensor_principal(&whole, s->p->dim, value);
    put(&at, tensor_trace(&whole) / s->p->dim), put(&at, tensor_deviator(&whole, s->p->dim));
    put_tensor(&at, &whole), put_tensor(&at, &contacts), put_tensor(&at, &m.kinetic);
    for (int k = 0; k < 3; k++) put(&at, value[k]);
    return 0;
}

const struct measure measure_stress = {
    .name = "stress",
    .help = "stress by contacts and motion, compression positive",
    .quantity = quantities,
    .usual = true,
    .needs = NEEDS_FORCES,
    .rows = stress_rows,
};
