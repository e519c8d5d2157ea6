/* contact/grid.c: bodies sorted by level and cell [contact/grid.h]. */
#include "contact/grid.h"

#include <stdlib.h>

static int grid_level_of(double r, double rmax)
{
    int level = ilogb(rmax / r);
    return level < LEVELS ? level : LEVELS - 1;
}

/* Strides that number the cells of the bodies' bounding box one by one. */
static void grid_strides(struct grid *g, const int32_t lo[3], const int32_t hi[3])
{
    uint64_t nx = (uint64_t)((int64_t)hi[0] - lo[0] + 3);
    uint64_t ny = (uint64_t)((int64_t)hi[1] - lo[1] + 3);
    g->stride[0] = nx;
    g->stride[1] = nx * ny;
}

/* Sorts g->entry, cells set, by bucket: a counting sort. */
static bool grid_sort(struct grid *g)
{
    uint64_t buckets = 4;
    while (buckets < 2 * (uint64_t)g->n) buckets *= 2;
    g->mask = buckets - 1;
    struct grid_entry *sorted = malloc((size_t)g->n * sizeof *sorted);
    g->first = calloc(buckets + 2, sizeof *g->first);
    if (!sorted || !g->first) {
        free(sorted);
        return false;
    }
    for (int64_t i = 0; i < g->n; i++) { // counts two ahead: after the fill, b starts at first[b]
        const int32_t *c = g->entry[i].cell;
        g->first[grid_bucket(g, c[0], c[1], c[2]) + 2]++;
    }
    for (uint64_t b = 0; b < buckets; b++) g->first[b + 2] += g->first[b + 1];
    for (int64_t i = 0; i < g->n; i++) {
        const int32_t *c = g->entry[i].cell;
        sorted[g->first[grid_bucket(g, c[0], c[1], c[2]) + 1]++] = g->entry[i];
    }
    free(g->entry);
    g->entry = sorted;
    return true;
}

void grids_free(struct grid *g)
{
    for (int l = 0; l < LEVELS; l++) free(g[l].first), free(g[l].entry);
}

bool grids_build(struct grid g[LEVELS], const struct packing *p, const vec3 *at, double reach)
{
    double rmax = 0, top[LEVELS] = { 0 };
    for (int64_t i = 0; i < p->n; i++) rmax = dmax(rmax, p->radius[i]);
    for (int64_t i = 0; i < p->n; i++) {
        int l = grid_level_of(p->radius[i], rmax);
        g[l].n++;
        top[l] = dmax(top[l], p->radius[i]);
    }
    int32_t lo[LEVELS][3], hi[LEVELS][3];
    for (int l = 0; l < LEVELS; l++) {
        if (!g[l].n) continue;
        g[l].h = (2 * top[l] + reach) * (1 + 1e-12);
        if (!(g[l].entry = malloc((size_t)g[l].n * sizeof *g[l].entry))) return false;
        for (int k = 0; k < 3; k++) lo[l][k] = INT32_MAX, hi[l][k] = INT32_MIN;
        g[l].n = 0;
    }
    for (int64_t i = 0; i < p->n; i++) {
        int l = grid_level_of(p->radius[i], rmax);
        struct grid_entry *e = &g[l].entry[g[l].n++];
        *e = (struct grid_entry){ at[i], p->radius[i], { 0 }, (int32_t)i };
        const double x[3] = { e->x.x, e->x.y, e->x.z };
        for (int k = 0; k < 3; k++) {
            int32_t c = e->cell[k] = grid_cell(x[k], g[l].h);
            if (c < lo[l][k]) lo[l][k] = c;
            if (c > hi[l][k]) hi[l][k] = c;
        }
    }
    for (int l = 0; l < LEVELS; l++) {
        if (!g[l].n) continue;
        grid_strides(&g[l], lo[l], hi[l]);
        if (!grid_sort(&g[l])) return false;
    }
    return true;
}
