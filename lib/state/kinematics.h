/*
 * state/kinematics.h: what the motion of two bodies means at their contact.
 *
 * The lever arms lie along the normal. The paper's reach to the point of contact as it is
 * predicted, midway in the overlap. An impact finds an overlap of up to v dt/2, and the arms
 * shorter by that. Against a wall the true arm is the radius. Between two bodies half the overlap
 * is taken off each: only la + lb = the distance of the centres keeps the angular momentum.
 */
#pragma once

#include "state/contact.h"
#include "state/packing.h"

/* la, lb (m), with the bodies `ahead` (s) from where they are when the contact acts, and the
   edges of the cell (m) there */
static inline void arms_of(const struct packing *p, const struct contact *c, double ahead,
                           const vec3 edge[3], double *la, double *lb)
{
    if (p->overlap <= OVERLAP_KEEP) {
        vec3 xa = c->a < 0 ? c->x : v3_axpy(p->x[c->a], ahead, p->v[c->a]);
        vec3 xb = v3_axpy(p->x[c->b], ahead, p->v[c->b]);
        contact_arms(c, xa, v3_add(xb, cell_shift(edge, c->shift)), la, lb);
        return;
    }
    *la = c->a < 0 ? 0 : p->radius[c->a] + 0.5 * c->gap;
    *lb = p->radius[c->b] + (c->a < 0 ? 0 : 0.5 * c->gap);
}

/* Whether a body of the contact has another shape than a ball: its arms are any vectors. */
static inline bool contact_shaped(const struct packing *p, const struct contact *c)
{
    return p->shape && (p->shape[c->b] > 0 || (c->a >= 0 && p->shape[c->a] > 0));
}

/* m: from the centres of a and b to the point of contact, b the image that a meets; 0 of a wall, whose
   velocity is that of the point */
struct arms {
    vec3 a, b;
};

static inline struct arms arm_vectors(const struct packing *p, const struct contact *c,
                                      double ahead, const vec3 edge[3])
{
    struct arms o = { { 0, 0, 0 }, { 0, 0, 0 } };
    if (!contact_shaped(p, c)) {
        double la, lb;
        arms_of(p, c, ahead, edge, &la, &lb);
        return (struct arms){ v3_scale(la, c->n), v3_scale(-lb, c->n) };
    }
    vec3 xb = v3_axpy(p->x[c->b], ahead, p->v[c->b]);
    o.b = v3_sub(c->x, v3_add(xb, cell_shift(edge, c->shift)));
    if (c->a >= 0) o.a = v3_sub(c->x, v3_axpy(p->x[c->a], ahead, p->v[c->a]));
    return o;
}

/* m/s: n . (v_b - v_a), with the velocities that the bodies have now, `ahead` (s) from where the contact acts;
   which is u_n */
static inline double opening_of(const struct packing *p, const struct contact *c, double ahead)
{
    vec3 va = c->a < 0 ? wall_velocity(p, &p->wall[-1 - c->a], c->x) : p->v[c->a];
    vec3 vb = v3_add(p->v[c->b], cell_shift(p->cell.rate, c->shift));
    if (contact_shaped(p, c)) {
        vec3 edge[3];
        cell_predict(&p->cell, ahead, edge);
        struct arms o = arm_vectors(p, c, ahead, edge);
        vb = v3_add(vb, v3_cross(p->w[c->b], o.b));
        if (c->a >= 0) va = v3_add(va, v3_cross(p->w[c->a], o.a));
    }
    return v3_dot(v3_sub(vb, va), c->n);
}

/* m/s: of b against a at the contact, with the velocities that the bodies have now and these arms */
static inline vec3 velocity_of(const struct packing *p, const struct contact *c,
                               const struct arms *o)
{
    const struct wall *w = c->a < 0 ? &p->wall[-1 - c->a] : NULL;
    vec3 va = w ? v3_add(wall_velocity(p, w, c->x), wall_belt(p, w, c->n))
                : v3_add(p->v[c->a], v3_cross(p->w[c->a], o->a));
    vec3 vb = v3_add(p->v[c->b], v3_cross(p->w[c->b], o->b));
    return v3_sub(v3_add(vb, cell_shift(p->cell.rate, c->shift)), va);
}

/* m/s: |u_t|, with the velocities that the bodies have now, as above; the cell's edges (m) there */
static inline double sliding_of(const struct packing *p, const struct contact *c, double ahead,
                                const vec3 edge[3])
{
    const struct arms o = arm_vectors(p, c, ahead, edge);
    const vec3 u = velocity_of(p, c, &o);
    return v3_norm(v3_axpy(u, -v3_dot(u, c->n), c->n));
}
