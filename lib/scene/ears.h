/*
 * scene/ears.h: polygons of space cut into triangles, by ear clipping: a corner whose triangle with its two
 * neighbours has no other corner in it is cut off, until three are left. [Meisters 1975]
 *
 * The polygon may be concave. It must be flat, to a hundredth of its extent: corners are written with few
 * decimals, and what is bent further has several triangulations that are different surfaces. It must not
 * cross itself. Corners on a straight line are no ears: no triangle is without an area that need not be.
 */
#pragma once

#include "base/vec.h"

#include <stdint.h>

enum { POLYGON_CORNERS_MOST = 4096 };

/* triangle[0 .. *triangles-1] = corners of the polygon x[n], in its sense of rotation; room: n - 2 triangles.
   Of one whose corners lie on a line there are none. *work: comparisons of corners that may still be made, of
   which polygons that are not convex take n^2. Returns NULL, or what is wrong with the polygon. */
const char *ears_cut(const vec3 *x, int32_t n, int32_t (*triangle)[3], int32_t *triangles,
                     int64_t *work);
