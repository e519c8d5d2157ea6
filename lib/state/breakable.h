/*
 * state/breakable.h: which bodies of a packing break, and how strong they are [state/breakage.h].
 */
#pragma once

#include "state/breakage.h"
#include "state/packing.h"

/* Returns 0 or EX_SOFTWARE: breakage[materials] and broken[materials], all zero, in place of the old ones, and the columns
   of bodies that go with them. */
int breakage_alloc(struct packing *p, struct failure *failure);
/* m: the diameter of the ball or disc of the volume of a body of this shape (NULL: a ball) and radius; that of body i */
double breakage_diameter_of(int dim, const struct shape *s, double radius);
double breakage_diameter(const struct packing *p, int64_t i);
/* How body i breaks; NULL: it does not, for it is held, too small, or of a material or shape that does not break */
const struct breakage *breakage_of(const struct packing *p, int64_t i);
/* Pa, J/kg: the strength of body i of this diameter; *scale: (d / size)^-e */
double breakage_strength(const struct packing *p, int64_t i, double d, double *scale);
/* Of all materials */
struct broken breakage_total(const struct packing *p);
