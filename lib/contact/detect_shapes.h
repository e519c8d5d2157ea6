/*
 * contact/detect_shapes.h: contacts of bodies that are not both balls, and of shaped bodies with
 * walls.
 *
 * A wall is met by the corners of a core, each where the surface is next to it: that is all that
 * can meet a plane, or a cylinder, cone or sphere from inside. The outside of a sphere or an endless
 * cylinder is met as a ball or a capsule would be. The rims and ridges of rectangles, segments, meshes and
 * chains meet edges and faces, too [shape/wall_edge.h]; those of discs, cylinders and cones do not.
 */
#pragma once

#include "contact/neighbours.h"
#include "contact/seek.h"
#include "state/contact.h"
#include "state/placement.h"

enum {
    RIM_END = 1 << 29 /* features of rims and their ends are not below it, those of corners are */
};

/* Contacts of a pair of bodies, b moved by `away` (m), with a gap of at most `gap` (m), sorted by feature.
   pair->shift: as of a contact. Law and point are set. False when memory is short. */
bool detect_shapes_pair(struct contacts *out, const struct placed *s, const struct pair *pair,
                        vec3 away, double gap);
/* Contacts of body i, which is shaped, with wall w */
bool detect_shapes_wall(struct contacts *out, const struct situation *all, int32_t w, int64_t i,
                        double gap);
