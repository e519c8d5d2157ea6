/* contact/situation.h: bodies and boundaries, prepared for a search of contacts. */
#ifndef NSD_SITUATION_H
#define NSD_SITUATION_H

#include "state/placed.h"
#include "shape/mesh.h"

struct situation {
    const struct packing *p;
    const vec3 *x, *edge;          /* [p->n] m; edges of the cell, NULL: it does not repeat */
    double t;                      /* s: of the walls */
    const struct placed *shaped;   /* NULL: all are balls */
    const struct surface *surface; /* [p->walls] of those that are meshes */
};

/* The surface of wall w; NULL: it is no mesh */
static inline const struct surface *situation_surface(const struct situation *o, int32_t w)
{
    return o->p->wall[w].shape == BOUNDARY_MESH ? &o->surface[w] : NULL;
}

#endif
