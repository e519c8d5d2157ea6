/*
 * contact/depth.h: how deep bodies are in one another, in radii of the smaller: that of the ball around
 * it where a grain has a shape.
 *
 * A body is pinched where two of its contacts are deeper than DEPTH_PINCHED and their normals point against each
 * other: neither velocities nor displacements free it without what holds it.
 */
#pragma once

#include "state/contact.h"
#include "state/packing.h"
#include "state/report.h"

/* Of contacts whose gaps are known. counts[i]: whether body i counts, which several processes have; NULL:
   all do. Returns 0 or EX_SOFTWARE. */
int depth_of(struct depth *depth, const struct packing *p, const struct contacts *s,
             const bool *counts, struct failure *failure);
