/*
 * scene/random_start.h: grains at random in a box, without overlap and without a lattice.
 *
 * In a periodic cell, whose edges need not be along the axes, grains and their images fill it across the border.
 *
 * Loose (a share of the box up to 0.28, in the plane 0.4): random sequential addition, the largest
 * first, each where it meets none that is there. Denser: that, with radii scaled down; then all
 * radii grow together towards what was asked, as in Lubachevsky & Stillinger (1990), and after every
 * growth the overlaps are pushed out pair by pair, as in Jodrey & Tory (1985), a pair's lighter grain
 * by more, and out of the walls. Equal balls reach 0.6 of a large box, discs 0.8; then none overlaps at all, for pairs are
 * pushed a little further than needed.
 */
#pragma once

#include "scene/grains.h"

#include <gsl/gsl_rng.h>

/*
 * A lattice whose cells fit each its grain: sorted by size, large ones first, the
 * grains fill rows, the rows shelves, and the shelves the box from below; a row is as wide and a
 * shelf as high as its first grain needs. However different the grains, their cells fill most of
 * the box, where equal cells would fit the largest only.
 */

/* The group's count grains, in the order drawn. Returns 0, EX_DATAERR where the box is too small, or
   EX_SOFTWARE. */
int shelves_fill(struct grains *out, const struct scene_bodies *group, int dim, gsl_rng *rng,
                 struct failure *failure);

/* The group's grains, in the order drawn; in its box, or, not NULL, in this cell; not in the walls of a packing, or NULL
   [scene/obstacles.h]. Returns 0, EX_DATAERR where they do not go in, or EX_SOFTWARE. */
int random_start(struct grains *out, const struct scene_bodies *group, int dim,
                 const struct cell *cell, const struct packing *walls, gsl_rng *rng,
                 struct failure *failure);
