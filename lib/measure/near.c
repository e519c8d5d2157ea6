#include "measure/near.h"

#include "contact/grid.h"

#include <math.h>
#include <stdlib.h>

const struct period *period_of(struct period *m, const struct cell *cell)
{
    const vec3 unit[3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    *m = (struct period){ .cell = cell, .any = cell_repeats(cell), .volume = 1 };
    if (!m->any) return m;
    for (int k = 0; k < 3; k++) m->edge[k] = cell->repeats[k] ? cell->edge[k] : unit[k];
    m->volume = fabs(v3_dot(m->edge[0], v3_cross(m->edge[1], m->edge[2])));
    cell_inverse(m->edge, m->inverse);
    return m;
}

vec3 period_shortest(const struct period *m, vec3 way)
{
    for (int k = 2; m->any && k >= 0; k--)
        if (m->cell->repeats[k]) way = v3_axpy(way, -rint(v3_dot(m->inverse[k], way)), m->edge[k]);
    return way;
}

vec3 period_flow(const struct period *m, vec3 x)
{
    vec3 v = v3(0, 0, 0);
    for (int k = 0; m->any && k < 3; k++)
        if (m->cell->repeats[k])
            v = v3_axpy(v, v3_dot(m->inverse[k], v3_sub(x, m->cell->origin)), m->cell->rate[k]);
    return v;
}

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

bool scatter_add(struct scatter *a, vec3 x, int64_t of)
{
    if (a->n == a->room) {
        int64_t room = 2 * a->room + 1;
        vec3 *more = realloc(a->x, (size_t)room * sizeof *more);
        if (more) a->x = more;
        int64_t *bodies = more ? realloc(a->of, (size_t)room * sizeof *bodies) : NULL;
        if (!bodies) return false;
        a->of = bodies, a->room = room;
    }
    a->x[a->n] = x, a->of[a->n++] = of;
    return true;
}

void scatter_free(struct scatter *a)
{
    free(a->x), free(a->of);
    a->x = NULL, a->of = NULL, a->n = a->room = 0;
}

/* Is x within `reach` of the cell? */
static bool near_is_near(const struct period *m, vec3 x, double reach)
{
    for (int k = 0; k < 3; k++) {
        double at = v3_dot(m->inverse[k], v3_sub(x, m->cell->origin));
        double margin = reach * v3_norm(m->inverse[k]);
        if (m->cell->repeats[k] && !(at > -margin && at < 1 + margin)) return false;
    }
    return true;
}

bool scatter_images(struct scatter *a, const struct period *m, double reach)
{
    int most[3] = { 0, 0, 0 };
    for (int64_t i = 0; i < a->seekers; i++) {
        vec3 d = v3_sub(a->x[i], m->cell->origin);
        for (int k = 0; k < 3; k++)
            if (m->cell->repeats[k])
                a->x[i] = v3_axpy(a->x[i], -floor(v3_dot(m->inverse[k], d)), m->edge[k]);
    }
    for (int k = 0; k < 3; k++)
        if (m->cell->repeats[k]) most[k] = (int)ceil(reach * v3_norm(m->inverse[k]));
    for (int64_t i = 0; i < a->seekers; i++)
        for (int u = -most[0]; u <= most[0]; u++)
            for (int v = -most[1]; v <= most[1]; v++)
                for (int w = -most[2]; w <= most[2]; w++) {
                    if (!u && !v && !w) continue;
                    vec3 x = v3_axpy(a->x[i], u, m->edge[0]);
                    x = v3_axpy(v3_axpy(x, v, m->edge[1]), w, m->edge[2]);
                    if (near_is_near(m, x, reach) && !scatter_add(a, x, a->of[i])) return false;
                }
    return true;
}
