#include "scene/clump_grid.h"

#include "shape/surface_tree.h"
#include "scene/line_crossings.h"

#include <stdlib.h>
#include <string.h>

enum { INSIDE_LEAST = 200 };

/* Shares of h by which lines pass beside what surfaces have at round numbers */
static const double ASIDE[3] = { 0.4142135623730951, 0.7320508075688772, 0.2360679774997898 };

/* Of the points along an axis (0, 1, 2) those, lo .. hi, that may be in [a, b] (m) */
static void clump_fit_span(const struct clump_grid *g, int axis, double a, double b, int *lo, int *hi)
{
    const double from[3] = { g->origin.x, g->origin.y, g->origin.z };
    const int n = g->n[axis];
    *lo = (int)fmax(0, fmin(n, ceil((a - from[axis]) / g->h)));
    *hi = (int)fmax(-1, fmin(n - 1, floor((b - from[axis]) / g->h)));
}

/* A line's points between where it goes in and where it comes out, all at depth -1 */
static void fill_line(struct clump_grid *g, const struct tunnelling *c, int64_t n)
{
    int within = 0, sum = 0;
    for (int64_t i = 0; i < n; i++) sum += c[i].way;
    if (sum != 0) return; // it has gone through a corner
    for (int64_t i = 0; i + 1 < n; i++) {
        int lo, hi;
        within -= c[i].way;
        if (within < 1) continue;
        clump_fit_span(g, 0, c[i].x, c[i + 1].x, &lo, &hi);
        for (int k = lo; k <= hi; k++) {
            double *at = &g->depth[(int64_t)c[i].line * g->n[0] + k];
            g->inside += *at == 0;
            *at = -1;
        }
    }
}

static int find_inside(struct clump_grid *g, struct failure *failure)
{
    struct crossings t = { 0 };
    const struct lines along_x = { .n = { g->n[1], g->n[2] }, .h = g->h, .origin = g->origin };
    crossings_find(&t, g->mesh, &along_x, failure);
    for (int64_t i = 0, end; i < t.n && !failure->status; i = end) {
        for (end = i; end < t.n && t.c[end].line == t.c[i].line;) end++;
        fill_line(g, t.c + i, end - i);
    }
    crossings_free(&t);
    if (!failure->status && g->inside < INSIDE_LEAST)
        failure_set(failure, EX_DATAERR, "is too thin for balls: %lld points of a grid of %d are within it",
                (long long)g->inside, CLUMP_GRID);
    return failure->status;
}

double clump_grid_distance(const struct clump_grid *g, vec3 c, double most)
{
    const struct surface *s = &g->surface;
    struct surface_walk walk;
    struct surface_branch leaf;
    surface_walk_begin(&walk, s->n);
    while (surface_walk_next(&walk, s->box, c, most, &leaf))
        for (int32_t i = leaf.lo; i < leaf.hi; i++)
            most = fmin(most, v3_norm(v3_sub(c, surface_nearest(s, s->order[i], c))));
    return most;
}

/* The distances of those within; that of the point before bounds the next one's. */
static void find_depths(struct clump_grid *g, double extent)
{
    double last = extent;
    for (int64_t k = 0; k < g->points; k++) {
        if (g->depth[k] == 0) continue;
        bool beside = k % g->n[0] && g->depth[k - 1] != 0;
        g->depth[k] = last = clump_grid_distance(g, clump_grid_at(g, k),
                                                 beside ? (last + g->h) * (1 + 1e-9) : 2 * extent);
    }
}

int clump_grid_init(struct clump_grid *g, const struct mesh *m, struct failure *failure)
{
    vec3 lo = v3(INFINITY, INFINITY, INFINITY), hi = v3_scale(-1, lo);
    *g = (struct clump_grid){ .mesh = m };
    for (int32_t i = 0; i < m->elements; i++)
        for (int k = 0; k < 3; k++) {
            lo = v3_min(lo, m->vertex[m->element[i][k]]);
            hi = v3_max(hi, m->vertex[m->element[i][k]]);
        }
    const vec3 d = v3_sub(hi, lo);
    const double extent = fmax(d.x, fmax(d.y, d.z));
    if (!(extent > 0 && isfinite(extent))) return failure_set(failure, EX_DATAERR, "has no extent");
    g->h = extent / CLUMP_GRID;
    g->n[0] = (int)(d.x / g->h) + 1, g->n[1] = (int)(d.y / g->h) + 1,
    g->n[2] = (int)(d.z / g->h) + 1;
    g->origin = v3(lo.x + ASIDE[0] * g->h, lo.y + ASIDE[1] * g->h, lo.z + ASIDE[2] * g->h);
    g->points = (int64_t)g->n[0] * g->n[1] * g->n[2];
    g->depth = calloc((size_t)g->points, sizeof *g->depth);
    if (!g->depth) return failure_set(failure, EX_SOFTWARE, "no memory for a clump");
    if (surface_init(&g->surface, m, 0, m->elements, 0, failure) || find_inside(g, failure))
        return failure->status;
    find_depths(g, v3_norm(d));
    return 0;
}

void clump_grid_free(struct clump_grid *g)
{
    free(g->depth);
    surface_free(&g->surface);
    *g = (struct clump_grid){ 0 };
}
