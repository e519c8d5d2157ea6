/*
 * state/attraction.h: how the places where bodies attract each other share the force of cohesion and liquid.
 *
 * A pair attracts once, at however many places it meets. Walls and fixed bodies side by side in one plane are parts of one
 * surface [contact/internal_edge.h], which attracts a body once, and so do curved walls that end in one another: where a wall ends
 * on a nearer one it does not attract. Where all places of a pair are in one plane, the resultant of
 * the force is at the centre of the face where the bodies meet: the centroid of the polygon that the places span or, where
 * detection has left four of more corners [shape/meet.h], of the two faces' common part. Among the shares that have
 * it there they are the most even.
 */
#pragma once

#include "state/packing.h"

/* Of a contact: what it has without the others, and what comes of it */
struct attraction {
    bool tied, bonded; /* cohesion or liquid holds it; it is bonded, or will be where it touches */
    bool broken;       /* a bond of the pair has broken, and it has not parted since */
    double among;      /* its pull is that of its pair over this; INFINITY: none */
    double bonds;      /* so many contacts share the area of a bond */
};

/* Sets of[i].among and .bonds, 1 at least, of all contacts. Returns 0 or EX_SOFTWARE. */
int attraction_share(struct attraction *of, const struct contacts *s, const struct packing *p,
                     struct failure *failure);
