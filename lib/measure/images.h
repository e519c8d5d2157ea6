/* measure/images.h: where the cell repeats, the images of a body, and the shortest of all ways. */
#ifndef NSD_IMAGES_H
#define NSD_IMAGES_H

#include "bodies/cell.h"

/* A cell, and the inverse of its edges; an edge that does not repeat is taken upright to the others. */
struct images {
    const struct cell *cell;
    bool any;        /* does any edge repeat? */
    vec3 edge[3];    /* m */
    vec3 inverse[3]; /* 1/m: x counts inverse[k] . (x - origin) edges */
    double volume;   /* m^3, m^2: what the edges that repeat span, times 1 m along the others */
};

/* Returns images. */
const struct images *images_of(struct images *images, const struct cell *cell, int dim);
/* m: the shortest way of all that differ by edges, where edges are not much oblique */
vec3 images_shortest(const struct images *images, vec3 way);
/* m/s: the velocity of the cell's flow at x: what the rates of its edges make of a uniform flow */
vec3 images_flow(const struct images *images, vec3 x);

#endif
