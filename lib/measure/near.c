#include "measure/near.h"

#include "contact/grid.h"

#include <math.h>
#include <stdlib.h>

/* Cells along x are in buckets one after another, so that a line of them is looked along at once. */
static int64_t near_bucket(const struct near *g, int64_t i, int64_t j, int64_t k)
{
    uint64_t h =
        (uint64_t)i + (uint64_t)j * 0x9E3779B97F4A7C15u + (uint64_t)k * 0xC2B2AE3D27D4EB4Fu;
    return (int64_t)(h & ((uint64_t)g->buckets - 1));
}

static int64_t bucket_of(const struct near *g, const struct near_point *p)
{
    return near_bucket(g, p->cell[0], p->cell[1], p->cell[2]);
}

bool near_init(struct near *g, const vec3 *x, int64_t n, double reach)
{
    *g = (struct near){ .reach = reach, .n = n, .buckets = 64 };
    while (g->buckets < n) g->buckets *= 2;
    struct near_point *point = calloc((size_t)n + 1, sizeof *point);
    g->point = calloc((size_t)n + 1, sizeof *g->point);
    g->first = calloc((size_t)g->buckets + 2, sizeof *g->first);
    if (!point || !g->point || !g->first) {
        free(point);
        return false;
    }
    for (int64_t i = 0; i < n; i++) {
        const double at[3] = { x[i].x, x[i].y, x[i].z };
        point[i].x = x[i], point[i].of = i;
        for (int k = 0; k < 3; k++) point[i].cell[k] = grid_cell(at[k], reach);
        g->first[bucket_of(g, &point[i]) + 2]++;
    }
    for (int64_t b = 0; b < g->buckets; b++) g->first[b + 2] += g->first[b + 1];
    for (int64_t i = 0; i < n; i++) g->point[g->first[bucket_of(g, &point[i]) + 1]++] = point[i];
    free(point);
    return true;
}

void near_free(struct near *g)
{
    free(g->point), free(g->first);
}

static void count_cell(const struct near *g, int64_t b, const int64_t cell[3], vec3 x,
                       int64_t *count, int64_t bins)
{
    double most = g->reach * g->reach, scale = (double)bins / g->reach;
    for (int64_t i = g->first[b]; i < g->first[b + 1]; i++) {
        const struct near_point *p = &g->point[i];
        vec3 d = v3_sub(p->x, x);
        double d2 = v3_dot(d, d);
        if (!(d2 < most && d2 > 0)) continue;
        if (p->cell[0] != cell[0] || p->cell[1] != cell[1] || p->cell[2] != cell[2]) continue;
        int64_t bin = (int64_t)(sqrt(d2) * scale);
        count[bin < bins ? bin : bins - 1]++;
    }
}

int64_t near_count(const struct near *g, vec3 x, int64_t *count, int64_t bins)
{
    const int64_t c[3] = { grid_cell(x.x, g->reach), grid_cell(x.y, g->reach),
                           grid_cell(x.z, g->reach) };
    int64_t looked = 0;
    for (int64_t k = c[2] - 1; k <= c[2] + 1; k++)
        for (int64_t j = c[1] - 1; j <= c[1] + 1; j++)
            for (int64_t i = c[0] - 1; i <= c[0] + 1; i++) {
                int64_t b = near_bucket(g, i, j, k), cell[3] = { i, j, k };
                looked += g->first[b + 1] - g->first[b];
                count_cell(g, b, cell, x, count, bins);
            }
    return looked;
}

/* What has been found so far, the nearest first */
struct near_nearest {
    int n, most;
    double d2[NEAREST_MOST]; /* m^2 */
    int64_t of[NEAREST_MOST];
};

static void keep_nearest(struct near_nearest *s, double d2, int64_t of)
{
    int k = s->n;
    if (k == s->most && !(d2 < s->d2[k - 1] || (d2 == s->d2[k - 1] && of < s->of[k - 1]))) return;
    if (k == s->most) k--;
    for (; k > 0 && (d2 < s->d2[k - 1] || (d2 == s->d2[k - 1] && of < s->of[k - 1])); k--)
        s->d2[k] = s->d2[k - 1], s->of[k] = s->of[k - 1];
    s->d2[k] = d2, s->of[k] = of;
    if (s->n < s->most) s->n++;
}

int near_nearest(const struct near *g, vec3 x, int most, int64_t *of, int64_t *looked)
{
    const int64_t c[3] = { grid_cell(x.x, g->reach), grid_cell(x.y, g->reach),
                           grid_cell(x.z, g->reach) };
    struct near_nearest s = { .most = most };
    for (int64_t l = 0; l < 27; l++) {
        const int64_t cell[3] = { c[0] + l % 3 - 1, c[1] + l / 3 % 3 - 1, c[2] + l / 9 - 1 };
        const int64_t b = near_bucket(g, cell[0], cell[1], cell[2]);
        *looked += g->first[b + 1] - g->first[b];
        for (int64_t i = g->first[b]; i < g->first[b + 1]; i++) {
            const struct near_point *p = &g->point[i];
            const vec3 d = v3_sub(p->x, x);
            const double d2 = v3_dot(d, d);
            if (!(d2 < g->reach * g->reach && d2 > 0)) continue;
            if (p->cell[0] == cell[0] && p->cell[1] == cell[1] && p->cell[2] == cell[2])
                keep_nearest(&s, d2, p->of);
        }
    }
    for (int k = 0; k < s.n; k++) of[k] = s.of[k];
    return s.n;
}
