/*
 * state/placed.h: shaped bodies where contacts are sought: the corners of all in space, and the
 * normals of hulls. Made once for a search; a body is then its cores [shape/core.h], a clump one for
 * each of its balls, all other bodies one.
 */
#ifndef NSD_PLACED_H
#define NSD_PLACED_H

#include "state/positions.h"
#include "shape/core.h"

struct placed {
    const struct packing *p;
    const vec3 *x;         /* [p->n] m: the bodies' centres */
    int64_t *first, *face; /* [p->n + 1] body i: vertex[first[i]] ..., normal[face[i]] ... */
    vec3 *vertex, *normal; /* m; unit vectors */
};

/* Of the bodies at these positions. Returns 0, or EX_SOFTWARE with nothing to free. */
int placed_init(struct placed *s, const struct packing *p, const struct positions *at,
                struct failure *failure);
void placed_free(struct placed *s);

/* How many cores a body has, and one of them */
int32_t placed_cores(const struct placed *s, int64_t i);
struct core placed_core(const struct placed *s, int64_t i, int32_t k);

#endif
