/*
 * measure/inside.h: the inside of a bed, away from its surface and its walls, where its solid fraction is that of the
 * bulk.
 */
#pragma once

#include "measure/region.h"

/* r = the inside: a box between the heights, along each axis, beyond which a tenth of the solid volume lies, a mean
   diameter farther in; where a plane bounds the axis, two mean diameters from it. Returns 0; 1 where planes bound all
   axes, the cell is periodic or the bed is too small for an inside: r is then as it was; or EX_SOFTWARE. */
int region_inside(struct region *r, const struct packing *p, struct failure *failure);
