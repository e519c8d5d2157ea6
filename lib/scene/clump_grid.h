/*
 * scene/clump_grid.h: a grid of points over a closed surface: which are within it, and how far the surface is from
 * each of those.
 */
#ifndef NSD_CLUMP_GRID_H
#define NSD_CLUMP_GRID_H

#include "shape/mesh.h"

enum { CLUMP_GRID = 64 /* points along the longest side */ };

struct clump_grid {
    const struct mesh *mesh;
    struct surface surface;
    int n[3];
    int64_t points, inside; /* all; those within */
    double h;               /* m: between points */
    vec3 origin;            /* m: the first point */
    double *depth;          /* [points] m: to the surface; 0: outside */
};

/* Returns 0, EX_DATAERR where the surface has too little within it, or EX_SOFTWARE; clump_grid_free in any case. */
int clump_grid_init(struct clump_grid *g, const struct mesh *m, struct failure *failure);
void clump_grid_free(struct clump_grid *g);

static inline vec3 clump_grid_at(const struct clump_grid *g, int64_t k)
{
    const int64_t i = k % g->n[0], j = k / g->n[0] % g->n[1], l = k / g->n[0] / g->n[1];
    return v3(g->origin.x + (double)i * g->h, g->origin.y + (double)j * g->h,
              g->origin.z + (double)l * g->h);
}

/* m: from c to the surface, of which is known that it is no more than `most` */
double clump_grid_distance(const struct clump_grid *g, vec3 c, double most);

#endif
