/* measure/walls.h: boundaries: what pushes them, how far they let bodies reach, how they move. */
#ifndef NSD_MEASURE_WALLS_H
#define NSD_MEASURE_WALLS_H

#include "bodies/packing.h"

/* Narrows [lo, hi] (m) to what walls upright to the axis leave of it, where they are now. */
void walls_reach(const struct packing *p, int axis, double *lo, double *hi);
/* m/s: of the boundary of a contact (a < 0) at the point x */
vec3 walls_velocity(const struct packing *p, int32_t a, vec3 x);

#endif
