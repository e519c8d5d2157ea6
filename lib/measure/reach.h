/* measure/reach.h: how far planes let bodies reach. */
#ifndef NSD_REACH_H
#define NSD_REACH_H

#include "state/packing.h"

/* Narrows [lo, hi] (m) to what walls upright to the axis leave of it, where they are now. */
void reach_of_planes(const struct packing *p, int axis, double *lo, double *hi);

#endif
