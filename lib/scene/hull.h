/*
 * scene/hull.h: convex hulls, by qhull: the faces of a shape from points. Triangles in one plane
 * become one face, and points that are no corners of three faces are left out.
 */
#ifndef NSD_HULL_H
#define NSD_HULL_H

#include "bodies/shape.h"

/* Points are in a plane to this part of the extent: numbers as they are written, and those of files in
   single precision, whose last bit is 6e-8 of the largest. */
static const double HULL_FLAT = 1e-8, HULL_FLAT_SINGLE = 2e-7;

/* s's vertices, faces and corners from n points (m; in the plane z = 0): corners in the order of the
   points, faces in that of their corners; points within `flat` of the extent of a plane are in it.
   Returns 0, EX_DATAERR where the points have no volume, or EX_SOFTWARE. */
int hull_of_points(struct shape *s, int dim, int64_t n, const vec3 *point, double flat,
                   struct why *why);

#endif
