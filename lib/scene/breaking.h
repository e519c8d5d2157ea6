/*
 * scene/breaking.h: grains that are due break at the beginning of a step [state/breakage.h], with their damage from the steps
 * before. A grain is replaced by its pieces [shape/fracture.h], which lie where they were in it and move as its material
 * did: v + w x (x - c) and w. Its mass, momentum, angular momentum and kinetic energy are those of the pieces, to rounding,
 * and of the dust: what a ball has outside of what is inscribed in it, and pieces that are too small. So nothing overlaps that
 * the grain did not overlap.
 *
 * The points of a tessellation are those of the seed and the id of the grain. Fragments have the next ids, and follow all other
 * bodies. So nothing depends on threads, nor on where runs begin and end.
 */
#pragma once

#include "state/contact.h"
#include "state/packing.h"

enum {
    BREAKING_MOST =
        1000 /* grains that break in a step, those of the first rows; the others wait for the next */
};

/* At the beginning of the packing's next step. *changed becomes true where a grain has broken; the contacts of the last step (or
   NULL) are then told of the bodies' new rows. Returns 0, EX_DATAERR (no ids are left) or EX_SOFTWARE. */
int breaking_step(struct packing *p, struct contacts *last, bool *changed, struct failure *failure);
