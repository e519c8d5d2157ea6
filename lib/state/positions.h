/* state/positions.h: where bodies, the cell's edges and boundaries are when contacts are sought. */
#ifndef NSD_POSITIONS_H
#define NSD_POSITIONS_H

#include "state/packing.h"

struct positions {
    const vec3 *x; /* [p->n] m: the bodies' centres */
    const quat *q; /* [p->n] how shaped bodies are turned */
    vec3 edge[3];  /* m: of the cell */
    double t;      /* s: at which boundaries are placed */
};

/* Of a packing at its time; borrows its arrays. */
static inline struct positions positions_now(const struct packing *p)
{
    const vec3 *e = p->cell.edge;
    return (struct positions){ .x = p->x, .q = p->q, .edge = { e[0], e[1], e[2] }, .t = p->t };
}

#endif
