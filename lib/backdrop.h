/*
 * backdrop.h: what a picture shows of the walls: floors as faces, and of all of them the edges where
 * they meet. Walls are endless planes; a region of space makes ends of them.
 */
#ifndef NSD_BACKDROP_H
#define NSD_BACKDROP_H

#include "packing.h"

/* m: a box with its sides along the axes */
struct region {
    vec3 lo, hi;
};

/* Bodies and walls farther out are in no picture: their squares must be numbers. */
#define BACKDROP_FAR 1e150

enum {
    BACKDROP_WALLS = 64, /* of more walls the others are left out */
    BACKDROP_CORNERS = 4 + 6 + BACKDROP_WALLS,
    BACKDROP_EDGES = 2048
};

struct face {
    vec3 n, origin; /* into the bodies' side; a point that travels with the wall */
    int corners;
    vec3 corner[BACKDROP_CORNERS];
};

struct edge {
    vec3 a, b;
};

struct backdrop {
    int faces, edges;
    struct face face[BACKDROP_WALLS];
    struct edge edge[BACKDROP_EDGES];
};

/*
 * What is worth seeing of a packing: its bodies, with the walls beside them where these are near and
 * across an axis, else with a margin. Without bodies, the space between the walls. Returns false
 * where there is neither.
 */
bool region_of(struct region *, const struct packing *);
/* The smallest region that holds both. */
struct region region_join(struct region, struct region);

/* The walls inside of the region at the packing's time. In the plane they are edges themselves. */
void backdrop_build(struct backdrop *, const struct packing *, const struct region *);

#endif
