/*
 * shape/core.h: convex cores: grains are made of them, as all points within `round` of a core. A ball
 * is a point, a clump several of them, a capsule a segment, a hull a polygon or a polyhedron.
 */
#ifndef NSD_CORE_H
#define NSD_CORE_H

#include "shape/shape.h"

struct core {
    int32_t n;                /* vertices */
    const vec3 *v;            /* [n] m */
    const vec3 *normal;       /* unit normals of a hull's faces, in the plane of its sides */
    const struct shape *hull; /* its faces and edges; NULL: a point or a segment */
    double round;             /* m */
    vec3 centre;              /* m: a point inside */
};

/* m: the largest n . v over the core's vertices */
static inline double core_top(const struct core *c, vec3 n)
{
    double most = v3_dot(n, c->v[0]);
    for (int32_t i = 1; i < c->n; i++) {
        double at = v3_dot(n, c->v[i]);
        most = at > most ? at : most;
    }
    return most;
}
static inline double core_bottom(const struct core *c, vec3 n)
{
    double least = v3_dot(n, c->v[0]);
    for (int32_t i = 1; i < c->n; i++) {
        double at = v3_dot(n, c->v[i]);
        least = at < least ? at : least;
    }
    return least;
}

#endif
