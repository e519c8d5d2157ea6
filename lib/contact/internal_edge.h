/*
 * contact/internal_edge.h: seams of surfaces that are assembled of several parts: triangles, walls, fixed bodies side by
 * side. A body that slides on one part meets the rim of the next, which lies in the same plane, with a
 * normal along that plane; where the law sees gaps it would be stopped there. Such a contact is none.
 *
 * A contact e of body s with a part E gives a plane P through its place on E, across its normal m, and s lies
 * above P. Another contact of s, with part B and of normal n, is dropped where
 *
 *     n is not along m;
 *     no place of s and B with that normal is above P;
 *     and B does not rise above P there by more than 30 degrees:
 *
 * s passes above B as it passes above P. A wall or a step that rises is met as it would be without E; ends of
 * surfaces, ridges and grooves are as they were. Above is by more than the larger of the weld tolerances of E and B
 * [shape/wall_shape.h] and 1e-5 of the radius of s: a lower step is climbed. B and E may be one mesh, whose
 * triangles do not share all corners.
 */
#pragma once

#include "contact/seek.h"
#include "state/contact.h"

/* Drops contacts of s, sorted, at seams. Returns 0 or EX_SOFTWARE. */
int seams_drop(struct contacts *s, const struct situation *o, struct failure *failure);
/* May a contact be one at a seam, by what meets there alone? */
bool seams_may(const struct situation *o, const struct contact *c);
/* Is contact i of s, sorted, at a seam? s: all contacts of this body with walls and with bodies that do not move */
bool seams_has(const struct contacts *s, const struct situation *o, int32_t body, int64_t i);
