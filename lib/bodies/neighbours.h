/*
 * bodies/neighbours.h: which bodies are near each other. The list of a step serves the steps after it for
 * as long as nothing can have come closer than it knows.
 */
#ifndef NSD_NEIGHBOURS_H
#define NSD_NEIGHBOURS_H

#include "base/why.h"
#include "bodies/packing.h"

struct pair {
    int32_t a, b; /* bodies, a < b, one of them movable */
};

/* All zero to begin with. */
struct neighbours {
    int64_t bodies, n, room;
    struct pair *pair; /* [n] by (a, b), each once */
    double reach;      /* m: when they were listed, every pair with at most this gap was; */
    vec3 *listed;      /* [bodies] m: and the bodies were here */
};

/*
 * Among the pairs all whose gap is at most `gap` (m) with the bodies at x[n] (m); others that are
 * near may be, too. `keep`: the same bodies will be asked for again, after a step.
 *
 * Cost is linear: bodies are sorted by size into levels of a factor of two, each level into the
 * cells of its own grid, and a body looks into the grids of its own and of larger sizes only.
 * Cells are hashed, so that a body far away costs nothing. Returns 0, EX_SOFTWARE or, where bodies crowd, EX_DATAERR.
 */
int neighbours_find(struct neighbours *, const struct packing *, const vec3 *x, double gap,
                    bool keep, struct why *);
void neighbours_free(struct neighbours *);

#endif
