/*
 * measure/branch.h: where a contact's force acts. Contacts act in the middle of a step, at the
 * predicted positions [nsd-methods(7)], which a document does not have but the contact says: the
 * centres lie on its normal through its point. So branch vectors across the border of a cell that
 * repeats are those to the image, and the frame's own positions, half a step before or after, do
 * not matter. Those of bodies of other shapes than balls are from the frame's positions.
 */
#pragma once

#include "contact/contact_law.h"
#include "measure/snapshot.h"
#include "state/kinematics.h"

#include <stdint.h>

/* m: how far the centres of a and b are from the contact's point; a wall's is 0, and b's then
   the whole distance to it. */
static inline double branch_a(const struct packing *p, const struct contact *c)
{
    return c->a < 0 ? 0 : p->radius[c->a] + 0.5 * c->gap;
}
static inline double branch_b(const struct packing *p, const struct contact *c)
{
    return p->radius[c->b] + (c->a < 0 ? c->gap : 0.5 * c->gap);
}

/* m: from the contact's point to the centre of b (that a meets), and from that of a, or the point on the
   wall, to the contact's point */
static inline vec3 branch_to_b(const struct packing *p, const struct contact *c)
{
    if (!contact_shaped(p, c)) return v3_scale(branch_b(p, c), c->n);
    return v3_sub(v3_add(p->x[c->b], cell_shift(p->cell.edge, c->shift)), c->x);
}
static inline vec3 branch_from_a(const struct packing *p, const struct contact *c)
{
    if (!contact_shaped(p, c)) return v3_scale(branch_a(p, c), c->n);
    return c->a < 0 ? v3(0, 0, 0) : v3_sub(c->x, p->x[c->a]);
}

/* m: the centre of a, or the point on the wall; and from there to the centre of b */
static inline vec3 branch_from(const struct packing *p, const struct contact *c)
{
    if (contact_shaped(p, c)) return v3_sub(c->x, branch_from_a(p, c));
    return v3_axpy(c->x, -branch_a(p, c), c->n);
}
static inline vec3 branch_way(const struct packing *p, const struct contact *c)
{
    if (contact_shaped(p, c)) return v3_add(branch_from_a(p, c), branch_to_b(p, c));
    return v3_scale(branch_a(p, c) + branch_b(p, c), c->n);
}

/* N, in space: on b of contact i */
static inline vec3 branch_force(const struct packing *p, const struct contacts *s, int64_t i)
{
    return v3_scale(1 / p->dt, contact_in_space(&s->c[i], s->found[i].r));
}

/* N m, in space: on b of contact i about a point, that of rolling and pivoting friction included */
static inline vec3 branch_torque(const struct packing *p, const struct contacts *s, int64_t i,
                                 vec3 about)
{
    vec3 m = v3_cross(v3_sub(s->c[i].x, about), branch_force(p, s, i));
    if (!s->moment) return m;
    return v3_axpy(m, 1 / p->dt, contact_in_space(&s->c[i], s->moment[i]));
}

/* Does contact i count? Solved: it pushes or pulls; else the bodies touch. And what a tie holds does. */
static inline bool branch_counts(const struct contacts *s, int64_t i)
{
    if (s->law && contact_law_holds(&s->law[i])) return true;
    return s->found ? s->found[i].r[0] != 0 : s->c[i].gap <= 0;
}

/* How many contacts each body has, and which bodies bear nothing. */

/* [n] contacts that count [measure/branch.h] of each body; NULL when memory is short. To be freed. */
int32_t *counts_of(const struct snapshot *s);
/*
 * Takes contacts off count[n] until every body that moves has none or at least `least`: what is left
 * bears. Returns 0, or -1 when memory is short.
 */
int counts_without_rattlers(int32_t *count, const struct snapshot *s, int least);
/* A body that moves, to which measures keep, and whose centre is in the region? */
bool counts_body(const struct snapshot *s, int64_t i);
