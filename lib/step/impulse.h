/*
 * step/impulse.h: what the reactions of a step give to the bodies and to the freedoms beyond
 * theirs, P r and J^T r, summed in the contacts' order, and forces from outside [state/external_force.h].
 */
#pragma once

#include "state/freedom.h"
#include "state/kinematics.h"

/* One contact, while its bodies are where it acts */
struct push {
    vec3 f, m;     /* N s: on b; N s: -n x f, which turns a by la and b by lb */
    double la, lb; /* m: lever arms along n */
    bool shaped;   /* arms are any vectors: these moments act */
    vec3 ma, mb;   /* N m s: on a and on b */
};

struct impulses {
    vec3 *force, *moment;     /* [n] N s, N m s */
    struct freedoms freedoms; /* of the step */
    double *yield;            /* [freedoms.n] N s, N m s */
    double ahead;             /* s: from the packing to where the contacts act */
    vec3 edge[3];             /* m: of the cell there */
    vec3 next[3];             /* m/s: rates of the cell at the end of the step, but for freedoms */
    struct cell_flow flow;    /* what these, and the freedoms, make of the bodies' velocities */
};

/* The bodies are `ahead` (s) from where the contact acts, and the cell has these edges (m) there. */
static inline struct push push_of(const struct packing *p, double ahead, const vec3 edge[3],
                                  const struct contact *c, const double r[3])
{
    struct push o = { .shaped = contact_shaped(p, c) };
    vec3 t2 = contact_t2(c);
    o.f = v3_axpy(v3_axpy(v3_scale(r[0], c->n), r[1], c->t1), r[2], t2);
    if (o.shaped) {
        struct arms arm = arm_vectors(p, c, ahead, edge);
        o.ma = v3_cross(o.f, arm.a), o.mb = v3_cross(arm.b, o.f);
        return o;
    }
    arms_of(p, c, ahead, edge, &o.la, &o.lb);
    o.m = v3_axpy(v3_scale(r[2], c->t1), -r[1], t2); // -n x r
    return o;
}

/* J: what it does at b, and at a, in turning with the angular velocity w */
static inline double push_turns_b(const struct push *o, vec3 w)
{
    return o->shaped ? v3_dot(o->mb, w) : o->lb * v3_dot(o->m, w);
}
static inline double push_turns_a(const struct push *o, vec3 w)
{
    return o->shaped ? v3_dot(o->ma, w) : o->la * v3_dot(o->m, w);
}

/* Of all contacts, in the step that begins where the packing is, or, ended, that ends there; then
   without next[] and flow. Returns 0 or EX_SOFTWARE; to be freed in any case. */
int impulses_init(struct impulses *sum, const struct packing *p, const struct contacts *s,
                  bool ended, struct failure *failure);
void impulses_free(struct impulses *sum);

/* m/s, rad/s: what the step makes of the speed of freedom k */
static inline double impulses_change(const struct impulses *sum, const struct packing *p, int32_t k)
{
    const struct freedom *f = &sum->freedoms.f[k];
    return (p->dt * f->force + sum->yield[k]) / f->mass;
}
