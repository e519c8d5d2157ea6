/* scene/thin.h: points that noise has made several of one. */
#ifndef NSD_THIN_H
#define NSD_THIN_H

#include "base/vec.h"
#include "base/why.h"

#include <stdint.h>

/* kept[0 .. *n_kept-1], ascending: points of which no two are within `apart` (m) of each other, and within that
   of every other point. Of the cells of a grid as wide, the first point in each is taken, unless one in a cell
   before is near. Time n log n. Returns 0 or EX_SOFTWARE. */
int thin_out(int32_t *kept, int64_t *n_kept, const vec3 *x, int64_t n, double apart,
             struct why *why);

#endif
