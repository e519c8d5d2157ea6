/*
 * scene/hull.h: convex hulls, by qhull: the faces of a shape from points.
 *
 * Points may be noisy, and several in one place. Points as near each other as HULL_APART are one. qhull then
 * triangulates, of points moved by some 1e-11 of the extent at random, always alike, so that none are exactly in
 * a plane: what it says is which triangles there are, and which are next to each other. Neighbours that are
 * within HULL_FLAT of a plane, that of the largest, are one face; and corners of two faces only, and faces of two
 * corners, are none. So faces close, whatever rounding and noise say of each single one.
 */
#pragma once

#include "base/failure.h"
#include "base/vec.h"
#include "shape/shape.h"

#include <stdint.h>

/* Points that noise has made several of one. */

/* The largest distance of n points from the first one, m */
double thin_extent(const vec3 *x, int64_t n);
/* to[i] = the point that stands for point i, and is within `apart` (m) of it; itself for those that stay, of which
   no two are as near. Of each cell of a grid as wide the first point stays, unless one of a cell before is near.
   Time n log n. Returns 0 or EX_SOFTWARE. */
int thin_out(int32_t *to, const vec3 *x, int64_t n, double apart, struct failure *failure);

/* Of the extent: what is closer to a plane is in it, as are the corners of files in single precision, whose last
   bit is 6e-8 of the largest; what is closer together is one point, for a shape's faces are flat to 1e-6. */
static const double HULL_FLAT = 2e-7, HULL_APART = 1e-6;

/* s's vertices, faces and corners from n points (m; in the plane z = 0): corners in the order of the
   points, faces in that of their corners. Returns 0, EX_DATAERR where the points have no volume, or
   EX_SOFTWARE. */
int hull_of_points(struct shape *s, int dim, int64_t n, const vec3 *point, struct failure *failure);
