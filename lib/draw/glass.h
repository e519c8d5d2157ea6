/*
 * draw/glass.h: boundaries as half-transparent facets, so that a picture shows where they are and what
 * they hold.
 *
 * At a sample, facets in front of what is seen take part k, 0 < k < 1, of its light and give their own:
 * c (1 - T) + seen T, T = product of (1 - k), c the mean of their light with weights k. This does not
 * depend on their order, so none has to be sought.
 */
#ifndef NSD_GLASS_H
#define NSD_GLASS_H

#include "draw/outline.h"
#include "draw/solid.h"
#include "draw/walls.h"

struct facet {
    vec3 corner[3]; /* m */
    vec3 n;         /* its unit normal; both sides look the same */
    struct rgb own; /* its colour where it is solid; r < 0: it is glass */
};

struct glass {
    int64_t facets;
    struct facet *facet;
};

/* Which boundaries are drawn as facets */
struct glass_opt {
    struct extent region;
    vec3 toward;               /* unit vector to the viewer */
    const struct solid_walls *solid; /* those that are solid; NULL: none */
    bool glass;                /* the others, too */
};

/* The boundaries of p inside the region, at p's time, in space; none in the plane. Planes that are drawn
   as floors where the viewer sees them are left out, unless they are solid. Returns 0, or
   EX_SOFTWARE with nothing to free. */
int glass_init(struct glass *g, const struct packing *p, const struct glass_opt *o,
               struct failure *failure);
void glass_free(struct glass *g);

/* The part of the light that a facet takes; z: the cosine between its normal and the line of sight */
static inline float glass_part(double z)
{
    double beside = 1 - fabs(z); // where it is seen edgewise, there is more of it in the way
    return (float)(0.10 + 0.35 * beside * beside * beside);
}

#endif
