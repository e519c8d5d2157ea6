/* shape/between.h: whether a boundary of two sides lies between two places: a corner of a body on the
   other side than its middle has gone through. */
#ifndef NSD_BETWEEN_H
#define NSD_BETWEEN_H

#include "shape/mesh.h"

#include <stdbool.h>

/* Does the way from a to b (m, from the boundary's point of reference, before any motion) cross the
   boundary? Of rectangles, discs and meshes (surface); of others that is not looked at: true. */
bool boundary_between(const struct wall *w, int dim, const struct surface *surface, vec3 a, vec3 b);

#endif
