/*
 * contact/grid.h: bodies sorted by size into levels of a factor of two, those of each level into the
 * cells of a grid of its own. Cells are hashed, so that a body far away costs nothing.
 */
#pragma once

#include "state/packing.h"

enum {
    LEVELS = 40 /* grids, so radii down to 2^-40 of the largest; smaller ones share the last */
};

struct grid_entry {
    vec3 x;          /* m: of the body */
    double r;        /* m: its radius */
    int32_t cell[3]; /* its cell along x, y, z */
    int32_t body;
};

/* The bodies of one level, radii within a factor of two, hashed by cell. */
struct grid {
    double h;      /* m: a cell's edge: bodies within reach are in the same or adjacent cells */
    int64_t n;     /* bodies */
    uint64_t mask; /* buckets - 1 */
    uint64_t stride[2]; /* of the hash, along y and z; along x it is 1, for locality */
    int64_t *first;     /* [buckets + 1] of bucket b: entry[first[b]] .. entry[first[b + 1] - 1] */
    struct grid_entry *entry; /* [n] sorted by bucket */
};

/* The number of the cell in which a coordinate x (m) lies, of cells h (m) wide */
static inline int32_t grid_cell(double x, double h)
{
    double c = floor(x / h), far = 1e9;
    return (int32_t)(c < -far ? -far : c > far ? far : c);
}

/* The bucket of cell (i, j, k); those of cells along x follow one another. */
static inline uint64_t grid_bucket(const struct grid *g, int64_t i, int64_t j, int64_t k)
{
    return ((uint64_t)i + (uint64_t)j * g->stride[0] + (uint64_t)k * g->stride[1]) & g->mask;
}

/* Sorts the bodies at `at` (m); bodies within reach (m) of each other are then in the same or in
   adjacent cells of the grid of the larger one. g: all zero; false: no memory. To be freed in any case. */
bool grids_build(struct grid g[LEVELS], const struct packing *p, const vec3 *at, double reach);
void grids_free(struct grid *g);
