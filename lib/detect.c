#include "detect.h"

#include <stdlib.h>
#include <string.h>

enum { LEVELS = 40 }; /* a ratio of 2^40 between radii; smaller ones share the last */

struct entry {
    vec3 x; /* predicted */
    double r;
    int32_t cell[3];
    int32_t body;
};

/* The bodies with radii within a factor of two, by cells. */
struct grid {
    double h;            /* m: cell; two bodies of the level that touch are in adjacent ones */
    int64_t n;           /* bodies */
    uint64_t mask;       /* buckets - 1 */
    uint64_t stride[2];  /* of the hash, along y and z; along x it is 1, for locality */
    int64_t *first;      /* [buckets + 1] */
    struct entry *entry; /* [n] by bucket */
};

struct pair {
    int32_t a, b;
};

struct pairs {
    int64_t n, room;
    struct pair *p;
};

static bool pairs_add(struct pairs *s, int32_t a, int32_t b)
{
    if (s->n == s->room) {
        int64_t room = s->room ? 2 * s->room : 1024;
        struct pair *p = realloc(s->p, (size_t)room * sizeof *p);
        if (!p) return false;
        s->p = p, s->room = room;
    }
    s->p[s->n++] = a < b ? (struct pair){ a, b } : (struct pair){ b, a };
    return true;
}

static int32_t cell_of(double x, double h)
{
    double c = floor(x / h), far = 1e9;
    return (int32_t)(c < -far ? -far : c > far ? far : c);
}

static uint64_t bucket(const struct grid *g, int64_t i, int64_t j, int64_t k)
{
    return (uint64_t)i + (uint64_t)j * g->stride[0] + (uint64_t)k * g->stride[1];
}

static int level_of(double r, double rmax)
{
    int level = ilogb(rmax / r);
    return level < LEVELS ? level : LEVELS - 1;
}

/* Strides that make the hash exact when the bodies fill a box, and harmless when they do not. */
static void grid_strides(struct grid *g, const int32_t lo[3], const int32_t hi[3])
{
    uint64_t nx = (uint64_t)((int64_t)hi[0] - lo[0] + 3);
    uint64_t ny = (uint64_t)((int64_t)hi[1] - lo[1] + 3);
    g->stride[0] = nx;
    g->stride[1] = nx * ny;
}

/* Entries (already in g->entry, cells set) sorted by bucket: a counting sort. */
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
    for (int64_t i = 0; i < g->n; i++) { // counted two ahead: after the fill first[b] starts b
        const int32_t *c = g->entry[i].cell;
        g->first[(bucket(g, c[0], c[1], c[2]) & g->mask) + 2]++;
    }
    for (uint64_t b = 0; b < buckets; b++) g->first[b + 2] += g->first[b + 1];
    for (int64_t i = 0; i < g->n; i++) {
        const int32_t *c = g->entry[i].cell;
        sorted[g->first[(bucket(g, c[0], c[1], c[2]) & g->mask) + 1]++] = g->entry[i];
    }
    free(g->entry);
    g->entry = sorted;
    return true;
}

static void grids_free(struct grid *g)
{
    for (int l = 0; l < LEVELS; l++) free(g[l].first), free(g[l].entry);
}

static bool grids_build(struct grid g[LEVELS], const struct packing *p, double gap)
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
        g[l].h = (2 * top[l] + gap) * (1 + 1e-12);
        if (!(g[l].entry = malloc((size_t)g[l].n * sizeof *g[l].entry))) return false;
        for (int k = 0; k < 3; k++) lo[l][k] = INT32_MAX, hi[l][k] = INT32_MIN;
        g[l].n = 0;
    }
    for (int64_t i = 0; i < p->n; i++) {
        int l = level_of(p->radius[i], rmax);
        struct entry *e = &g[l].entry[g[l].n++];
        *e = (struct entry){ packing_predict(p, i), p->radius[i], { 0 }, (int32_t)i };
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

/* The gap between e and f; infinite, without its square root, where they are clearly apart. */
static double ball_gap(const struct entry *e, const struct entry *f, double gap)
{
    vec3 d = v3_sub(f->x, e->x);
    double reach = e->r + f->r + gap, d2 = v3_dot(d, d);
    return d2 > reach * reach * (1 + 1e-12) ? INFINITY : sqrt(d2) - (e->r + f->r);
}

/* What e touches in grid g; in its own grid, those with a higher number only. */
static bool grid_query(const struct grid *g, const struct entry *e, bool own, double gap,
                       const struct packing *p, struct pairs *out)
{
    int32_t c[3] = { cell_of(e->x.x, g->h), cell_of(e->x.y, g->h), cell_of(e->x.z, g->h) };
    for (int64_t k = c[2] - 1; k <= c[2] + 1; k++)
        for (int64_t j = c[1] - 1; j <= c[1] + 1; j++) {
            if (p->dim == 2 && k != c[2]) continue;
            for (int64_t i = c[0] - 1; i <= c[0] + 1; i++) {
                uint64_t b = bucket(g, i, j, k) & g->mask;
                for (int64_t m = g->first[b]; m < g->first[b + 1]; m++) {
                    const struct entry *f = &g->entry[m];
                    if (own && f->body <= e->body) continue;
                    if (f->cell[0] != i || f->cell[1] != j || f->cell[2] != k) continue;
                    if (!(ball_gap(e, f, gap) <= gap)) continue;
                    if (p->mass[e->body] == 0 && p->mass[f->body] == 0) continue;
                    if (!pairs_add(out, e->body, f->body)) return false;
                }
            }
        }
    return true;
}

static bool balls(struct pairs *out, const struct packing *p, double gap)
{
    struct grid g[LEVELS];
    memset(g, 0, sizeof g);
    bool room = grids_build(g, p, gap);
    for (int l = 0; room && l < LEVELS; l++)
        for (int64_t m = 0; room && m < g[l].n; m++)
            for (int b = 0; room && b <= l; b++)
                if (g[b].n) room = grid_query(&g[b], &g[l].entry[m], b == l, gap, p, out);
    grids_free(g);
    return room;
}

/* By (a, b): a counting sort on a, then each a's few by b. */
static bool pairs_sort(struct pairs *s, int64_t bodies)
{
    int64_t *first = calloc((size_t)bodies + 2, sizeof *first);
    struct pair *sorted = calloc((size_t)s->n + 1, sizeof *sorted);
    bool room = first && sorted;
    for (int64_t i = 0; room && i < s->n; i++) first[s->p[i].a + 2]++;
    for (int64_t a = 0; room && a < bodies; a++) first[a + 2] += first[a + 1];
    for (int64_t i = 0; room && i < s->n; i++) sorted[first[s->p[i].a + 1]++] = s->p[i];
    for (int64_t a = 0; room && a < bodies; a++)
        for (int64_t i = first[a] + 1; i < first[a + 1]; i++) {
            struct pair x = sorted[i];
            int64_t k = i;
            for (; k > first[a] && sorted[k - 1].b > x.b; k--) sorted[k] = sorted[k - 1];
            sorted[k] = x;
        }
    free(first);
    if (!room) {
        free(sorted);
        return false;
    }
    free(s->p);
    s->p = sorted, s->room = s->n;
    return true;
}

static bool narrow_wall(struct contacts *out, const struct packing *p, int32_t w, int64_t i,
                        double gap)
{
    const struct wall *wall = &p->wall[w];
    vec3 at = v3_axpy(wall->x, p->t + (1 - p->theta) * p->dt, wall->v), x = packing_predict(p, i);
    double distance = v3_dot(v3_sub(x, at), wall->n), g = distance - p->radius[i];
    if (!(g <= gap) || p->mass[i] == 0) return true;
    struct contact *c = contacts_add(out, -1 - w, (int32_t)i);
    if (!c) return false;
    contact_frame(c, p->dim, wall->n);
    c->gap = g;
    c->x = v3_axpy(x, -distance, wall->n);
    int32_t k = wall->kind * p->kinds + p->kind[i];
    c->mu = p->mu[k], c->en = p->en[k], c->et = p->et[k];
    return true;
}

static bool narrow_ball(struct contacts *out, const struct packing *p, int32_t a, int32_t b)
{
    struct contact *c = contacts_add(out, a, b);
    if (!c) return false;
    vec3 xa = packing_predict(p, a), d = v3_sub(packing_predict(p, b), xa);
    double distance = v3_norm(d);
    // two balls in one place: any direction is as good, one against gravity parts them
    vec3 up = p->dim == 2 ? v3(0, 1, 0) : v3(0, 0, 1);
    contact_frame(c, p->dim, distance > 0 ? v3_scale(1 / distance, d) : up);
    c->gap = distance - (p->radius[a] + p->radius[b]);
    c->x = v3_axpy(xa, p->radius[a] + 0.5 * c->gap, c->n);
    int32_t k = p->kind[a] * p->kinds + p->kind[b];
    c->mu = p->mu[k], c->en = p->en[k], c->et = p->et[k];
    return true;
}

int detect_contacts(struct contacts *out, const struct packing *p, double gap, struct why *why)
{
    struct pairs pairs = { 0 };
    out->n = 0, out->solved = false;
    bool room = balls(&pairs, p, gap) && pairs_sort(&pairs, p->n);
    for (int32_t w = p->walls - 1; room && w >= 0; w--)
        for (int64_t i = 0; room && i < p->n; i++) room = narrow_wall(out, p, w, i, gap);
    for (int64_t i = 0; room && i < pairs.n; i++)
        room = narrow_ball(out, p, pairs.p[i].a, pairs.p[i].b);
    free(pairs.p);
    return room ? 0 : why_set(why, EX_SOFTWARE, "no memory for the contacts");
}
