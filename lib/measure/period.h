/* measure/period.h: where the cell repeats, the images of a body, and the shortest of all ways. */
#ifndef NSD_PERIOD_H
#define NSD_PERIOD_H

#include "shape/cell.h"

/* A cell, and the inverse of its edges; an edge that does not repeat is taken upright to the others. */
struct period {
    const struct cell *cell;
    bool any;        /* does any edge repeat? */
    vec3 edge[3];    /* m */
    vec3 inverse[3]; /* 1/m: x counts inverse[k] . (x - origin) edges */
    double volume;   /* m^3, m^2: what the edges that repeat span, times 1 m along the others */
};

/* Returns period. */
const struct period *period_of(struct period *period, const struct cell *cell);
/* m: the shortest way of all that differ by edges, where edges are not much oblique */
vec3 period_shortest(const struct period *period, vec3 way);
/* m/s: the velocity of the cell's flow at x: what the rates of its edges make of a uniform flow */
vec3 period_flow(const struct period *period, vec3 x);

#endif
