/*
 * scene/hull.h: convex hulls, by qhull: the faces of a shape from points. Triangles in one plane
 * become one face, and points that are no corners are left out.
 */
#ifndef NSD_HULL_H
#define NSD_HULL_H

#include "bodies/shape.h"

/* s's vertices, faces and corners from n points (m; in the plane z = 0): corners in the order of the
   points, faces in that of their corners. Returns 0, EX_DATAERR where the points have no volume, or
   EX_SOFTWARE. */
int hull_of_points(struct shape *s, int dim, int64_t n, const vec3 *point, struct why *why);

#endif
