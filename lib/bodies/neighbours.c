/* bodies/neighbours.c: the search of pairs in the grids, and how long a list of them serves. */
#include "bodies/neighbours.h"

#include "base/team.h"
#include "bodies/grid.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum {
    KEEP_STEPS = 8, /* steps that a list is meant to serve, all at the speed of the fastest body; */
    KEEP_LEAST = 3, /* no list is kept that would serve fewer */
    SEEKERS = 512,  /* bodies whose search is worth a thread: 100 us */
    SOME = 16384    /* and bodies whose way is */
};
/* What a list may reach further than was asked, in mean radii: */
static const double MIN_SPARE = 0.02, /* when (nearly) nothing moves */
    MAX_SPARE = 0.5;                  /* beyond it a list would be crowded: it serves one step */

static void surfaces_free(struct neighbours *s)
{
    for (int32_t w = 0; w < s->surfaces; w++) surface_free(&s->surface[w]);
    free(s->surface);
    s->surface = NULL, s->surfaces = 0;
}

void neighbours_free(struct neighbours *s)
{
    surfaces_free(s);
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
    uint64_t b0 = grid_bucket(g, i0, j, k), b1 = grid_bucket(g, i1, j, k);
    if (b0 <= b1) return look_at(s, g, g->first[b0], g->first[b1 + 1], i0, i1, j, k);
    return look_at(s, g, g->first[b0], g->n, i0, i1, j, k) &&
           look_at(s, g, 0, g->first[b1 + 1], i0, i1, j, k);
}

/* Bodies near entry m of g in g itself: half of the cells around, so that a pair is found once. */
static bool look_here(const struct seeker *s, const struct grid *g, int64_t m)
{
    int64_t i = s->e->cell[0], j = s->e->cell[1], k = s->e->cell[2];
    int64_t end = g->first[grid_bucket(g, i, j, k) + 1];
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
    int64_t i = grid_cell(x.x, g->h), j = grid_cell(x.y, g->h), k = grid_cell(x.z, g->h);
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
            c.lo[k] = dmin(c.lo[k], u), c.hi[k] = dmax(c.hi[k], u);
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

/* The bodies of one grid that look for others, in parts */
struct search {
    const struct packing *p;
    const struct grid *g;    /* [level + 1] */
    const struct lattice *c; /* NULL: nothing repeats */
    int level;
    pthread_mutex_t lock; /* of what follows */
    struct neighbours *out;
    bool failed;
};

/* The pairs of a part join the others: in any order, for they are sorted in the end. */
static bool pairs_join(struct neighbours *s, struct neighbours *part)
{
    if (!s->n) { // all of them, mostly
        free(s->pair);
        s->pair = part->pair, s->n = part->n, s->room = part->room;
        part->pair = NULL;
        return true;
    }
    if (s->n + part->n > crowd(s)) return s->n = crowd(s), false;
    if (s->n + part->n > s->room) {
        int64_t room = s->room + s->room / 2 + part->n;
        struct pair *p = realloc(s->pair, (size_t)room * sizeof *p);
        if (!p) return false;
        s->pair = p, s->room = room;
    }
    if (part->n) memcpy(s->pair + s->n, part->pair, (size_t)part->n * sizeof *part->pair);
    s->n += part->n;
    return true;
}

static void search_some(void *arg, int64_t first, int64_t end)
{
    struct search *o = arg;
    const struct grid *g = o->g;
    const int l = o->level;
    struct neighbours part = { .bodies = o->out->bodies };
    bool found = true;
    for (int64_t m = first; found && m < end; m++) {
        const struct entry *e = &g[l].entry[m];
        const struct seeker k = {
            .p = o->p, .e = e, .x = e->x, .reach = o->out->reach, .out = &part
        };
        for (int b = 0; found && b < l; b++)
            if (g[b].n) found = look_around(&k, &g[b]);
        found = found && look_here(&k, &g[l], m);
        for (int b = 0; o->c && found && b <= l; b++)
            if (g[b].n) found = look_from_images(k, &g[b], b == l, o->c);
    }
    pthread_mutex_lock(&o->lock);
    if (!pairs_join(o->out, &part) || !found) o->failed = true;
    pthread_mutex_unlock(&o->lock);
    free(part.pair);
}

/* c: NULL, nothing repeats */
static bool make_list(struct neighbours *s, const struct packing *p, const vec3 *x,
                      const struct lattice *c)
{
    struct grid g[LEVELS];
    memset(g, 0, sizeof g);
    struct search o = {
        .p = p, .g = g, .c = c, .lock = PTHREAD_MUTEX_INITIALIZER, .out = s, .failed = false
    };
    o.failed = !grids_build(g, p, x, s->reach);
    s->n = 0;
    for (o.level = 0; !o.failed && o.level < LEVELS; o.level++)
        team_share(team_size(), g[o.level].n, SEEKERS, search_some, &o);
    grids_free(g);
    return !o.failed && pairs_sort(s);
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
    for (int64_t i = 0; i < p->n; i++) most = dmax(most, p->radius[i]);
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
        vec3 e = v3(k == 0, k == 1, k == 2);
        f[k] =
            deform(edge, v3(v3_dot(inverse[0], e), v3_dot(inverse[1], e), v3_dot(inverse[2], e)));
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

/* The ways of bodies since a list was made */
struct ways {
    const struct neighbours *s;
    const vec3 *x;
    vec3 common;          /* m: a way that all have gone, which brings no two nearer */
    double most;          /* m: that each may have gone beyond it */
    pthread_mutex_t lock; /* of what follows */
    vec3 lo, hi;          /* m: the box of all ways */
    bool far;             /* some body has gone further */
};

static vec3 least_of(vec3 a, vec3 b)
{
    return v3(a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z);
}

static vec3 most_of(vec3 a, vec3 b)
{
    return v3(a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z);
}

static void look_at_ways(void *arg, int64_t first, int64_t end)
{
    struct ways *o = arg;
    vec3 lo = v3(INFINITY, INFINITY, INFINITY), hi = v3_scale(-1, lo);
    bool far = false;
    for (int64_t i = first; i < end; i++) {
        vec3 d = v3_sub(o->x[i], o->s->listed[i]), beyond = v3_sub(d, o->common);
        lo = least_of(lo, d), hi = most_of(hi, d);
        far |= !(v3_dot(beyond, beyond) <= o->most * o->most);
    }
    pthread_mutex_lock(&o->lock);
    o->lo = least_of(o->lo, lo), o->hi = most_of(o->hi, hi);
    if (far) o->far = true;
    pthread_mutex_unlock(&o->lock);
}

/* Has the list still every pair with at most this gap (m)? Yes if no body has moved by half of what
   the list reaches further; what all bodies move, as those that fall, does not count. */
static bool list_serves(const struct neighbours *s, const struct packing *p, const vec3 *x,
                        const vec3 edge[3], double gap)
{
    if (cell_repeats(&p->cell)) return list_serves_cell(s, p, x, edge, gap);
    struct ways o = { .s = s,
                      .x = x,
                      .most = 0.49 * (s->reach - gap), // not 0.5: a margin for rounding
                      .lock = PTHREAD_MUTEX_INITIALIZER,
                      .lo = v3(INFINITY, INFINITY, INFINITY),
                      .hi = v3(-INFINITY, -INFINITY, -INFINITY) };
    if (!s->listed || o.most < 0) return false;
    team_share(team_size(), s->bodies, SOME, look_at_ways, &o);
    if (!o.far) return true;
    o.common = v3_scale(0.5, v3_add(o.lo, o.hi)), o.far = false;
    if (!(v3_norm(v3_sub(o.hi, o.lo)) <= 4 * o.most)) return false;
    team_share(team_size(), s->bodies, SOME, look_at_ways, &o);
    return !o.far;
}

/* m/s: the fastest body beyond a velocity that all share: by how much two bodies may differ at most, and
   half of it */
static double fastest_of_all(const struct packing *p)
{
    vec3 lo = v3(INFINITY, INFINITY, INFINITY), hi = v3_scale(-1, lo);
    double v2 = 0, beyond2 = 0;
    for (int64_t i = 0; i < p->n; i++) {
        v2 = dmax(v2, v3_dot(p->v[i], p->v[i]));
        lo = least_of(lo, p->v[i]), hi = most_of(hi, p->v[i]);
    }
    vec3 common = v3_scale(0.5, v3_add(lo, hi));
    for (int64_t i = 0; i < p->n; i++) {
        vec3 d = v3_sub(p->v[i], common);
        beyond2 = dmax(beyond2, v3_dot(d, d));
    }
    return sqrt(fmin(v2, beyond2));
}

/* The same, where the cell repeats beyond the flow that its edges make */
static double fastest(const struct packing *p)
{
    double v2 = 0;
    if (!cell_repeats(&p->cell)) return fastest_of_all(p);
    vec3 inverse[3], mean = v3(0, 0, 0);
    cell_inverse(p->cell.edge, inverse);
    for (int pass = 0; pass < 2; pass++)
        for (int64_t i = 0; i < p->n; i++) {
            vec3 v = p->v[i], d = v3_sub(p->x[i], p->cell.origin);
            for (int k = 0; k < 3; k++) v = v3_axpy(v, -v3_dot(inverse[k], d), p->cell.rate[k]);
            if (pass == 0) mean = v3_axpy(mean, 1 / (double)p->n, v);
            v = v3_sub(v, mean);
            if (pass == 1) v2 = dmax(v2, v3_dot(v, v));
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
    for (int k = 0; cell_repeats(&p->cell) && k < 3; k++) // what the edges' motion takes from it
        way += v3_norm(p->cell.rate[k]) / v3_norm(p->cell.edge[k]) * largest_radius(p);
    double step = 2 * p->dt * way, s = fmax(KEEP_STEPS * step, MIN_SPARE * r);
    if (s <= MAX_SPARE * r) return s;
    return KEEP_LEAST * step <= MAX_SPARE * r ? MAX_SPARE * r : 0;
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

int neighbours_surfaces(struct neighbours *s, const struct packing *p, struct why *why)
{
    if (!p->mesh.elements || s->surfaces == p->walls) return 0;
    surfaces_free(s);
    s->surface = calloc((size_t)p->walls + 1, sizeof *s->surface);
    if (!s->surface) return why_set(why, EX_SOFTWARE, "no memory for the surfaces of meshes");
    s->surfaces = p->walls;
    for (int32_t w = 0; w < p->walls; w++) {
        const struct wall *wall = &p->wall[w];
        if (wall->shape == BOUNDARY_MESH &&
            surface_init(&s->surface[w], &p->mesh, wall->first_element, wall->elements, why))
            return why->status;
    }
    return 0;
}
