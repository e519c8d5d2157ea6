/*
 * draw/walls.h: what a picture shows of the walls: floors as panels, for planes the edges where
 * they meet, for other shapes their outlines [draw/outline.h]. Planes are infinite; they are cut off at
 * a region of space.
 */
#pragma once

#include "state/packing.h"

/* m: a box with its sides along the axes */
struct extent {
    vec3 lo, hi;
};

/* m: bodies and walls farther out than this are not drawn, so that squares stay finite. */
#define WALLS_FAR 1e150

enum {
    WALLS_PANELS = 64,                    /* walls beyond this number are not drawn */
    WALLS_CORNERS = 4 + 6 + WALLS_PANELS, /* a square, cut by the region and by every wall */
    WALLS_EDGES = 8192                    /* edges beyond this number are not drawn */
};

struct panel {
    vec3 n, origin; /* normal, towards the bodies; m: a point that moves with the wall */
    int corners;
    vec3 corner[WALLS_CORNERS]; /* m */
};

struct edge {
    vec3 a, b; /* its ends, m; in a raster samples */
};

#define WALLS_FLAT   0.5  /* the cosine of the steepest floor */
#define WALLS_FACING 1e-3 /* the cosine between a floor and the line of sight, where it is seen */

struct walls {
    int panels, edges;
    struct panel panel[WALLS_PANELS];
    struct edge edge[WALLS_EDGES];
};

/*
 * r = the region to draw: that of the bodies, extended to walls across an axis where these are
 * near, else by a margin; without bodies, the space between the walls. False if there are neither.
 */
bool region_of(struct extent *r, const struct packing *p);
/* The same, but for what of the finite walls is far from the bodies, which would make these small */
bool region_near(struct extent *r, const struct packing *p);
/* Cuts a line at the sides of a box, to rounding; false: nothing of it is inside. */
bool extent_clip(const struct extent *r, vec3 *a, vec3 *b);
/* The unit vector against gravity; without gravity z, in the plane y */
vec3 walls_up(const struct packing *p);
/* The smallest region that holds both */
struct extent region_join(struct extent a, struct extent b);

/* b = the walls inside the region at the packing's time. In the plane walls are edges. */
void walls_build(struct walls *b, const struct packing *p, const struct extent *r);

/* Whether wall i is drawn as a floor where it is seen from `toward` (unit vector to the viewer) */
bool walls_floor(const struct packing *p, int i, vec3 toward);

/* corner[] = the corners (m) of wall i inside the region and before all other walls, at most
   WALLS_CORNERS, two in the plane; returns how many. i < WALLS_PANELS. */
int walls_polygon(const struct packing *p, int i, const struct extent *r, vec3 *corner);
