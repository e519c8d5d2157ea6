/* measure/boundaries.h: boundaries: how far they let bodies reach. */
#ifndef NSD_BOUNDARIES_H
#define NSD_BOUNDARIES_H

#include "bodies/packing.h"

/* Narrows [lo, hi] (m) to what walls upright to the axis leave of it, where they are now. */
void boundaries_reach(const struct packing *p, int axis, double *lo, double *hi);

#endif
