#include "scene/clump_fit.h"

#include "scene/line_crossings.h"
#include "scene/surface_parts.h"
#include "shape/mesh.h"

#include <stdlib.h>
#include <string.h>

/*
 * A grid of points over a closed surface: which are within it, and how far the surface is from
 * each of those.
 */

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
static int clump_grid_init(struct clump_grid *g, const struct mesh *m, struct failure *failure);
static void clump_grid_free(struct clump_grid *g);

static inline vec3 clump_grid_at(const struct clump_grid *g, int64_t k)
{
    const int64_t i = k % g->n[0], j = k / g->n[0] % g->n[1], l = k / g->n[0] / g->n[1];
    return v3(g->origin.x + (double)i * g->h, g->origin.y + (double)j * g->h,
              g->origin.z + (double)l * g->h);
}

/* m: from c to the surface, of which is known that it is no more than `most` */
static double clump_grid_distance(const struct clump_grid *g, vec3 c, double most);

enum { INSIDE_LEAST = 200 };

/* Shares of h by which lines pass beside what surfaces have at round numbers */
static const double ASIDE[3] = { 0.4142135623730951, 0.7320508075688772, 0.2360679774997898 };

/* Of the points along an axis (0, 1, 2) those, lo .. hi, that may be in [a, b] (m) */
static void clump_fit_span(const struct clump_grid *g, int axis, double a, double b, int *lo,
                           int *hi)
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
        failure_set(failure, EX_DATAERR,
                    "is too thin for balls: %lld points of a grid of %d are within it",
                    (long long)g->inside, CLUMP_GRID);
    return failure->status;
}

static double clump_grid_distance(const struct clump_grid *g, vec3 c, double most)
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

static int clump_grid_init(struct clump_grid *g, const struct mesh *m, struct failure *failure)
{
    vec3 lo, hi;
    *g = (struct clump_grid){ .mesh = m };
    mesh_box(m, &lo, &hi);
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

static void clump_grid_free(struct clump_grid *g)
{
    free(g->depth);
    surface_free(&g->surface);
    *g = (struct clump_grid){ 0 };
}

enum {
    SAMPLES_MOST = 100000, /* places of the surface by which the distance is judged */
    DIRECTIONS = 200,      /* places of each ball */
    CLIMBS = 20,           /* steps by which a ball moves from its point of the grid, at most */
    ROUNDS = 3,            /* of Newton for the volume: 1e-5 is left, */
    ROUNDS_MORE = 40       /* or, where the balls grow much, of a search between bounds */
};

/* A clump that is farther from the surface stands for another body: of its volume, and as in struct clump_errors. One ball
   for a cube has moments 0.04 and a distance of 0.28; balls that leave out a part have 0.5 and more. */
static const double VOLUME_MOST = 1e-3, MOMENTS_MOST = 0.15, DISTANCE_MOST = 0.4;

struct fit {
    struct clump_grid grid;
    const struct mesh *mesh;
    double reach; /* m: of the ball around the surface */
    int64_t samples;
    vec3 *sample;           /* [samples] places of the surface, */
    double *gap;            /* m: and how far each is from the nearest ball */
    double *field, *sorted; /* [points] m: of all points of the grid */
    bool *covered;          /* [points] */
    int32_t balls;
    vec3 *centre;   /* [balls] m */
    double *radius; /* [balls] m */
};

/* ---- the surface ---- */

/* By the divergence theorem; the triangles as a shape of its own, of which nothing else is asked */
static int clump_fit_moments_of(struct solid *out, const struct mesh *m, struct failure *failure)
{
    struct shape s = { 0 };
    if (shape_alloc(&s, m->vertices, m->elements, 3 * m->elements, failure)) return failure->status;
    s.form = SHAPE_HULL;
    memcpy(s.vertex, m->vertex, (size_t)m->vertices * sizeof *s.vertex);
    for (int32_t i = 0; i < 3 * m->elements; i++) s.corner[i] = m->element[i / 3][i % 3];
    for (int32_t f = 0; f <= m->elements; f++) s.first[f] = 3 * f;
    solid_of(out, &s, 3, failure);
    shape_free(&s);
    if (failure->status) return failure->status;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < i; j++) out->second[i][j] = out->second[j][i]; // to the last bit
    if (out->volume < 0)
        return failure_set(failure, EX_DATAERR, "is turned inside out: turn its faces outward");
    return out->volume > 0 && v3_finite(out->centre)
               ? 0
               : failure_set(failure, EX_DATAERR, "has no volume");
}

static double clump_fit_area_of(const struct mesh *m)
{
    double sum = 0;
    for (int32_t i = 0; i < m->elements; i++) {
        const int32_t *c = m->element[i];
        sum += v3_norm(v3_cross(v3_sub(m->vertex[c[1]], m->vertex[c[0]]),
                                v3_sub(m->vertex[c[2]], m->vertex[c[0]]))) /
               2;
    }
    return sum;
}

/* Places on each triangle, apart by a distance that gives SAMPLES_MOST at most; its corners among them */
static int sample_surface(struct fit *f, struct failure *failure)
{
    const double apart = fmax(f->grid.h, sqrt(2 * clump_fit_area_of(f->mesh) / SAMPLES_MOST));
    const int64_t room = SAMPLES_MOST + (int64_t)6 * f->mesh->elements;
    f->sample = malloc((size_t)room * sizeof *f->sample);
    f->gap = malloc((size_t)room * sizeof *f->gap);
    if (!f->sample || !f->gap) return failure_set(failure, EX_SOFTWARE, "no memory for a clump");
    for (int32_t e = 0; e < f->mesh->elements; e++) {
        const int32_t *c = f->mesh->element[e];
        const vec3 a = f->mesh->vertex[c[0]], u = v3_sub(f->mesh->vertex[c[1]], a),
                   v = v3_sub(f->mesh->vertex[c[2]], a);
        const double longest = fmax(v3_norm(u), fmax(v3_norm(v), v3_norm(v3_sub(u, v))));
        const int n = (int)fmin(1000, ceil(longest / apart));
        for (int i = 0; i <= n; i++)
            for (int j = 0; i + j <= n && f->samples < room; j++)
                f->sample[f->samples++] = v3_axpy(v3_axpy(a, (double)i / n, u), (double)j / n, v);
    }
    for (int64_t k = 0; k < f->samples; k++) f->gap[k] = INFINITY;
    return 0;
}

/* ---- the choice ---- */

/* A point of the grid whose ball would fill at most `gain` points; counted when there were so many balls */
struct candidate {
    double gain;
    int64_t point;
    int32_t counted;
};

static bool is_better(const struct candidate *a, const struct candidate *b)
{
    return a->gain != b->gain ? a->gain > b->gain : a->point < b->point;
}

static void clump_fit_sift(struct candidate *heap, int64_t n, int64_t k)
{
    for (int64_t child; (child = 2 * k + 1) < n; k = child) {
        if (child + 1 < n && is_better(&heap[child + 1], &heap[child])) child++;
        if (!is_better(&heap[child], &heap[k])) return;
        const struct candidate c = heap[k];
        heap[k] = heap[child], heap[child] = c;
    }
}

/* Points of the grid within a ball that no ball has filled; they are filled where `fill` */
static int64_t clump_fit_count(const struct fit *f, vec3 c, double r, bool fill)
{
    const struct clump_grid *g = &f->grid;
    int64_t n = 0;
    int lo[3], hi[3];
    const double at[3] = { c.x - g->origin.x, c.y - g->origin.y, c.z - g->origin.z };
    for (int k = 0; k < 3; k++) {
        lo[k] = (int)fmax(0, ceil((at[k] - r) / g->h));
        hi[k] = (int)fmin(g->n[k] - 1, floor((at[k] + r) / g->h));
    }
    for (int k = lo[2]; k <= hi[2]; k++)
        for (int j = lo[1]; j <= hi[1]; j++) {
            const double y = j * g->h - at[1], z = k * g->h - at[2], x2 = r * r - y * y - z * z;
            if (x2 < 0) continue;
            const int64_t row = ((int64_t)k * g->n[1] + j) * g->n[0];
            const int from = (int)fmax(0, ceil((at[0] - sqrt(x2)) / g->h)),
                      to = (int)fmin(g->n[0] - 1, floor((at[0] + sqrt(x2)) / g->h));
            for (int i = from; i <= to; i++) {
                n += !f->covered[row + i];
                if (fill) f->covered[row + i] = true;
            }
        }
    return n;
}

/* The largest ball that touches from within near the point: by steps that halve, no farther than h */
static vec3 climb(const struct fit *f, vec3 c, double *r)
{
    const vec3 from = c;
    double step = f->grid.h / 2;
    for (int k = 0; k < CLIMBS && step > f->grid.h / 32; k++) {
        bool better = false;
        for (int way = 0; way < 6 && !better; way++) {
            const double s = way & 1 ? step : -step;
            const vec3 to =
                v3_add(c, v3(way / 2 == 0 ? s : 0, way / 2 == 1 ? s : 0, way / 2 == 2 ? s : 0));
            // within the ball: not through the surface
            if (v3_norm(v3_sub(to, from)) > f->grid.h || step >= *r) continue;
            const double d = clump_grid_distance(&f->grid, to, *r + 2 * step);
            if (d > *r * (1 + 1e-9)) c = to, *r = d, better = true;
        }
        if (!better) step /= 2;
    }
    return c;
}

/* One more ball, unless it fills nothing */
static bool clump_fit_take(struct fit *f, vec3 c, double r)
{
    if (!clump_fit_count(f, c, r, true)) return false;
    f->centre[f->balls] = c, f->radius[f->balls++] = r;
    for (int64_t k = 0; k < f->samples; k++)
        f->gap[k] = fmin(f->gap[k], v3_norm(v3_sub(f->sample[k], c)) - r);
    for (int64_t k = 0; k < f->grid.points; k++)
        f->field[k] = fmin(f->field[k], v3_norm(v3_sub(clump_grid_at(&f->grid, k), c)) - r);
    return true;
}

static int clump_fit_by_value(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

/* m: by which radii have to grow so that as many points of the grid are in balls as are within the surface */
static double growth_of(struct fit *f)
{
    memcpy(f->sorted, f->field, (size_t)f->grid.points * sizeof *f->sorted);
    qsort(f->sorted, (size_t)f->grid.points, sizeof *f->sorted, clump_fit_by_value);
    return fmax(0, f->sorted[f->grid.inside - 1]);
}

/* m: from places of the surface to the balls that have grown */
static double clump_fit_farthest(const struct fit *f, double growth)
{
    double most = 0;
    for (int64_t k = 0; k < f->samples; k++) most = fmax(most, fabs(f->gap[k] - growth));
    return most;
}

static int clump_fit_choose(struct fit *f, const struct clump_limits *limits,
                            struct failure *failure)
{
    const struct clump_grid *g = &f->grid;
    struct candidate *heap = malloc((size_t)g->inside * sizeof *heap);
    int64_t n = 0;
    if (!heap) return failure_set(failure, EX_SOFTWARE, "no memory for a clump");
    for (int64_t k = 0; k < g->points; k++) {
        f->field[k] = INFINITY, f->covered[k] = g->depth[k] == 0; // what is outside is no gain
        const double r = g->depth[k] / g->h + 1;
        if (g->depth[k] > 0) heap[n++] = (struct candidate){ 4.2 * r * r * r, k, -1 };
    }
    for (int64_t k = n / 2; k-- > 0;) clump_fit_sift(heap, n, k);
    while (f->balls < limits->balls && n) {
        struct candidate *top = &heap[0];
        vec3 c = clump_grid_at(g, top->point);
        double r = g->depth[top->point];
        if (top->counted != f->balls) {
            top->gain = (double)clump_fit_count(f, c, r, false), top->counted = f->balls;
            clump_fit_sift(heap, n, 0);
            continue;
        }
        if (!(top->gain > 0)) break;
        c = climb(f, c, &r);
        if (!clump_fit_take(f, c, r)) {
            top->gain = 0;
            clump_fit_sift(heap, n, 0);
            continue;
        }
        if (limits->error > 0 && clump_fit_farthest(f, growth_of(f)) <= limits->error * f->reach)
            break;
    }
    free(heap);
    return 0;
}

/* ---- the clump ---- */

static int clump_fit_make_shape(struct shape *s, const struct fit *f, double growth,
                                struct failure *failure)
{
    if (shape_alloc(s, f->balls, 0, 0, failure)) return failure->status;
    s->form = SHAPE_CLUMP;
    for (int32_t i = 0; i < f->balls; i++)
        s->vertex[i] = f->centre[i], s->ball[i] = f->radius[i] + growth;
    return 0;
}

static int set_growth(struct shape *s, struct solid *balls, const struct fit *f, double growth,
                      struct failure *failure)
{
    for (int32_t i = 0; i < f->balls; i++) s->ball[i] = f->radius[i] + growth;
    return solid_of(balls, s, 3, failure);
}

/* Where Newton has not found the volume: between no growth and balls that are larger than the surface */
static int search_growth(struct shape *s, struct solid *balls, const struct fit *f, double volume,
                         struct failure *failure)
{
    double lo = 0, hi = 2 * f->reach, below = 0, above = 0;
    if (set_growth(s, balls, f, hi, failure)) return failure->status;
    above = balls->volume;
    for (int k = 0; k < ROUNDS_MORE && fabs(balls->volume / volume - 1) > 0.1 * VOLUME_MOST; k++) {
        const double share = fmin(0.9, fmax(0.1, (volume - below) / (above - below)));
        const double growth = lo + share * (hi - lo);
        if (set_growth(s, balls, f, growth, failure)) return failure->status;
        *(balls->volume < volume ? &lo : &hi) = growth;
        *(balls->volume < volume ? &below : &above) = balls->volume;
    }
    return 0;
}

/* The radii grow until the balls have the volume; d volume / d growth is about the surface's area. */
static int clump_fit_grow(struct shape *s, struct solid *balls, struct fit *f,
                          const struct solid *of, struct failure *failure)
{
    const double area = clump_fit_area_of(f->mesh);
    double growth = growth_of(f), least = INFINITY;
    for (int32_t i = 0; i < f->balls; i++) least = fmin(least, f->radius[i]);
    if (clump_fit_make_shape(s, f, growth, failure)) return failure->status;
    for (int round = 0; !solid_of(balls, s, 3, failure) && round < ROUNDS; round++) {
        growth = fmax(-0.5 * least, growth + (of->volume - balls->volume) / area);
        for (int32_t i = 0; i < f->balls; i++) s->ball[i] = f->radius[i] + growth;
    }
    if (!failure->status && fabs(balls->volume / of->volume - 1) > VOLUME_MOST)
        search_growth(s, balls, f, of->volume, failure);
    return failure->status;
}

/* The k-th of DIRECTIONS places on the unit sphere, on a spiral */
static vec3 clump_fit_direction(int k)
{
    const double z = 1 - (2 * k + 1) / (double)DIRECTIONS, r = sqrt(1 - z * z);
    const vec3 x = quat_turn(quat_rotation(v3(0, 0, 2.399963229728653 * k)), v3(r, 0, 0));
    return v3(x.x, x.y, z);
}

/* m: the largest distance from places of the surface to the balls, and back */
static double distance_of(const struct fit *f, const struct shape *s)
{
    double most = 0;
    for (int64_t k = 0; k < f->samples; k++) {
        double gap = INFINITY;
        for (int32_t i = 0; i < s->vertices; i++)
            gap = fmin(gap, v3_norm(v3_sub(f->sample[k], s->vertex[i])) - s->ball[i]);
        most = fmax(most, fabs(gap));
    }
    for (int32_t i = 0; i < s->vertices; i++)
        for (int k = 0; k < DIRECTIONS; k++) {
            const vec3 x = v3_axpy(s->vertex[i], s->ball[i], clump_fit_direction(k));
            bool bare = true;
            for (int32_t j = 0; j < s->vertices && bare; j++)
                bare = j == i || v3_norm(v3_sub(x, s->vertex[j])) >= s->ball[j];
            if (bare) most = fmax(most, clump_grid_distance(&f->grid, x, 3 * f->reach));
        }
    return most;
}

static double moments_error(const struct solid *a, const struct solid *of)
{
    const double scale = 1 / (of->second[0][0] + of->second[1][1] + of->second[2][2]);
    double sum = 0;
    const vec3 d = v3_sub(a->centre, of->centre);
    const double shift[3] = { d.x, d.y, d.z };
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double e = a->second[i][j] + a->volume * shift[i] * shift[j] - of->second[i][j];
            sum += e * e;
        }
    return sqrt(sum) * scale;
}

static int clump_fit_prepare(struct fit *f, const struct solid *of, int32_t balls,
                             struct failure *failure)
{
    if (clump_grid_init(&f->grid, f->mesh, failure)) return failure->status;
    for (int32_t e = 0; e < f->mesh->elements; e++)
        for (int k = 0; k < 3; k++)
            f->reach = fmax(f->reach,
                            v3_norm(v3_sub(f->mesh->vertex[f->mesh->element[e][k]], of->centre)));
    f->centre = malloc((size_t)balls * sizeof *f->centre);
    f->radius = calloc((size_t)balls, sizeof *f->radius);
    f->field = malloc((size_t)f->grid.points * sizeof *f->field);
    f->sorted = malloc((size_t)f->grid.points * sizeof *f->sorted);
    f->covered = malloc((size_t)f->grid.points);
    if (!f->centre || !f->radius || !f->field || !f->sorted || !f->covered)
        return failure_set(failure, EX_SOFTWARE, "no memory for a clump");
    return sample_surface(f, failure);
}

static int clump_fit_judge(const struct clump_errors *e, struct failure *failure)
{
    if (fabs(e->volume) <= VOLUME_MOST && e->moments <= MOMENTS_MOST &&
        e->distance <= DISTANCE_MOST)
        return 0;
    return failure_set(
        failure, EX_DATAERR,
        "is not what %d balls fill: volume %+.2g, distance %.2g of the radius around it, "
        "moments %.2g of their sum, and %g, %g, %g are allowed: more balls, or thicker "
        "walls",
        e->balls, e->volume, e->distance, e->moments, VOLUME_MOST, DISTANCE_MOST, MOMENTS_MOST);
}

int clump_fit(struct shape *s, struct solid *of, const struct mesh *m,
              const struct clump_limits *limits, struct clump_errors *errors,
              struct failure *failure)
{
    struct fit f = { .mesh = m };
    struct solid got = { 0 };
    if (mesh_check(m, 3, failure) || mesh_closed(m, failure) ||
        clump_fit_moments_of(of, m, failure) || crossings_judge(m, failure))
        return failure->status;
    if (!clump_fit_prepare(&f, of, limits->balls, failure) &&
        !clump_fit_choose(&f, limits, failure) && !clump_fit_grow(s, &got, &f, of, failure)) {
        *errors = (struct clump_errors){ .balls = f.balls,
                                         .volume = got.volume / of->volume - 1,
                                         .distance = distance_of(&f, s) / f.reach,
                                         .moments = moments_error(&got, of) };
        clump_fit_judge(errors, failure);
    }
    if (failure->status) shape_free(s);
    clump_grid_free(&f.grid);
    free(f.sample), free(f.gap), free(f.field), free(f.sorted), free(f.covered);
    free(f.centre), free(f.radius);
    return failure->status;
}
