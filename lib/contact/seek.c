/* contact/seek.c: pairs sought in grids, also from images, by threads [contact/seek.h]. */
#include "contact/seek.h"

#include "base/array.h"
#include "base/team.h"
#include "contact/grid.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum {
    SEEKERS = 512 /* bodies whose search is worth a thread: 100 us */
};

/* Balls in one place are all each other's neighbours: no heap has so many, whatever its sizes. */
enum {
    CROWD_BODY = 256,     /* pairs a body: a heap has 6, with the widest spare 30 */
    CROWD_LEAST = 1 << 18 /* and pairs that any packing may have: seconds of work */
};

static int64_t crowd(const struct pairs *s)
{
    return CROWD_LEAST + CROWD_BODY * s->bodies;
}

/* a, moved by `shift` edges, is near b. */
static bool pairs_add(struct pairs *s, int32_t a, int32_t b, const int8_t shift[3])
{
    if (s->n >= crowd(s)) return false;
    if (!array_grow(&s->pair, &s->room, s->n + 1, sizeof *s->pair)) return false;
    struct pair *new = &s->pair[s->n++];
    *new = a < b ? (struct pair){ .a = a, .b = b } : (struct pair){ .a = b, .b = a };
    for (int k = 0; k < 3; k++) new->shift[k] = (int8_t)(a < b ? -shift[k] : shift[k]);
    return true;
}

/* ---- the search ---- */

/* A body, or an image of it, that looks for others near it */
struct seeker {
    const struct packing *p;
    const struct grid_entry *e; /* the body */
    vec3 x;                     /* m: where it looks from, */
    int8_t shift[3];            /* so many edges from the body */
    double reach;               /* m: the largest gap of a pair to list */
    struct pairs *out;
};

static bool near(const struct seeker *s, const struct grid_entry *f)
{
    vec3 d = v3_sub(f->x, s->x);
    double most = s->e->r + f->r + s->reach;
    return v3_dot(d, d) <= most * most * (1 + 1e-12);
}

/* The cells i0 .. i1 of line (j, k) along x */
struct line {
    int64_t i0, i1, j, k;
};

/* Lists those of entries first .. end-1 that are in the line. Returns false, as all that look do, when memory is
   short. */
static bool seek_look_at(const struct seeker *s, const struct grid *g, int64_t first, int64_t end,
                         struct line l)
{
    for (const struct grid_entry *f = g->entry + first; f < g->entry + end; f++) {
        if (f->cell[0] < l.i0 || f->cell[0] > l.i1 || f->cell[1] != l.j || f->cell[2] != l.k)
            continue;
        if (!near(s, f)) continue;
        if (!packing_may_meet(s->p, s->e->body, f->body)) continue;
        if (f->body == s->e->body) continue; // its image, and the wide reach of a list that is kept
        if (!pairs_add(s->out, s->e->body, f->body, s->shift)) return false;
    }
    return true;
}

/* The buckets of a line are consecutive, the first after the last. */
static bool look_along(const struct seeker *s, const struct grid *g, struct line l)
{
    uint64_t b0 = grid_bucket(g, l.i0, l.j, l.k), b1 = grid_bucket(g, l.i1, l.j, l.k);
    if (b0 <= b1) return seek_look_at(s, g, g->first[b0], g->first[b1 + 1], l);
    return seek_look_at(s, g, g->first[b0], g->n, l) && seek_look_at(s, g, 0, g->first[b1 + 1], l);
}

/* Bodies near entry m of g in g itself: half of the cells around, so that a pair is found once. */
static bool look_here(const struct seeker *s, const struct grid *g, int64_t m)
{
    int64_t i = s->e->cell[0], j = s->e->cell[1], k = s->e->cell[2];
    int64_t end = g->first[grid_bucket(g, i, j, k) + 1];
    if (!seek_look_at(s, g, m + 1, end, (struct line){ i, i, j, k }) ||
        !look_along(s, g, (struct line){ i + 1, i + 1, j, k }) ||
        !look_along(s, g, (struct line){ i - 1, i + 1, j + 1, k }))
        return false;
    for (int64_t l = j - 1; l <= j + 1 && s->p->dim == 3; l++)
        if (!look_along(s, g, (struct line){ i - 1, i + 1, l, k + 1 })) return false;
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
            if (!look_along(s, g, (struct line){ i - 1, i + 1, l, m })) return false;
    return true;
}

/* ---- images ---- */

/* The cell as the search sees it: how many edges from the origin the bodies are, u = inverse . x */
struct seek_lattice {
    const vec3 *edge;    /* [3] m */
    const bool *repeats; /* [3] */
    vec3 inverse[3];     /* 1/m */
    double lo[3], hi[3]; /* of u over all bodies */
};

static double seek_edges_along(const struct seek_lattice *c, int k, vec3 x)
{
    return v3_dot(c->inverse[k], x);
}

static struct seek_lattice seek_lattice_of(const struct packing *p, const vec3 *x,
                                           const vec3 edge[3])
{
    struct seek_lattice c = { .edge = edge, .repeats = p->cell.repeats };
    cell_inverse(edge, c.inverse);
    for (int k = 0; k < 3; k++) c.lo[k] = INFINITY, c.hi[k] = -INFINITY;
    for (int64_t i = 0; i < p->n; i++)
        for (int k = 0; k < 3; k++) {
            double u = seek_edges_along(&c, k, x[i]);
            c.lo[k] = dmin(c.lo[k], u), c.hi[k] = dmax(c.hi[k], u);
        }
    return c;
}

/* Bodies that are not brought back into the cell have so many images near them that the search would
   not end. */
static bool is_wrapped(const struct seek_lattice *c)
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
                             const struct seek_lattice *c)
{
    int lo[3], hi[3], n[3];
    for (int k = 0; k < 3; k++) {
        double u = seek_edges_along(c, k, s.e->x), reach = g->h * v3_norm(c->inverse[k]);
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

/* By (a, b, shift): a counting sort by a, then the few pairs of each a. */
bool pairs_sort(struct pairs *s)
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
    const struct grid *g;         /* [level + 1] */
    const struct seek_lattice *c; /* NULL: nothing repeats */
    int level;
    pthread_mutex_t lock; /* of what follows */
    struct pairs *out;
    bool failed;
    int64_t from; /* the first body of the part that looks */
};

/* The pairs of a part join the others: in any order, for they are sorted in the end. */
static bool pairs_join(struct pairs *s, struct pairs *part)
{
    if (!s->n) { // all of them, mostly
        free(s->pair);
        s->pair = part->pair, s->n = part->n, s->room = part->room;
        part->pair = NULL;
        return true;
    }
    if (s->n + part->n > crowd(s)) return s->n = crowd(s), false;
    if (!array_grow(&s->pair, &s->room, s->n + part->n, sizeof *s->pair)) return false;
    if (part->n) memcpy(s->pair + s->n, part->pair, (size_t)part->n * sizeof *part->pair);
    s->n += part->n;
    return true;
}

static void search_some(void *arg, int64_t first, int64_t end)
{
    struct search *o = arg;
    const struct grid *g = o->g;
    const int l = o->level;
    struct pairs part = { .bodies = o->out->bodies };
    bool found = true;
    for (int64_t m = o->from + first; found && m < o->from + end; m++) {
        const struct grid_entry *e = &g[l].entry[m];
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
static bool make_list(struct pairs *s, const struct packing *p, const vec3 *x,
                      const struct seek_lattice *c)
{
    struct grid g[LEVELS];
    memset(g, 0, sizeof g);
    struct search o = {
        .p = p, .g = g, .c = c, .lock = PTHREAD_MUTEX_INITIALIZER, .out = s, .failed = false
    };
    o.failed = !grids_build(g, p, x, s->reach);
    s->n = 0;
    const int64_t parts = s->parts > 1 ? s->parts : 1, part = s->parts > 1 ? s->part : 0;
    for (o.level = 0; !o.failed && o.level < LEVELS; o.level++) {
        const int64_t n = g[o.level].n;
        o.from = n * part / parts;
        team_share(team_size(), n * (part + 1) / parts - o.from, SEEKERS, search_some, &o);
    }
    grids_free(g);
    return !o.failed && pairs_sort(s);
}

int seek_pairs(struct pairs *s, const struct packing *p, const vec3 *x, const vec3 edge[3],
               struct failure *failure)
{
    bool images = cell_repeats(&p->cell);
    struct seek_lattice c = { 0 };
    if (images) c = seek_lattice_of(p, x, edge);
    if (images && !is_wrapped(&c))
        return failure_set(
            failure, EX_DATAERR,
            "bodies are more than three cells apart: some move through the cell in a step");
    if (make_list(s, p, x, images ? &c : NULL)) return 0;
    return s->n < crowd(s)
               ? failure_set(failure, EX_SOFTWARE, "no memory for the neighbours")
               : failure_set(failure, EX_DATAERR,
                             "more than %lld pairs of neighbours: bodies in one place, or "
                             "a wide gap",
                             (long long)crowd(s));
}
