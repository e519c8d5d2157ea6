/*
 * bodies/kinematics.h: what the motion of two bodies means at their contact.
 *
 * The lever arms lie along the normal. The paper's reach to the point of contact as it is
 * predicted, midway in the overlap. An impact finds an overlap of up to v dt/2, and the arms
 * shorter by that. Against a wall the true arm is the radius. Between two bodies half the overlap
 * is taken off each: only la + lb = the distance of the centres keeps the angular momentum.
 */
#ifndef NSD_KINEMATICS_H
#define NSD_KINEMATICS_H

#include "bodies/contact.h"
#include "bodies/packing.h"

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

/* m/s: n . (v_b - v_a), with the velocities that the bodies have now; for balls that is u_n */
static inline double opening_of(const struct packing *p, const struct contact *c)
{
    vec3 va = c->a < 0 ? wall_velocity(&p->wall[-1 - c->a], c->x) : p->v[c->a];
    vec3 vb = v3_add(p->v[c->b], cell_shift(p->cell.rate, c->shift));
    return v3_dot(v3_sub(vb, va), c->n);
}

#endif
