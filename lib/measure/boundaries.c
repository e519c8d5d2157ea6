/* measure/boundaries.c: what pushes boundaries. */
#include "measure/branch.h"
#include "measure/measures.h"

#include <math.h>
#include <stdlib.h>

/* What bodies do to a boundary, or to all fixed bodies */
struct push {
    int64_t contacts;
    vec3 force, torque; /* N, N m */
    double normal, tangential;
};

static const struct quantity quantities[] = {
    { "boundary", "1", 1, "its number; -1: all bodies that are fixed" },
    { "contacts", "1", 1, "that push or pull" },
    { "force", "N", 3, "of the bodies on it" },
    { "torque", "N m", 3, "of that about --point" },
    { "normal", "N", 1, "sum of normal forces" },
    { "tangential", "N", 1, "sum of tangential forces, each its size" },
    { 0 },
};

static void add(struct push *to, const struct snapshot *s, int64_t i, double sign)
{
    const struct contact *c = &s->s->c[i];
    const double *r = s->s->found[i].r;
    vec3 f = v3_scale(sign, branch_force(s->p, s->s, i));
    to->contacts += branch_counts(s->s, i);
    to->force = v3_add(to->force, f);
    to->torque = v3_add(to->torque, v3_cross(v3_sub(c->x, s->asked->point), f));
    to->normal += r[0] / s->p->dt;
    to->tangential += hypot(r[1], r[2]) / s->p->dt;
}

static int boundaries_rows(struct table *t, const struct snapshot *s, struct why *why)
{
    const struct packing *p = s->p;
    bool fixed = false;
    for (int64_t i = 0; i < p->n; i++) fixed = fixed || p->mass[i] == 0;
    // boundary w at [w], fixed bodies behind them
    struct push *push = calloc((size_t)p->walls + 1, sizeof *push);
    if (!push) return why_set(why, EX_SOFTWARE, "no memory for the forces on boundaries");
    for (int64_t i = 0; i < s->s->n; i++) {
        const struct contact *c = &s->s->c[i];
        if (c->a < 0)
            add(&push[-1 - c->a], s, i, -1);
        else if (p->mass[c->a] == 0)
            add(&push[p->walls], s, i, -1);
        if (p->mass[c->b] == 0) add(&push[p->walls], s, i, 1);
    }
    for (int32_t w = 0; w < p->walls + fixed; w++) {
        double *at = table_row(t, why);
        if (!at) break;
        put(&at, w < p->walls ? w : -1), put(&at, (double)push[w].contacts);
        put_vec(&at, push[w].force), put_vec(&at, push[w].torque);
        put(&at, push[w].normal), put(&at, push[w].tangential);
    }
    free(push);
    return why->status;
}

const struct measure measure_boundaries = {
    .name = "boundaries",
    .help = "forces on boundaries, and their torques",
    .quantity = quantities,
    .list = true,
    .needs = NEEDS_FORCES,
    .rows = boundaries_rows,
};
