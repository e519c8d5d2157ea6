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
    free(s->listed), free(s->pair), free(s->image);
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

/* a, moved by `shift` edges, is near b. */
static bool pairs_add(struct neighbours *s, int32_t a, int32_t b, const int8_t shift[3])
{
    if (s->n >= crowd(s)) return false;
    if (s->n == s->room) {
        int64_t room = s->room ? 2 * s->room : 1024;
        struct pair *p = realloc(s->pair, (size_t)room * sizeof *p);
        if (!p) return false;
        s->pair = p, s->room = room;
    }
    struct pair *new = &s->pair[s->n++];
    *new = a < b ? (struct pair){ .a = a, .b = b } : (struct pair){ .a = b, .b = a };
    for (int k = 0; k < 3; k++) new->shift[k] = (int8_t)(a < b ? -shift[k] : shift[k]);
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

/* A body, or an image of it, that looks for others near it */
struct seeker {
    const struct packing *p;
    const struct entry *e; /* the body */
    vec3 x;                /* m: where it looks from, */
    int8_t shift[3];       /* so many edges from the body */
    double reach;          /* m: the largest gap of a pair to list */
    struct neighbours *out;
};

static bool near(const struct seeker *s, const struct entry *f)
{
    vec3 d = v3_sub(f->x, s->x);
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
        if (f->body == s->e->body) continue; // its image, and the wide reach of a list that is kept
        if (!pairs_add(s->out, s->e->body, f->body, s->shift)) return false;
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
    const vec3 x = s->x;
    int64_t i = cell_of(x.x, g->h), j = cell_of(x.y, g->h), k = cell_of(x.z, g->h);
    int64_t up = s->p->dim == 3;
    for (int64_t m = k - up; m <= k + up; m++)
        for (int64_t l = j - 1; l <= j + 1; l++)
            if (!look_along(s, g, i - 1, i + 1, l, m)) return false;
    return true;
}

/* ---- images ---- */

/* The cell as the search sees it: how many edges from the origin the bodies are, u = inverse . x */
struct lattice {
    const vec3 *edge;    /* [3] m */
    const bool *repeats; /* [3] */
    vec3 inverse[3];     /* 1/m */
    double lo[3], hi[3]; /* of u over all bodies */
};

static double edges_along(const struct lattice *c, int k, vec3 x)
{
    return v3_dot(c->inverse[k], x);
}

static struct lattice lattice_of(const struct packing *p, const vec3 *x, const vec3 edge[3])
{
    struct lattice c = { .edge = edge, .repeats = p->cell.repeats };
    cell_inverse(edge, c.inverse);
    for (int k = 0; k < 3; k++) c.lo[k] = INFINITY, c.hi[k] = -INFINITY;
    for (int64_t i = 0; i < p->n; i++)
        for (int k = 0; k < 3; k++) {
            double u = edges_along(&c, k, x[i]);
            c.lo[k] = fmin(c.lo[k], u), c.hi[k] = fmax(c.hi[k], u);
        }
    return c;
}

/* Bodies that are not brought back into the cell have so many images near them that the search would
   not end. */
static bool is_tidy(const struct lattice *c)
{
    for (int k = 0; k < 3; k++)
        if (c->repeats[k] && !(c->hi[k] - c->lo[k] <= 3)) return false;
    return true;
}

/* Is it the later one of a shift and its opposite? */
static bool is_later(const int shift[3])
{
    for (int k = 0; k < 3; k++)
        if (shift[k]) return shift[k] > 0;
    return false;
}

/*
 * Bodies of g near the images of a body. In the grid of its own level (`own`) the image by -shift of
 * the one finds the other where the image by shift of the other finds the one: one of them looks.
 */
static bool look_from_images(struct seeker s, const struct grid *g, bool own,
                             const struct lattice *c)
{
    int lo[3], hi[3], n[3];
    for (int k = 0; k < 3; k++) {
        double u = edges_along(c, k, s.e->x), reach = g->h * v3_norm(c->inverse[k]);
        lo[k] = c->repeats[k] ? (int)fmax(ceil(c->lo[k] - reach - u), -INT8_MAX) : 0;
        hi[k] = c->repeats[k] ? (int)fmin(floor(c->hi[k] + reach - u), INT8_MAX) : 0;
    }
    for (n[0] = lo[0]; n[0] <= hi[0]; n[0]++)
        for (n[1] = lo[1]; n[1] <= hi[1]; n[1]++)
            for (n[2] = lo[2]; n[2] <= hi[2]; n[2]++) {
                if ((!n[0] && !n[1] && !n[2]) || (own && !is_later(n))) continue;
                for (int k = 0; k < 3; k++) s.shift[k] = (int8_t)n[k];
                s.x = v3_add(s.e->x, cell_shift(c->edge, s.shift));
                if (!look_around(&s, g)) return false;
            }
    return true;
}

/* ---- the list ---- */

/* Of two pairs of the same a: does x come first? */
static bool pair_first(const struct pair *x, const struct pair *y)
{
    if (x->b != y->b) return x->b < y->b;
    for (int k = 0; k < 3; k++)
        if (x->shift[k] != y->shift[k]) return x->shift[k] < y->shift[k];
    return false;
}

/* Sorts by (a, b, shift): a counting sort by a, then the few pairs of each a. */
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
            for (; k > first[a] && pair_first(&x, &sorted[k - 1]); k--) sorted[k] = sorted[k - 1];
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

/* c: NULL, nothing repeats */
static bool make_list(struct neighbours *s, const struct packing *p, const vec3 *x,
                      const struct lattice *c)
{
    struct grid g[LEVELS];
    memset(g, 0, sizeof g);
    bool allocated = grids_build(g, p, x, s->reach);
    s->n = 0;
    for (int l = 0; allocated && l < LEVELS; l++)
        for (int64_t m = 0; allocated && m < g[l].n; m++) {
            const struct entry *e = &g[l].entry[m];
            const struct seeker k = { .p = p, .e = e, .x = e->x, .reach = s->reach, .out = s };
            for (int b = 0; allocated && b < l; b++)
                if (g[b].n) allocated = look_around(&k, &g[b]);
            allocated = allocated && look_here(&k, &g[l], m);
            for (int b = 0; c && allocated && b <= l; b++)
                if (g[b].n) allocated = look_from_images(k, &g[b], b == l, c);
        }
    grids_free(g);
    return allocated && pairs_sort(s);
}

/* ---- from step to step ---- */

/* 1 - |F - 1| <= |F d| / |d| for all d: how much a deformation F, of columns f, may shorten */
static double least_stretch(const vec3 f[3])
{
    const vec3 one[3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        vec3 d = v3_sub(f[k], one[k]);
        sum += v3_dot(d, d);
    }
    return 1 - sqrt(sum);
}

static double largest_radius(const struct packing *p)
{
    double most = 0;
    for (int64_t i = 0; i < p->n; i++) most = fmax(most, p->radius[i]);
    return most;
}

/* F x, of columns f */
static vec3 deform(const vec3 f[3], vec3 x)
{
    return v3_axpy(v3_axpy(v3_scale(x.x, f[0]), x.y, f[1]), x.z, f[2]);
}

/*
 * The same where the cell repeats and may have moved. Since the list was made the edges have been
 * deformed by F, and a pair at p_0 is now at F p_0 plus what its bodies have moved beyond F; bodies
 * that have been wrapped count as if they had not.
 */
static bool list_serves_cell(const struct neighbours *s, const struct packing *p, const vec3 *x,
                             const vec3 edge[3], double gap)
{
    if (!s->listed || !s->image) return false;
    const vec3 *inverse = s->inverse, o = p->cell.origin;
    vec3 f[3];
    for (int k = 0; k < 3; k++) {
        const double u[3] = { k == 0   ? inverse[0].x
                              : k == 1 ? inverse[0].y
                                       : inverse[0].z,
                              k == 0   ? inverse[1].x
                              : k == 1 ? inverse[1].y
                                       : inverse[1].z,
                              k == 0   ? inverse[2].x
                              : k == 1 ? inverse[2].y
                                       : inverse[2].z };
        f[k] = v3_axpy(v3_axpy(v3_scale(u[0], edge[0]), u[1], edge[1]), u[2], edge[2]);
    }
    double stretch = fmin(least_stretch(f), 1), wide = 2 * largest_radius(p);
    double most = 0.49 * (stretch * s->reach - gap - (1 - stretch) * wide);
    if (!(most >= 0)) return false;
    for (int64_t i = 0; i < s->bodies; i++) {
        vec3 d = v3_sub(v3_sub(x[i], o), deform(f, v3_sub(s->listed[i], o)));
        for (int k = 0; k < 3; k++)
            if (p->image[i][k] != s->image[i][k])
                d = v3_axpy(d, (double)p->image[i][k] - s->image[i][k], edge[k]);
        if (!(v3_dot(d, d) <= most * most)) return false;
    }
    return true;
}

/* Has the list still every pair with at most this gap (m)? Yes if no body has moved by half of what
   the list reaches further. */
static bool list_serves(const struct neighbours *s, const struct packing *p, const vec3 *x,
                        const vec3 edge[3], double gap)
{
    if (cell_repeats(&p->cell)) return list_serves_cell(s, p, x, edge, gap);
    double most = 0.49 * (s->reach - gap); // not 0.5: a margin for rounding
    if (!s->listed || most < 0) return false;
    for (int64_t i = 0; i < s->bodies; i++) {
        vec3 d = v3_sub(x[i], s->listed[i]);
        if (!(v3_dot(d, d) <= most * most)) return false;
    }
    return true;
}

/* m/s: the fastest body, where the cell repeats beyond the flow that its edges make: by how much two
   bodies near each other may differ at most, and half of it */
static double fastest(const struct packing *p)
{
    double v2 = 0;
    if (!cell_repeats(&p->cell)) {
        for (int64_t i = 0; i < p->n; i++) v2 = fmax(v2, v3_dot(p->v[i], p->v[i]));
        return sqrt(v2);
    }
    vec3 inverse[3], mean = v3(0, 0, 0);
    cell_inverse(p->cell.edge, inverse);
    for (int pass = 0; pass < 2; pass++)
        for (int64_t i = 0; i < p->n; i++) {
            vec3 v = p->v[i], d = v3_sub(p->x[i], p->cell.origin);
            for (int k = 0; k < 3; k++) v = v3_axpy(v, -v3_dot(inverse[k], d), p->cell.rate[k]);
            if (pass == 0) mean = v3_axpy(mean, 1 / (double)p->n, v);
            v = v3_sub(v, mean);
            if (pass == 1) v2 = fmax(v2, v3_dot(v, v));
        }
    return sqrt(v2);
}

/* m: what a list shall reach further. Twice the way of KEEP_STEPS steps: both bodies may move. */
static double spare_reach(const struct packing *p)
{
    double r = 0;
    for (int64_t i = 0; i < p->n; i++) r += p->radius[i];
    r /= (double)(p->n ? p->n : 1);
    double way = fastest(p);
    for (int k = 0; cell_repeats(&p->cell) && k < 3;
         k++) // and what the edges' motion takes from it
        way += v3_norm(p->cell.rate[k]) / v3_norm(p->cell.edge[k]) * largest_radius(p);
    double s = fmax(2 * KEEP_STEPS * p->dt * way, MIN_SPARE * r);
    return s <= MAX_SPARE * r ? s : 0;
}

/* Where the list is made: images and edges, for the steps that it is to serve */
static int note_images(struct neighbours *s, const struct packing *p, const vec3 edge[3],
                       struct why *why)
{
    size_t size = (size_t)p->n * sizeof *s->image;
    int32_t(*image)[3] = realloc(s->image, size + sizeof *image);
    if (!image) return why_set(why, EX_SOFTWARE, "no memory for the neighbours");
    s->image = image;
    memcpy(image, p->image, size);
    cell_inverse(edge, s->inverse);
    return 0;
}

void neighbours_shift(const struct neighbours *s, const struct packing *p, const struct pair *pair,
                      int8_t shift[3])
{
    for (int k = 0; k < 3; k++) {
        shift[k] = pair->shift[k];
        if (!s->image) continue;
        int64_t b = (int64_t)p->image[pair->b][k] - s->image[pair->b][k];
        int64_t a = (int64_t)p->image[pair->a][k] - s->image[pair->a][k];
        shift[k] = (int8_t)(shift[k] + b - a);
    }
}

int neighbours_find(struct neighbours *s, const struct packing *p, const vec3 *x,
                    const vec3 edge[3], double gap, bool keep, struct why *why)
{
    size_t size = (size_t)p->n * sizeof *x;
    bool images = cell_repeats(&p->cell);
    if (images) {
        struct cell now = { .origin = p->cell.origin };
        for (int k = 0; k < 3; k++) now.edge[k] = edge[k], now.repeats[k] = p->cell.repeats[k];
        if (cell_check(&now, p->dim, 2 * largest_radius(p) + gap, why)) return why->status;
    }
    if (s->bodies == p->n && list_serves(s, p, x, edge, gap)) return 0;
    struct lattice c = { 0 };
    if (images) c = lattice_of(p, x, edge);
    if (images && !is_tidy(&c))
        return why_set(
            why, EX_DATAERR,
            "bodies are more than three cells apart: some move through the cell in a step");
    vec3 *listed = keep ? realloc(s->listed, size + sizeof *x) : s->listed;
    if (keep && !listed) return why_set(why, EX_SOFTWARE, "no memory for the neighbours");
    s->listed = listed, s->bodies = p->n, s->reach = gap + (keep ? spare_reach(p) : 0);
    if (!make_list(s, p, x, images ? &c : NULL))
        return s->n < crowd(s)
                   ? why_set(why, EX_SOFTWARE, "no memory for the neighbours")
                   : why_set(
                         why, EX_DATAERR,
                         "more than %lld pairs of neighbours: bodies in one place, or a wide gap",
                         (long long)crowd(s));
    if (keep && p->n) memcpy(s->listed, x, size);
    return keep && images ? note_images(s, p, edge, why) : 0;
}
