/* state/placement.h: where bodies, the cell's edges and walls are when contacts are sought. */
#pragma once

#include "shape/shape.h"
#include "state/contact.h"
#include "state/packing.h"

struct positions {
    const vec3 *x; /* [p->n] m: the bodies' centres */
    const quat *q; /* [p->n] how shaped bodies are turned */
    vec3 edge[3];  /* m: of the cell */
    double t;      /* s: at which walls are placed */
};

/* Of a packing at its time; borrows its arrays. */
static inline struct positions positions_now(const struct packing *p)
{
    const vec3 *e = p->cell.edge;
    return (struct positions){ .x = p->x, .q = p->q, .edge = { e[0], e[1], e[2] }, .t = p->t };
}

/*
 * Shaped bodies where contacts are sought: the corners of all in space, and the
 * normals of hulls. Made once for a search; a body is then its cores [shape/shape.h], a clump one for
 * each of its balls, all other bodies one.
 */

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
/* Body i has moved to x[i], turned by q. */
void placed_turn(struct placed *s, int64_t i, quat q);

/* How many cores a body has, and one of them */
int32_t placed_cores(const struct placed *s, int64_t i);
struct core placed_core(const struct placed *s, int64_t i, int32_t k);

/*
 * A packing whose cell repeats is brought back into the cell. Bodies that have left it
 * are replaced by their images in it, with the velocity that images have, and edges that lean too
 * far by others of the same lattice. Nothing else changes: it is the same packing in other words.
 */

/*
 * A step begins with it; bodies then stay where they are until the next, so that at the end of a step
 * they may lie outside of the cell by the step's way. The shifts of the contacts follow; their
 * points do not. s: NULL, there are none. Does nothing where nothing repeats.
 */
void packing_wrap(struct packing *p, struct contacts *s);
