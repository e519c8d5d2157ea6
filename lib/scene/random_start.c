#include "scene/random_start.h"

#include "contact/neighbours.h"
#include "scene/obstacles.h"
#include "scene/scene_height.h"

#include <stdlib.h>
#include <string.h>

/* Where the next cell begins, and where the present row and shelf end; [k] along axis k */
struct cursor {
    int dim;
    const struct scene_box *box;
    double at[3], end[3];
};

static int shelves_larger_first(const void *one, const void *other)
{
    const struct grain *a = *(struct grain *const *)one, *b = *(struct grain *const *)other;
    if (a->r != b->r) return a->r > b->r ? -1 : 1;
    return a < b ? -1 : a > b; // as drawn: qsort alone promises no order
}

/* Does [at, at + edge] end within the box along axis k? Rounding is forgiven: 6.3 mm hold six cells
   of 1.05 mm. */
static bool fits(const struct cursor *c, int k, double edge)
{
    double lo = c->box->lo[k], hi = c->box->hi[k];
    return c->at[k] + edge <= hi + 1e-12 * (isfinite(hi) ? hi - lo : 0);
}

/* The row, or the shelf, is full along axis k: on to the next; false: there is none. */
static bool move_on(struct cursor *c, int k)
{
    if (k == c->dim - 1 || c->at[k] == c->box->lo[k]) return false; // wider than the box
    for (int i = 0; i <= k; i++) c->at[i] = c->end[i] = c->box->lo[i];
    c->at[k + 1] = c->end[k + 1];
    return true;
}

/* Finds room for a cell at the cursor: in its row, else in a new row, else on a new shelf. */
static bool random_start_place(struct cursor *c, double edge)
{
    for (int k = 0; k < c->dim; k++) {
        if (fits(c, k, edge)) continue;
        if (!move_on(c, k)) return false;
        k = -1; // does it fit there?
    }
    for (int k = 1; k < c->dim; k++) c->end[k] = fmax(c->end[k], c->at[k] + edge);
    return true;
}

/* Grain g into a cell of its own, moved at random as far as it stays in it. */
static void random_start_settle(struct grain *g, const struct cursor *c, double edge, double jitter,
                                gsl_rng *rng)
{
    double x[3] = { 0 };
    for (int k = 0; k < c->dim; k++)
        x[k] =
            c->at[k] + 0.5 * edge + jitter * (0.5 * edge - g->r) * (2 * gsl_rng_uniform(rng) - 1);
    g->x = v3(x[0], x[1], x[2]);
}

int shelves_fill(struct grains *out, const struct scene_bodies *b, int dim, gsl_rng *rng,
                 struct failure *failure)
{
    for (int64_t i = 0; i < b->count; i++) {
        struct grain g = grain_at(v3(0, 0, 0), scene_size_draw(&b->size, rng));
        if (grains_add(out, &g, failure)) return failure->status;
    }
    struct grain **sorted = malloc(((size_t)out->n + 1) * sizeof(struct grain *));
    if (!sorted) return failure_set(failure, EX_SOFTWARE, "no memory for a lattice");
    for (int64_t i = 0; i < out->n; i++) sorted[i] = &out->g[i];
    qsort(sorted, (size_t)out->n, sizeof(struct grain *), shelves_larger_first);
    struct cursor c = { .dim = dim, .box = &b->box };
    struct scene_box open = b->box;
    int64_t went =
        -1; /* bodies that found room; the others are stacked on top, to say how high they are */
    open.hi[dim - 1] = INFINITY;
    for (int k = 0; k < dim; k++) c.at[k] = c.end[k] = b->box.lo[k];
    for (int64_t i = 0; i < out->n && !failure->status; i++) {
        double edge = 2 * b->spacing * sorted[i]->r;
        bool placed = random_start_place(&c, edge);
        if (!placed && went < 0) went = i, c.box = &open, placed = random_start_place(&c, edge);
        if (!placed)
            failure_set(failure, EX_DATAERR, "the box is narrower than a cell of %.4g m", edge);
        else
            random_start_settle(sorted[i], &c, edge, b->jitter, rng);
        c.at[0] += edge;
    }
    if (went >= 0 && !failure->status)
        failure_set(
            failure, EX_DATAERR,
            "the box has cells for %lld of %lld bodies: they need a height of %.4g m along %c",
            (long long)went, (long long)out->n, c.end[dim - 1] - b->box.lo[dim - 1],
            "xyz"[dim - 1]);
    free(sorted);
    return failure->status;
}

enum {
    LEVELS = 24,      /* grids of cells, for radii down to 2^-24 of the largest */
    TRIES = 20000,    /* places tried for a grain: at these densities it takes a dozen */
    TRIES_MEAN = 200, /* and in the mean of all, after TRIES_FREE */
    TRIES_FREE = 1 << 21,
    SWEEPS = 100, /* over the pairs at most, after a growth */
    LAST = 20000, /* and in the end */
    STEPS = 24,   /* growths from loose to dense */
    FILL_MOST =
        1 << 21 /* grains that a share of the box may come to: 1 GB. More have to be counted. */
};
static const double FULL = 0.95; /* of the room: no more balls go in, wherever they are */
static const double LOOSE[4] = { 0, 0, 0.4, 0.28 }; /* [dim] share of the box */
static const double FURTHER = 1e-4; /* radii: what pairs are pushed beyond touching */
static const double BETWEEN = 0.02; /* smaller radii: overlap that may remain between growths */
static const double REACH = 0.5;    /* mean radii: pairs this near are kept in the list */

/* The grains in work, sorted: the largest first */
struct random_start_all {
    int dim;
    const struct scene_box *box;
    const struct cell *cell; /* in place of the box: bodies and their images fill it; or NULL */
    vec3 inverse[3];         /* 1/m: of its edges */
    double height[3];        /* m: of its faces */
    struct packing p; /* radius: as they are asked for; mass: r^dim, in units of the largest */
    struct obstacles walls;
    double volume; /* m^3, m^2: of the balls around them */
    double scale;  /* of the radii */
    int64_t *from; /* [p.n] the place in the order drawn */
};

/* ---- random sequential addition ---- */

/* The grains that are placed, by size and cell; radii of a level are within a factor of two */
struct level {
    double h; /* m: a cell's edge, at least the diameter of its grains */
    uint64_t mask;
    int64_t *head; /* [mask + 1] the last grain of a bucket, -1: none */
};

struct random_start_placed {
    struct level level[LEVELS];
    int64_t *next; /* [n] the grain before in the same bucket */
};

static uint64_t random_start_bucket(const struct level *l, const int64_t cell[3])
{
    uint64_t h = (uint64_t)cell[0] * 0x9e3779b97f4a7c15 ^ (uint64_t)cell[1] * 0xc2b2ae3d27d4eb4f ^
                 (uint64_t)cell[2] * 0x165667b19e3779f9;
    return (h ^ h >> 29) & l->mask;
}

/* Cells farther away than this are one: those that meet stay neighbours, and a number of any size is one
   of 64 bits. */
#define FAR_CELL 1e15

static void cell_of(const struct level *l, const struct random_start_all *s, vec3 x,
                    int64_t cell[3])
{
    const double at[3] = { x.x, x.y, x.z };
    for (int k = 0; k < 3; k++) {
        double c = floor((at[k] - s->box->lo[k]) / l->h);
        cell[k] = k < s->dim ? (int64_t)fmax(-FAR_CELL, fmin(c, FAR_CELL)) : 0;
    }
}

static double radius(const struct random_start_all *s, int64_t i)
{
    return s->scale * s->p.radius[i];
}

static int random_start_level_of(const struct random_start_all *s, int64_t i)
{
    int l = ilogb(s->p.radius[0] / s->p.radius[i]);
    return l < LEVELS ? l : LEVELS - 1;
}

static bool placed_alloc(struct random_start_placed *t, const struct random_start_all *s)
{
    int64_t count[LEVELS] = { 0 };
    *t = (struct random_start_placed){ 0 };
    if (!(t->next = malloc(((size_t)s->p.n + 1) * sizeof *t->next))) return false;
    for (int64_t i = 0; i < s->p.n; i++) {
        struct level *l = &t->level[random_start_level_of(s, i)];
        l->h = fmax(l->h, 2 * radius(s, i));
        count[random_start_level_of(s, i)]++;
    }
    for (int k = 0; k < LEVELS; k++) {
        struct level *l = &t->level[k];
        if (!count[k]) continue;
        for (l->mask = 4; l->mask < 2 * (uint64_t)count[k];) l->mask *= 2;
        if (!(l->head = malloc(l->mask * sizeof *l->head))) return false;
        for (uint64_t b = 0; b < l->mask; b++) l->head[b] = -1;
        l->mask--;
    }
    return true;
}

static void random_start_placed_free(struct random_start_placed *t)
{
    for (int k = 0; k < LEVELS; k++) free(t->level[k].head);
    free(t->next);
}

/* m: the middle of a grain in the cell, u edges from its origin; along those that do not repeat it stays inside
   with this radius */
static vec3 in_cell(const struct random_start_all *s, const double u[3], double r)
{
    vec3 x = s->cell->origin;
    for (int k = 0; k < s->dim; k++) {
        double margin = s->cell->repeats[k] ? 0 : fmin(r / s->height[k], 0.5);
        x = v3_axpy(x, margin + u[k] * (1 - 2 * margin), s->cell->edge[k]);
    }
    return x;
}

/* Would grain i, no larger than those that are placed, meet one of this cell? */
static bool random_start_meets(const struct random_start_placed *t, const struct level *l,
                               const struct random_start_all *s, int64_t i, vec3 x,
                               const int64_t cell[3])
{
    for (int64_t j = l->head[random_start_bucket(l, cell)]; j >= 0; j = t->next[j]) {
        vec3 d = v3_sub(x, s->p.x[j]);
        double most = (radius(s, i) + radius(s, j)) * (1 + FURTHER);
        if (v3_dot(d, d) < most * most) return true;
    }
    return false;
}

static bool is_free_at(const struct random_start_placed *t, const struct random_start_all *s,
                       int64_t i, vec3 x)
{
    for (int k = random_start_level_of(s, i); k >= 0; k--) {
        const struct level *l = &t->level[k];
        int64_t c[3], at[3], up = s->dim == 3;
        if (!l->head) continue;
        cell_of(l, s, x, c);
        for (at[2] = c[2] - up; at[2] <= c[2] + up; at[2]++)
            for (at[1] = c[1] - 1; at[1] <= c[1] + 1; at[1]++)
                for (at[0] = c[0] - 1; at[0] <= c[0] + 1; at[0]++)
                    if (random_start_meets(t, l, s, i, x, at)) return false;
    }
    return true;
}

/* The same with all images of the grain that may meet one in the cell; not in a wall, as large as it will be */
static bool random_start_is_free(const struct random_start_placed *t,
                                 const struct random_start_all *s, int64_t i, vec3 x)
{
    int from[3] = { 0, 0, 0 }, to[3] = { 0, 0, 0 };
    if (obstacles_meet(&s->walls, x, s->p.radius[i] * (1 + FURTHER))) return false;
    if (!s->cell) return is_free_at(t, s, i, x);
    double reach = 2 * radius(s, 0) * (1 + FURTHER);
    for (int k = 0; k < s->dim; k++) {
        double at = v3_dot(s->inverse[k], v3_sub(x, s->cell->origin)) * s->height[k];
        if (!s->cell->repeats[k]) continue;
        to[k] = at < reach, from[k] = -(s->height[k] - at < reach);
    }
    for (int a = from[0]; a <= to[0]; a++)
        for (int b = from[1]; b <= to[1]; b++)
            for (int c = from[2]; c <= to[2]; c++) {
                const int8_t shift[3] = { (int8_t)a, (int8_t)b, (int8_t)c };
                if (!is_free_at(t, s, i, v3_add(x, cell_shift(s->cell->edge, shift)))) return false;
            }
    return true;
}

/* A place in the box, or the cell, where grain i stays inside */
static vec3 random_start_draw_place(const struct random_start_all *s, int64_t i, gsl_rng *rng)
{
    double u[3] = { 0 };
    for (int k = 0; k < s->dim && s->cell; k++) u[k] = gsl_rng_uniform(rng);
    if (s->cell) return in_cell(s, u, s->p.radius[i] * (1 + FURTHER));
    double x[3] = { 0 }, r = s->p.radius[i] * (1 + FURTHER); // as it will be
    for (int k = 0; k < s->dim; k++) {
        double lo = s->box->lo[k] + r, hi = s->box->hi[k] - r;
        x[k] = hi > lo ? lo + (hi - lo) * gsl_rng_uniform(rng) : 0.5 * (lo + hi);
    }
    return v3(x[0], x[1], x[2]);
}

static int add_one_by_one(struct random_start_all *s, double phi, gsl_rng *rng,
                          struct failure *failure)
{
    struct random_start_placed t;
    int64_t all = TRIES_FREE + TRIES_MEAN * s->p.n;
    if (!placed_alloc(&t, s)) {
        random_start_placed_free(&t);
        return failure_set(failure, EX_SOFTWARE, "no memory for a random start");
    }
    for (int64_t i = 0; i < s->p.n && !failure->status; i++) {
        int tries = 0;
        bool found;
        do {
            s->p.x[i] = random_start_draw_place(s, i, rng);
            found = random_start_is_free(&t, s, i, s->p.x[i]);
        } while (!found && ++tries < TRIES && --all > 0);
        if (!found)
            failure_set(
                failure, EX_DATAERR,
                "%lld of %lld bodies found a place at random between the walls; they are to "
                "fill %.3g of the box, of which %.3g is free: a smaller phi or count, or a "
                "wider box",
                (long long)i, (long long)s->p.n, phi * s->walls.free, s->walls.free);
        struct level *l = &t.level[random_start_level_of(s, i)];
        int64_t c[3];
        cell_of(l, s, s->p.x[i], c);
        t.next[i] = l->head[random_start_bucket(l, c)];
        l->head[random_start_bucket(l, c)] = i;
    }
    random_start_placed_free(&t);
    return failure->status;
}

/* ---- growth ---- */

/* m: from a to the image of b that it is near to */
static vec3 random_start_way_of(const struct random_start_all *s, const struct pair *pair)
{
    vec3 d = v3_sub(s->p.x[pair->b], s->p.x[pair->a]);
    return s->cell ? v3_add(d, cell_shift(s->cell->edge, pair->shift)) : d;
}

/* Pushes the pair apart, to beyond touching; returns its overlap, in radii of the smaller. */
static double push_pair(struct random_start_all *s, const struct pair *pair)
{
    int64_t a = pair->a, b = pair->b;
    vec3 d = random_start_way_of(s, pair);
    double touch = radius(s, a) + radius(s, b), d2 = v3_dot(d, d);
    double wanted = touch * (1 + FURTHER);
    if (d2 >= wanted * wanted) return 0;
    double distance = sqrt(d2), ma = s->p.mass[a], mb = s->p.mass[b];
    if (!(distance > 0)) d = v3(0, 1, 0), d2 = 1; // in one place: any way out will do
    vec3 way = v3_scale((wanted - distance) / (sqrt(d2) * (ma + mb)), d);
    s->p.x[a] = v3_axpy(s->p.x[a], -mb, way);
    s->p.x[b] = v3_axpy(s->p.x[b], ma, way);
    return (touch - distance) / fmin(radius(s, a), radius(s, b));
}

/* Back into the cell along edges that do not repeat */
static void push_into_cell(struct random_start_all *s, int64_t i)
{
    double r = radius(s, i) * (1 + FURTHER);
    for (int k = 0; k < s->dim; k++) {
        if (s->cell->repeats[k]) continue;
        double margin = fmin(r / s->height[k], 0.5);
        double u = v3_dot(s->inverse[k], v3_sub(s->p.x[i], s->cell->origin));
        double to = fmin(fmax(u, margin), 1 - margin);
        if (to != u) s->p.x[i] = v3_axpy(s->p.x[i], to - u, s->cell->edge[k]);
    }
}

/* Grains that have left the cell are their images inside. */
static void wrap(struct random_start_all *s)
{
    int32_t w[3];
    for (int64_t i = 0; i < s->p.n && s->cell; i++) {
        cell_wraps(s->cell, s->inverse, s->p.x[i], w);
        for (int k = 0; k < 3; k++)
            if (w[k]) s->p.x[i] = v3_axpy(s->p.x[i], -w[k], s->cell->edge[k]);
    }
}

/* Out of the walls that it has come into, by less than off the faces of the box, so that a wall there never counts; how deep
   it was in them, in radii */
static double push_off_walls(struct random_start_all *s, int64_t i)
{
    const double r = radius(s, i), further = 0.5 * FURTHER;
    return fmax(0, obstacles_push(&s->walls, &s->p.x[i], r * (1 + further)) / r - further);
}

/* Back into the box, where it has left it */
static void push_in(struct random_start_all *s, int64_t i)
{
    if (s->cell) {
        push_into_cell(s, i);
        return;
    }
    double r = radius(s, i) * (1 + FURTHER), x[3] = { s->p.x[i].x, s->p.x[i].y, s->p.x[i].z };
    for (int k = 0; k < (s->dim == 2 ? 2 : 3); k++) {
        double lo = s->box->lo[k] + r, hi = s->box->hi[k] - r;
        x[k] = hi > lo ? fmin(fmax(x[k], lo), hi) : 0.5 * (lo + hi);
    }
    s->p.x[i] = v3(x[0], x[1], x[2]);
}

/* Sweeps over the pairs until no overlap is above `most` (smaller radii); *left: the largest. */
static int push_apart(struct random_start_all *s, struct neighbours *near, double most, int sweeps,
                      double *left, struct failure *failure)
{
    double sum = 0;
    for (int64_t i = 0; i < s->p.n; i++) sum += radius(s, i);
    double reach = REACH * sum / (double)(s->p.n ? s->p.n : 1);
    vec3 *listed = malloc(((size_t)s->p.n + 1) * sizeof *listed);
    if (!listed) return failure_set(failure, EX_SOFTWARE, "no memory for a random start");
    bool fresh = false;
    for (int k = 0; k < sweeps; k++) {
        double moved = 0;
        for (int64_t i = 0; i < s->p.n && fresh; i++) {
            vec3 d = v3_sub(s->p.x[i], listed[i]);
            moved = fmax(moved, v3_dot(d, d));
        }
        if (!fresh || moved > 0.2 * reach * reach) { // 0.45 reach: each of a pair
            wrap(s);
            const struct positions at = positions_now(&s->p);
            if (neighbours_find(near, &s->p, &at, reach, false, failure)) break;
            memcpy(listed, s->p.x, (size_t)s->p.n * sizeof *listed);
            fresh = true;
        }
        *left = 0;
        for (int64_t i = 0; i < near->list.n; i++)
            *left = fmax(*left, push_pair(s, &near->list.pair[i]));
        for (int64_t i = 0; i < s->p.n; i++) push_in(s, i);
        for (int64_t i = 0; i < s->p.n; i++) *left = fmax(*left, push_off_walls(s, i));
        if (s->walls.seen > OBSTACLES_SEEN)
            failure_set(failure, EX_DATAERR,
                        "a mesh is much finer than the grains, or crowded: a coarser one");
        if (*left <= most || failure->status) break;
    }
    free(listed);
    return failure->status;
}

/* What overlaps in the end, all pushing done, in smaller radii */
static int worst(struct random_start_all *s, struct neighbours *near, double *left,
                 struct failure *failure)
{
    *left = 0;
    wrap(s);
    const struct positions at = positions_now(&s->p);
    if (neighbours_find(near, &s->p, &at, 0, false, failure)) return failure->status;
    for (int64_t i = 0; i < near->list.n; i++) {
        int64_t a = near->list.pair[i].a, b = near->list.pair[i].b;
        double r = s->p.radius[a] + s->p.radius[b];
        double gap = v3_norm(random_start_way_of(s, &near->list.pair[i])) - r;
        *left = fmax(*left, -gap / fmin(s->p.radius[a], s->p.radius[b]));
    }
    for (int64_t i = 0; i < s->p.n; i++)
        if (obstacles_meet(&s->walls, s->p.x[i], s->p.radius[i])) *left = fmax(*left, FURTHER);
    return 0;
}

/* m: of the box, along the last axis, or of the cell, in which grains of this volume come to rest as dense as
   they are likely to */
static double height_of(const struct random_start_all *s, double volume)
{
    double area = 1;
    for (int k = 0; k < s->dim - 1; k++) area *= s->box->hi[k] - s->box->lo[k];
    return scene_random_height(s->dim, volume, area);
}

/* From s->scale to 1 */
static int random_start_grow(struct random_start_all *s, double phi, struct failure *failure)
{
    struct neighbours near = { 0 };
    double step = pow(s->scale, -1.0 / STEPS), left = 0;
    while (s->scale < 1 && !failure->status) {
        s->scale = fmin(1, s->scale * step);
        push_apart(s, &near, BETWEEN, SWEEPS, &left, failure);
    }
    for (int k = 0; k < 50 && !failure->status; k++) { // the last sweep moves grains, too
        push_apart(s, &near, 0, LAST / 50, &left, failure);
        if (failure->status || worst(s, &near, &left, failure) || left == 0) break;
    }
    if (!failure->status && left > 0)
        failure_set(
            failure, EX_DATAERR,
            "phi %g: the grains do not go in, %.2g of a radius overlaps: they need a height of "
            "about %.4g m along %c",
            phi, left, height_of(s, s->volume), "xyz"[s->dim - 1]);
    neighbours_free(&near);
    return failure->status;
}

/* ---- */

static double random_start_volume(int dim, double r)
{
    double mass, inertia;
    packing_solid(dim, r, 1, &mass, &inertia);
    return mass;
}

static double box_volume(const struct scene_box *b, int dim)
{
    double v = 1;
    for (int k = 0; k < dim; k++) v *= b->hi[k] - b->lo[k];
    return v;
}

/* The radii: `count` of them, or as many as fill phi of the room (m^3, m^2) best. Returns what the balls around
   them fill, which are what is placed; of a count that is too large, what those fill that were drawn. */
static double draw_radii(struct grains *out, const struct scene_bodies *b, int dim, double room,
                         gsl_rng *rng, struct failure *failure)
{
    double filled = 0, least = (double)b->count * random_start_volume(dim, b->size.min) / room;
    int64_t most = b->phi > 0 ? FILL_MOST : b->count;
    if (b->count > FILL_MOST && least > FULL) return least; // none needs to be drawn
    for (int64_t i = 0; i < most; i++) {
        struct grain g = grain_at(v3(0, 0, 0), scene_size_draw(&b->size, rng));
        double v = b->form.fill * random_start_volume(dim, g.r);
        if (b->phi > 0 && filled + v > b->phi * room &&
            filled + v - b->phi * room > b->phi * room - filled)
            break;
        if (grains_add(out, &g, failure)) break;
        filled += v;
        if (b->phi > 0 && filled >= b->phi * room) break;
        if (i >= FILL_MOST && filled > FULL * b->form.fill * room) break;
    }
    if (b->phi > 0 && out->n == FILL_MOST && filled < b->phi * room)
        failure_set(
            failure, EX_DATAERR,
            "phi %g takes more than %d grains of such radii, these fill %.2g: larger ones, or a "
            "smaller box",
            b->phi, FILL_MOST, filled / room);
    return filled / (b->form.fill * room);
}

struct drawn {
    double r;
    int64_t i;
};

static int random_start_larger_first(const void *one, const void *other)
{
    const struct drawn *a = one, *b = other;
    if (a->r != b->r) return a->r > b->r ? -1 : 1;
    return a->i < b->i ? -1 : a->i > b->i;
}

/* The bodies of s, the largest first; from[]: which of the radii each has */
static int sort_radii(struct random_start_all *s, const struct grains *g, struct failure *failure)
{
    int e = packing_init(&s->p, s->dim, g->n, failure);
    if (e) return e;
    struct drawn *d = malloc(((size_t)g->n + 1) * sizeof *d);
    s->from = malloc(((size_t)g->n + 1) * sizeof *s->from);
    if (!d || !s->from) {
        free(d);
        return failure_set(failure, EX_SOFTWARE, "no memory for a random start");
    }
    for (int64_t i = 0; i < g->n; i++) d[i] = (struct drawn){ g->g[i].r, i };
    qsort(d, (size_t)g->n, sizeof *d, random_start_larger_first);
    for (int64_t i = 0; i < g->n; i++) {
        double r = d[i].r / d[0].r;
        s->p.radius[i] = d[i].r, s->from[i] = d[i].i;
        s->p.mass[i] = fmax(s->dim == 3 ? r * r * r : r * r, 1e-300);
    }
    free(d);
    return 0;
}

static double cell_volume(const struct cell *c, int dim)
{
    double v = fabs(v3_dot(c->edge[0], v3_cross(c->edge[1], c->edge[2])));
    return dim == 2 ? v / v3_norm(c->edge[2]) : v;
}

/* The grains are in this cell, at rest, for the search of pairs. */
static int random_start_set_cell(struct random_start_all *s, struct failure *failure)
{
    if (!s->cell) return 0;
    for (int k = 0; k < 3; k++)
        s->p.cell.edge[k] = s->cell->edge[k], s->p.cell.repeats[k] = s->cell->repeats[k];
    s->p.cell.origin = s->cell->origin;
    return cell_repeats(s->cell) ? packing_alloc_images(&s->p, failure) : 0;
}

int random_start(struct grains *out, const struct scene_bodies *b, int dim, const struct cell *cell,
                 const struct packing *walls, gsl_rng *rng, struct failure *failure)
{
    /* cells of the grid count from the corner of b->box, wherever the cell is */
    struct random_start_all s = { .dim = dim, .box = &b->box, .cell = cell, .scale = 1 };
    if (cell) cell_inverse(cell->edge, s.inverse), cell_heights(cell, s.height);
    if (walls && obstacles_init(&s.walls, walls, &b->box, cell, failure)) {
        obstacles_free(&s.walls);
        return failure->status;
    }
    if (!walls) s.walls.free = 1;
    double room = s.walls.free * (cell ? cell_volume(cell, dim) : box_volume(&b->box, dim));
    if (!isfinite(room)) {
        obstacles_free(&s.walls);
        return failure_set(failure, EX_DATAERR,
                           "the box is too large: its volume is not a finite number");
    }
    double phi = draw_radii(out, b, dim, room, rng, failure);
    s.volume = phi * room;
    if (!failure->status && !(phi <= FULL))
        failure_set(
            failure, EX_DATAERR,
            "a random start cannot fill %.3g of its box, of which %.3g is free of walls: at %g it "
            "is %.4g m high",
            phi * s.walls.free, s.walls.free, dim == 2 ? 0.82 : 0.6, height_of(&s, s.volume));
    if (!failure->status && !sort_radii(&s, out, failure) && !random_start_set_cell(&s, failure)) {
        if (phi > LOOSE[dim]) s.scale = pow(LOOSE[dim] / phi, 1.0 / dim);
        if (!add_one_by_one(&s, phi, rng, failure) && s.scale < 1)
            random_start_grow(&s, phi, failure);
        for (int64_t i = 0; i < out->n && !failure->status; i++) out->g[s.from[i]].x = s.p.x[i];
    }
    packing_free(&s.p);
    obstacles_free(&s.walls);
    free(s.from);
    return failure->status;
}
