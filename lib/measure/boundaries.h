/* measure/boundaries.h: boundaries: what pushes them, how far they let bodies reach, how they move. */
#ifndef NSD_BOUNDARIES_H
#define NSD_BOUNDARIES_H

#include "bodies/packing.h"

/* Narrows [lo, hi] (m) to what walls upright to the axis leave of it, where they are now. */
void boundaries_reach(const struct packing *p, int axis, double *lo, double *hi);
/* m/s: of the boundary of a contact (a < 0) at the point x */
vec3 boundary_velocity(const struct packing *p, int32_t a, vec3 x);

#endif
