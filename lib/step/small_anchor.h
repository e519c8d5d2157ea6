/*
 * step/small_anchor.h: bonds of adhesion at the points of meetings. A bond keeps its place on both bodies
 * [contact/bond_anchor.h]: it is a point with a feature below 0, which the narrow phase does not find. Points that it finds where a bond
 * holds are none. In this order of a small step, when points have been looked for:
 *
 *     place     bonds are where their bodies have carried them
 *     begin     shear and damage of the step before; bonds that break; points that they hide
 *     make      bonds of points that touch, or have pushed in the step before
 *
 * A broken bond is a point until its bodies have parted. Bonds of a pair that are made in one interval share its area.
 * Bonds of balls with surfaces keep no place, as those with other walls: they are where the ball is next to the surface, and have the
 * feature of that point in documents.
 */
#pragma once

#include "step/small_run.h"

/* Is the point a bond, perhaps a broken one; and does it hold? */
static inline bool small_point_bonded(const struct small_point *t)
{
    return t->feature < 0;
}
static inline bool small_point_holds(const struct small_point *t)
{
    return t->feature < 0 && t->spring[SPRING_BETA] > 0;
}

/* t->spring but for what lasts; wn, wt: 1/kg, of the point along n and across */
void small_anchor_stiff(const struct small_run *r, const struct small_meeting *m,
                        struct small_point *t, double wn, double wt);

/* Where a bond that holds is now; false: its wall has gone. */
bool small_anchor_place(const struct small_run *r, const struct small_meeting *m,
                        struct small_point *t, struct contact *c);
/* m: points of a ball's meeting with a surface are looked for to this gap; 0: of others */
double small_anchor_reach(const struct small_run *r, const struct small_meeting *m);
/* By one thread for each meeting; `last`: at the end of the interval, where nothing is stretched. Returns whether points
   are hidden now. */
bool small_anchors_begin(const struct small_run *r, struct small_meeting *m, bool last);
/* By one thread */
void small_anchors_make(struct small_run *r);
void small_anchors_free(struct small_run *r);

/* is[3] (N s): by the law of a point whose bond holds, what it pushes and what the bond pulls, where it has f[3], in the basis e. Returns what
   it pushes. */
double small_bond_law(const struct small_run *r, const struct small_meeting *m,
                      const struct small_point *t, const vec3 e[3], const double f[3],
                      double is[3]);

/* The meeting gets the bond of a packing; false when memory is short. */
bool small_anchor_recall(const struct small_run *r, struct small_meeting *m, const struct bond *b);
/* What lasts of the bond of a point at the end of the interval; false: nothing does. b has its key. */
bool small_anchor_keep(const struct small_run *r, const struct small_meeting *m,
                       const struct small_point *t, struct bond *b);
