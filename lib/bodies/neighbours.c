/*
 * bodies/neighbours.c: a hashed grid for each size of body, and how long a list of pairs serves.
 */
#include "bodies/neighbours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    LEVELS = 40,    /* grids, so radii down to 2^-40 of the largest; smaller ones share the last */
    KEEP_STEPS = 8, /* steps that a list is meant to serve, all at the speed of the fastest body */
};
/* What a list may reach further than was asked, in mean radii: */
static const double MIN_SPARE = 0.02, /* when (nearly) nothing moves */
    MAX_SPARE = 0.5;                  /* beyond it a list would be crowded: it serves one step */

struct entry {
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
    uint64_t stride[2];  /* of the hash, along y and z; along x it is 1, for locality */
    int64_t *first;      /* [buckets + 1] of bucket b: entry[first[b]] .. entry[first[b + 1] - 1] */
    struct entry *entry; /* [n] sorted by bucket */
};

void neighbours_free(struct neighbours *s)
{
    free(s->listed), free(s->pair);
    *s = (struct neighbours){ 0 };
}

/* Balls in one place are all each other's neighbours: no heap has so many, whatever its sizes. */
enum {
    CROWD_BODY = 256,     /* pairs a body: a heap has 6, with the widest spare 30 */
    CROWD_LEAST = 1 << 18 /* and pairs that any packing may have: seconds of work */
};

static int64_t crowd(const struct neighbours *s)
{
    return CROWD_LEAST + CROWD_BODY * s->bodies;
}

static bool pairs_add(struct neighbours *s, int32_t a, int32_t b)
{
    if (s->n >= crowd(s)) return false;
    if (s->n == s->room) {
        int64_t room = s->room ? 2 * s->room : 1024;
        struct pair *p = realloc(s->pair, (size_t)room * sizeof *p);
        if (!p) return false;
        s->pair = p, s->room = room;
    }
    s->pair[s->n++] = a < b ? (struct pair){ a, b } : (struct pair){ b, a };
    return true;
}

/* ---- the grids ---- */

static int32_t cell_of(double x, double h)
{
    double c = floor(x / h), far = 1e9;
    return (int32_t)(c < -far ? -far : c > far ? far : c);
}

static uint64_t bucket(const struct grid *g, int64_t i, int64_t j, int64_t k)
{
    return ((uint64_t)i + (uint64_t)j * g->stride[0] + (uint64_t)k * g->stride[1]) & g->mask;
}

static int level_of(double r, double rmax)
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
    struct entry *sorted = malloc((size_t)g->n * sizeof *sorted);
    g->first = calloc(buckets + 2, sizeof *g->first);
    if (!sorted || !g->first) {
        free(sorted);
        return false;
    }
    for (int64_t i = 0; i < g->n; i++) { // counts two ahead: after the fill, b starts at first[b]
        const int32_t *c = g->entry[i].cell;
        g->first[bucket(g, c[0], c[1], c[2]) + 2]++;
    }
    for (uint64_t b = 0; b < buckets; b++) g->first[b + 2] += g->first[b + 1];
    for (int64_t i = 0; i < g->n; i++) {
        const int32_t *c = g->entry[i].cell;
        sorted[g->first[bucket(g, c[0], c[1], c[2]) + 1]++] = g->entry[i];
    }
    free(g->entry);
    g->entry = sorted;
    return true;
}

static void grids_free(struct grid *g)
{
    for (int l = 0; l < LEVELS; l++) free(g[l].first), free(g[l].entry);
}

static bool grids_build(struct grid g[LEVELS], const struct packing *p, const vec3 *at,
                        double reach)
{
    double rmax = 0, top[LEVELS] = { 0 };
    for (int64_t i = 0; i < p->n; i++) rmax = fmax(rmax, p->radius[i]);
    for (int64_t i = 0; i < p->n; i++) {
        int l = level_of(p->radius[i], rmax);
        g[l].n++;
        top[l] = fmax(top[l], p->radius[i]);
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
        int l = level_of(p->radius[i], rmax);
        struct entry *e = &g[l].entry[g[l].n++];
        *e = (struct entry){ at[i], p->radius[i], { 0 }, (int32_t)i };
        const double x[3] = { e->x.x, e->x.y, e->x.z };
        for (int k = 0; k < 3; k++) {
            int32_t c = e->cell[k] = cell_of(x[k], g[l].h);
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

/* ---- the search ---- */

/* A body that looks for others near it */
struct seeker {
    const struct packing *p;
    const struct entry *e; /* the body */
    double reach;          /* m: the largest gap of a pair to list */
    struct neighbours *out;
};

static bool near(const struct seeker *s, const struct entry *f)
{
    vec3 d = v3_sub(f->x, s->e->x);
    double most = s->e->r + f->r + s->reach;
    return v3_dot(d, d) <= most * most * (1 + 1e-12);
}

/* Lists those of entries first .. end-1 that are in cells i0 .. i1 of line (j, k) along x. Returns
   false, as all that look do, when memory is short. */
static bool look_at(const struct seeker *s, const struct grid *g, int64_t first, int64_t end,
                    int64_t i0, int64_t i1, int64_t j, int64_t k)
{
    for (const struct entry *f = g->entry + first; f < g->entry + end; f++) {
        if (f->cell[0] < i0 || f->cell[0] > i1 || f->cell[1] != j || f->cell[2] != k) continue;
        if (!near(s, f)) continue;
        if (s->p->mass[s->e->body] == 0 && s->p->mass[f->body] == 0) continue;
        if (!pairs_add(s->out, s->e->body, f->body)) return false;
    }
    return true;
}

/* The cells i0 .. i1 of line (j, k): their buckets are consecutive, the first after the last. */
static bool look_along(const struct seeker *s, const struct grid *g, int64_t i0, int64_t i1,
                       int64_t j, int64_t k)
{
    uint64_t b0 = bucket(g, i0, j, k), b1 = bucket(g, i1, j, k);
    if (b0 <= b1) return look_at(s, g, g->first[b0], g->first[b1 + 1], i0, i1, j, k);
    return look_at(s, g, g->first[b0], g->n, i0, i1, j, k) &&
           look_at(s, g, 0, g->first[b1 + 1], i0, i1, j, k);
}

/* Bodies near entry m of g in g itself: half of the cells around, so that a pair is found once. */
static bool look_here(const struct seeker *s, const struct grid *g, int64_t m)
{
    int64_t i = s->e->cell[0], j = s->e->cell[1], k = s->e->cell[2];
    int64_t end = g->first[bucket(g, i, j, k) + 1];
    if (!look_at(s, g, m + 1, end, i, i, j, k) || !look_along(s, g, i + 1, i + 1, j, k) ||
        !look_along(s, g, i - 1, i + 1, j + 1, k))
        return false;
    for (int64_t l = j - 1; l <= j + 1 && s->p->dim == 3; l++)
        if (!look_along(s, g, i - 1, i + 1, l, k + 1)) return false;
    return true;
}

/* Bodies near it in g, a grid of larger bodies: all cells around it. */
static bool look_around(const struct seeker *s, const struct grid *g)
{
    const vec3 x = s->e->x;
    int64_t i = cell_of(x.x, g->h), j = cell_of(x.y, g->h), k = cell_of(x.z, g->h);
    int64_t up = s->p->dim == 3;
    for (int64_t m = k - up; m <= k + up; m++)
        for (int64_t l = j - 1; l <= j + 1; l++)
            if (!look_along(s, g, i - 1, i + 1, l, m)) return false;
    return true;
}

/* Sorts by (a, b): a counting sort by a, then the few pairs of each a by b. */
static bool pairs_sort(struct neighbours *s)
{
    int64_t *first = calloc((size_t)s->bodies + 2, sizeof *first);
    struct pair *sorted = calloc((size_t)(s->n + 1), sizeof *sorted);
    bool allocated = first && sorted;
    for (int64_t i = 0; allocated && i < s->n; i++) first[s->pair[i].a + 2]++;
    for (int64_t a = 0; allocated && a < s->bodies; a++) first[a + 2] += first[a + 1];
    for (int64_t i = 0; allocated && i < s->n; i++) sorted[first[s->pair[i].a + 1]++] = s->pair[i];
    for (int64_t a = 0; allocated && a < s->bodies; a++)
        for (int64_t i = first[a] + 1; i < first[a + 1]; i++) {
            struct pair x = sorted[i];
            int64_t k = i;
            for (; k > first[a] && sorted[k - 1].b > x.b; k--) sorted[k] = sorted[k - 1];
            sorted[k] = x;
        }
    free(first);
    if (!allocated) {
        free(sorted);
        return false;
    }
    free(s->pair);
    s->pair = sorted, s->room = s->n + 1;
    return true;
}

static bool make_list(struct neighbours *s, const struct packing *p, const vec3 *x)
{
    struct grid g[LEVELS];
    memset(g, 0, sizeof g);
    bool allocated = grids_build(g, p, x, s->reach);
    s->n = 0;
    for (int l = 0; allocated && l < LEVELS; l++)
        for (int64_t m = 0; allocated && m < g[l].n; m++) {
            const struct seeker k = { p, &g[l].entry[m], s->reach, s };
            for (int b = 0; allocated && b < l; b++)
                if (g[b].n) allocated = look_around(&k, &g[b]);
            allocated = allocated && look_here(&k, &g[l], m);
        }
    grids_free(g);
    return allocated && pairs_sort(s);
}

/* ---- from step to step ---- */

/* Has the list still every pair with at most this gap (m)? Yes if no body has moved by half of what
   the list reaches further. */
static bool list_serves(const struct neighbours *s, const vec3 *x, double gap)
{
    double most = 0.49 * (s->reach - gap); // not 0.5: a margin for rounding
    if (!s->listed || most < 0) return false;
    for (int64_t i = 0; i < s->bodies; i++) {
        vec3 d = v3_sub(x[i], s->listed[i]);
        if (!(v3_dot(d, d) <= most * most)) return false;
    }
    return true;
}

/* m: what a list shall reach further. Twice the way of KEEP_STEPS steps: both bodies may move. */
static double spare_reach(const struct packing *p)
{
    double v2 = 0, r = 0;
    for (int64_t i = 0; i < p->n; i++) v2 = fmax(v2, v3_dot(p->v[i], p->v[i])), r += p->radius[i];
    r /= (double)(p->n ? p->n : 1);
    double s = fmax(2 * KEEP_STEPS * p->dt * sqrt(v2), MIN_SPARE * r);
    return s <= MAX_SPARE * r ? s : 0;
}

int neighbours_find(struct neighbours *s, const struct packing *p, const vec3 *x, double gap,
                    bool keep, struct why *why)
{
    size_t size = (size_t)p->n * sizeof *x;
    if (s->bodies == p->n && list_serves(s, x, gap)) return 0;
    vec3 *listed = keep ? realloc(s->listed, size + sizeof *x) : s->listed;
    if (keep && !listed) return why_set(why, EX_SOFTWARE, "no memory for the neighbours");
    s->listed = listed, s->bodies = p->n, s->reach = gap + (keep ? spare_reach(p) : 0);
    if (!make_list(s, p, x))
        return s->n < crowd(s)
                   ? why_set(why, EX_SOFTWARE, "no memory for the neighbours")
                   : why_set(
                         why, EX_DATAERR,
                         "more than %lld pairs of neighbours: bodies in one place, or a wide gap",
                         (long long)crowd(s));
    if (keep && p->n) memcpy(s->listed, x, size);
    return 0;
}
