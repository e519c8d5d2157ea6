/*
 * scene/shelves.h: a lattice whose cells fit each its grain: sorted by size, large ones first, the
 * grains fill rows, the rows shelves, and the shelves the box from below; a row is as wide and a
 * shelf as high as its first grain needs. However different the grains, their cells fill most of
 * the box, where equal cells would fit the largest only.
 */
#ifndef NSD_SHELVES_H
#define NSD_SHELVES_H

#include "scene/grains.h"

#include <gsl/gsl_rng.h>

/* The group's count grains, in the order drawn. Returns 0, EX_DATAERR where the box is too small, or
   EX_SOFTWARE. */
int shelves_fill(struct grains *out, const struct scene_bodies *group, int dim, gsl_rng *rng,
                 struct failure *failure);

#endif
