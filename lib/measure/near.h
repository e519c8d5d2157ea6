/* measure/near.h: points sorted into cells, so that those near a point are found at once. */
#pragma once

#include "base/vec.h"
#include "shape/cell.h"

#include <stdbool.h>
#include <stdint.h>

/* Where the cell repeats, the images of a body, and the shortest of all ways. */

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

struct near_point {
    vec3 x;
    int32_t cell[3];
    int64_t of; /* its place in the x that were sorted */
};

/* Cells are hashed: a point far away costs nothing. */
struct near {
    double reach; /* m: the width of a cell */
    int64_t n, buckets;
    struct near_point *point; /* [n] by buckets */
    int64_t *first;           /* [buckets + 1] */
};

/* Sorts x[n] (m); reach > 0. False when memory is short. */
bool near_init(struct near *g, const vec3 *x, int64_t n, double reach);
void near_free(struct near *g);
/*
 * Adds to count[bins] the points at distances from x of 0 < d < reach, by bins of the same width; of
 * the same place none. Returns how many it has looked at.
 */
int64_t near_count(const struct near *g, vec3 x, int64_t *count, int64_t bins);

enum { NEAREST_MOST = 16 };
/*
 * The points nearest to x at 0 < d < reach, the nearest first, of two as near the first in x[]: of[found], their
 * places there; found <= most <= NEAREST_MOST. Adds to *looked how many it has looked at.
 */
int near_nearest(const struct near *g, vec3 x, int most, int64_t *of, int64_t *looked);

/* The centres of bodies as points, and in a periodic cell images of them. */

struct scatter {
    int64_t n, seekers, room; /* the first of x are the bodies, others images */
    vec3 *x;                  /* [n] m */
    int64_t *of;              /* [n] the body that each is, or is an image of */
    double size[3]; /* m: of the window along axes that do not repeat; INFINITY: it repeats */
    double volume;  /* m^3, m^2: of the window */
};

/* Appends a point; false when memory is short. */
bool scatter_add(struct scatter *a, vec3 x, int64_t of);
/* Brings the first `seekers` into the cell, and appends all their images within `reach` (m) of it; false when memory is
   short. */
bool scatter_images(struct scatter *a, const struct period *m, double reach);
void scatter_free(struct scatter *a);
