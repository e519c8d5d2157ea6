/*
 * contact/bond_anchor.h: the places of bonds between grains of which one is no ball.
 *
 * Two balls have one contact, and it is found again in the next step. Where a brick stands on
 * another, contacts change with the corners and edges that happen to meet: a bond must not. It
 * is anchored: it keeps the two points of the surfaces where it was made, each in its body's frame, and
 * the normal, which turns with b. They are a contact of every step while the bond lasts,
 *
 *     x = (x_a + x_b)/2,   gap = n . (x_b - x_a),
 *
 * in place of those that are found within NEAR radii of it. Its key is (a, b, feature) with a negative
 * feature, counted down in each pair.
 */
#pragma once

#include "state/placement.h"

/*
 * Puts the contacts of all anchored bonds that hold into s, which has been detected at these positions. Returns 0 or
 * EX_SOFTWARE.
 */
int anchors_place(struct contacts *s, const struct packing *p, const struct positions *at,
                  struct failure *failure);

/* Is the contact that of an anchored bond? */
static inline bool contact_anchored(const struct contact *c)
{
    return c->feature < 0;
}

/* The contact of an anchored bond, where a, a body or a wall, and the image of b are at of[]; edge: of the cell (m) */
struct contact bond_anchor_contact(const struct packing *p, const struct bond *b,
                                   const struct pose of[2], const vec3 edge[3]);
/* Is c where a bond of its pair at x (m) is? */
bool bond_anchor_near(const struct packing *p, const struct contact *c, vec3 x);

/* Gives b, made at c, its anchors and an area (m^2), where bodies are at of[]. */
void bond_anchor_at(struct bond *b, const struct contact *c, double area, const struct pose of[2]);
/* Gives b, made at c of this step, its anchors and an area (m^2). The contact has been detected `ahead` (s) of the bodies. */
void bond_anchor(struct bond *b, const struct packing *p, const struct contact *c, double area,
                 double ahead);
