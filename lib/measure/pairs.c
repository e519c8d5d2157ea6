/*
 * measure/pairs.c: the pair correlation g(r): how many bodies there are at a distance, over how many
 * there would be were they scattered evenly. Pairs that a border leaves out are made up for by the
 * part of all directions in which a partner is inside [Ohser 1983, the isotropised set covariance].
 */
#include "measure/measures.h"
#include "measure/near.h"

#include <math.h>
#include <stdlib.h>

static const struct quantity quantities[] = {
    { "from", "m", 1, "lower end of the bin of distances of centres" },
    { "to", "m", 1, "upper end of the bin" },
    { "pairs", "1", 1, "number of pairs of bodies, each counted once" },
    { "g", "1", 1, "pairs over their expected number for a uniform distribution" },
    { 0 },
};

static void window(struct scatter *a, const struct snapshot *s)
{
    const struct region *r = &s->region;
    double lo[3] = { INFINITY, INFINITY, INFINITY }, hi[3] = { -INFINITY, -INFINITY, -INFINITY };
    for (int64_t i = 0; i < a->n; i++) {
        const double x[3] = { a->x[i].x, a->x[i].y, a->x[i].z };
        for (int k = 0; k < 3; k++) lo[k] = fmin(lo[k], x[k]), hi[k] = fmax(hi[k], x[k]);
    }
    a->volume = r->period.volume;
    for (int k = 0; k < 3 && k < s->p->dim; k++) {
        a->size[k] = r->all ? hi[k] - lo[k] : r->hi[k] - r->lo[k];
        if (r->period.any && s->p->cell.repeats[k])
            a->size[k] = INFINITY;
        else
            a->volume *= a->size[k];
    }
}

/* m^3, m^2: the integral from 0 to r of the surface of a sphere of that radius, times the part of its
   directions in which the window reaches as far */
static double expected(const struct scatter *a, int dim, double r)
{
    const double b[3] = { 1 / a->size[0], 1 / a->size[1], dim == 3 ? 1 / a->size[2] : 0 };
    double one = b[0] + b[1] + b[2], two = b[0] * b[1] + b[1] * b[2] + b[2] * b[0];
    if (dim == 2)
        return 2 * M_PI * r * r * (0.5 - 2 * r * one / (3 * M_PI) + r * r * two / (4 * M_PI));
    return 4 * M_PI * r * r * r *
           (1.0 / 3 - r * one / 8 + 2 * r * r * two / (15 * M_PI) -
            r * r * r * b[0] * b[1] * b[2] / (24 * M_PI));
}

/* Counts by distance, each pair twice; false: bodies crowd */
static bool pairs_count(const struct scatter *a, const struct near *g, int64_t *counts,
                        int64_t bins)
{
    int64_t looked = 0, most = ((int64_t)1 << 26) + 20000 * a->seekers;
    for (int64_t i = 0; i < a->seekers && looked <= most; i++)
        looked += near_count(g, a->x[i], counts, bins);
    return looked <= most;
}

static void pairs_fill(struct table *t, const struct snapshot *s, const struct scatter *a,
                       double reach, const int64_t *counts, struct failure *failure)
{
    double bins = (double)s->asked->bins, n = (double)a->seekers, least = INFINITY;
    for (int k = 0; k < 3 && k < s->p->dim; k++) least = fmin(least, a->size[k]);
    double others = isinf(least) ? n : n - 1; // a body's own images are partners, too
    if (reach > least) table_null(t, "distances beyond the smallest side of the region");
    for (int64_t k = 0; k < s->asked->bins; k++) {
        double from = reach * (double)k / bins, to = reach * (double)(k + 1) / bins;
        double even =
            n * others / a->volume * (expected(a, s->p->dim, to) - expected(a, s->p->dim, from));
        double *at = table_row(t, failure);
        if (!at) return;
        put(&at, from), put(&at, to), put(&at, 0.5 * (double)counts[k]);
        put(&at, to <= least ? (double)counts[k] / even : NAN);
    }
}

static const char *impossible(const struct snapshot *s, const struct scatter *a, double reach)
{
    const struct period *m = &s->region.period;
    if (a->seekers < 2) return "fewer than two bodies";
    if (!(a->volume > 0)) return "the bodies have no extent along an axis";
    for (int k = 0; m->any && k < 3; k++)
        if (m->cell->repeats[k] && reach * v3_norm(m->inverse[k]) > 2)
            return "distances beyond two of the cell's edges";
    if (m->any && !s->region.all) return "a box in a periodic cell";
    return NULL;
}

static int pairs_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    const struct packing *p = s->p;
    struct scatter a = { .size = { INFINITY, INFINITY, INFINITY } };
    struct near g = { 0 };
    int64_t *counts = calloc((size_t)s->asked->bins, sizeof *counts);
    double reach = s->asked->distance;
    bool room = counts;
    for (int64_t i = 0; i < p->n; i++) {
        if (!(s->asked->distance > 0)) reach += 6 * p->radius[i] / (double)p->n;
        if (snapshot_body(s, i) && region_holds(&s->region, p->x[i]))
            room = room && scatter_add(&a, p->x[i], i);
    }
    a.seekers = a.n;
    window(&a, s);
    const char *reason = impossible(s, &a, reach);
    if (!reason && room && s->region.period.any)
        room = scatter_images(&a, &s->region.period, reach);
    if (!reason && room) room = near_init(&g, a.x, a.n, reach);
    if (!reason && room && !pairs_count(&a, &g, counts, s->asked->bins))
        reason = "too many bodies close together";
    if (reason)
        table_null(t, "%s", reason);
    else if (room)
        pairs_fill(t, s, &a, reach, counts, failure);
    near_free(&g), scatter_free(&a), free(counts);
    return room ? failure->status
                : failure_set(failure, EX_SOFTWARE, "no memory for pairs of bodies");
}

const struct measure measure_pairs = {
    .name = "pairs",
    .help = "pair correlation g(r)",
    .quantity = quantities,
    .keeps_to = KEEPS_TO_BODIES,
    .list = true,
    .rows = pairs_rows,
};
