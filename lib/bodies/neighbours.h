/*
 * bodies/neighbours.h: which bodies are near each other. A list made at one step serves later steps
 * for as long as no pair that is missing from it can have come too close.
 */
#ifndef NSD_NEIGHBOURS_H
#define NSD_NEIGHBOURS_H

#include "base/why.h"
#include "bodies/packing.h"

struct pair {
    int32_t a, b; /* bodies, a < b; at least one can move */
};

/* All zero to begin with. */
struct neighbours {
    int64_t bodies, n, room; /* bodies; pairs; how many pairs there is memory for */
    struct pair *pair;       /* [n] sorted by (a, b), each once */
    double reach; /* m: the list has every pair whose gap was at most this when it was made */
    vec3 *listed; /* [bodies] m: where the bodies were then; NULL: not kept */
};

/*
 * Makes s->pair hold every pair whose gap is at most `gap` (m) with the bodies at x[n] (m), and
 * perhaps others that are near. keep: s will be asked again, after a step of the same bodies; the
 * list is then made to reach further, and is made anew only when it no longer serves.
 *
 * Cost is linear: bodies are sorted by size into levels of a factor of two, each level into the
 * cells of its own grid, and a body looks into the grids of its own and of larger sizes only.
 * Cells are hashed, so that a body far away costs nothing. Returns 0, EX_SOFTWARE or, where bodies
 * crowd, EX_DATAERR.
 */
int neighbours_find(struct neighbours *s, const struct packing *p, const vec3 *x, double gap,
                    bool keep, struct why *why);
void neighbours_free(struct neighbours *s);

#endif
