/* scene/thin.h: points that noise has made several of one. */
#ifndef NSD_THIN_H
#define NSD_THIN_H

#include "base/vec.h"
#include "base/failure.h"

#include <stdint.h>

/* The largest distance of n points from the first one, m */
double thin_extent(const vec3 *x, int64_t n);
/* to[i] = the point that stands for point i, and is within `apart` (m) of it; itself for those that stay, of which
   no two are as near. Of each cell of a grid as wide the first point stays, unless one of a cell before is near.
   Time n log n. Returns 0 or EX_SOFTWARE. */
int thin_out(int32_t *to, const vec3 *x, int64_t n, double apart, struct failure *failure);

#endif
