/*
 * draw/walls.h: what a picture shows of the walls: floors as panels, and of all of them the edges where
 * they meet. Walls are endless planes; a region of space makes ends of them.
 */
#ifndef NSD_WALLS_H
#define NSD_WALLS_H

#include "bodies/packing.h"

/* m: a box with its sides along the axes */
struct region {
    vec3 lo, hi;
};

/* Bodies and walls farther out are in no picture: their squares must be numbers. */
#define WALLS_FAR 1e150

enum {
    WALLS_PANELS = 64, /* of more walls the others are left out */
    WALLS_CORNERS = 4 + 6 + WALLS_PANELS,
    WALLS_EDGES = 2048
};

struct panel {
    vec3 n, origin; /* into the bodies' side; a point that travels with the wall */
    int corners;
    vec3 corner[WALLS_CORNERS];
};

struct edge {
    vec3 a, b;
};

struct walls {
    int panels, edges;
    struct panel panel[WALLS_PANELS];
    struct edge edge[WALLS_EDGES];
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
void walls_build(struct walls *, const struct packing *, const struct region *);

#endif
