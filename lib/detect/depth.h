/*
 * detect/depth.h: how deep bodies are in one another, in radii of the smaller: that of the ball around
 * it where a grain has a shape.
 *
 * A body is wedged where two of its contacts are deeper than DEPTH_WEDGED and their normals point against each
 * other: neither velocities nor displacements free it without what holds it.
 */
#ifndef NSD_DEPTH_H
#define NSD_DEPTH_H

#include "bodies/contact.h"
#include "bodies/packing.h"

/* Radii: as deep as a run fails for [solve/account.h]; what an impact leaves for a step is less */
#define DEPTH_WEDGED 0.1

struct depth {
    double deepest;    /* radii; 0: nothing overlaps */
    int32_t pair[2];   /* the ids of a and b there; boundary w is -1-w */
    int64_t wedged;    /* bodies */
    int32_t wedged_id; /* the first of them */
};

/* Of contacts whose gaps are known. counts[i]: whether body i counts, which several processes have; NULL:
   all do. Returns 0 or EX_SOFTWARE. */
int depth_of(struct depth *depth, const struct packing *p, const struct contacts *s,
             const bool *counts, struct why *why);

#endif
