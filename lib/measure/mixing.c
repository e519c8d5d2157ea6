/*
 * measure/mixing.c: how well bodies of one material, or large ones, are mixed with the others. The region is divided into
 * samples of the same size. A sample counts by its bodies, so that those at a border, which hold few, count little:
 *
 *     s^2 = sum n_k (p_k - p)^2 / N,   s_0^2 = p (1 - p),   s_R^2 = p (1 - p) K/N,
 *
 * the variance of the samples' shares, that of what is fully apart, and the expected one of N bodies at random in K
 * samples [Lacey 1954; Danckwerts 1952].
 */
#include "measure/branch.h"
#include "measure/measures.h"
#include "measure/near.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double SAMPLE_DIAMETERS =
    3; /* a sample of some 20 bodies, as Lacey's index is mostly taken */
static const double SAMPLES_MOST = 1e8;

static const struct quantity quantities[] = {
    { "bodies", "1", 1, "number of movable bodies with their centre in the region" },
    { "tracers", "1", 1, "number of those that are tracers, see --tracer" },
    { "samples", "1", 1, "number of samples that contain a body" },
    { "sample_bodies", "1", 1, "mean number of bodies in a sample" },
    { "variance", "1", 1, "variance of the fraction of tracers in the samples" },
    { "lacey", "1", 1, "Lacey's index: 0 segregated, 1 random, above 1 ordered" },
    { "intensity", "1", 1, "Danckwerts' intensity of segregation: 1 segregated, 0 equal samples" },
    { "neighbours", "1", 1,
      "unlike pairs of nearest neighbours over their expected number at random" },
    { "segregation", "1", 1,
      "mean height of tracers above that of the others, -1 to 1, 1 if segregated" },
    { 0 },
};

/* ---- which bodies ---- */

/* The bodies that count, and which of them are tracers */
struct mixture {
    int64_t n, tracers;
    int64_t *body; /* [n] rows of the packing */
    bool *tracer;  /* [n] */
};

static void mixture_free(struct mixture *m)
{
    free(m->body), free(m->tracer);
}

static bool mixture_gather(struct mixture *m, const struct snapshot *s)
{
    size_t most = (size_t)s->p->n + 1;
    m->body = malloc(most * sizeof *m->body), m->tracer = calloc(most, sizeof *m->tracer);
    for (int64_t i = 0; m->body && m->tracer && i < s->p->n; i++)
        if (counts_body(s, i)) m->body[m->n++] = i;
    return m->body && m->tracer;
}

/* -1: no such material */
static int32_t mixing_material_named(const struct packing *p, const char *name)
{
    for (int32_t k = 0; k < p->materials; k++)
        if (!strcmp(p->material_name[k], name)) return k;
    return -1;
}

/* Tracers are of a material, or larger than the mean. Where nobody has said which, the material of the first body, unless all
   are of one material. */
static void mixture_divide(struct mixture *m, const struct snapshot *s)
{
    const struct packing *p = s->p;
    const char *name = s->asked->tracer;
    int32_t material = *name && strcmp(name, "large") ? mixing_material_named(p, name) : -1;
    double mean = 0;
    bool alike = true;
    for (int64_t k = 0; k < m->n; k++) {
        mean += p->radius[m->body[k]] / (double)m->n;
        alike = alike && p->material[m->body[k]] == p->material[m->body[0]];
    }
    if (!*name && m->n && !alike) material = p->material[m->body[0]];
    for (int64_t k = 0; k < m->n; k++) {
        const int64_t i = m->body[k];
        m->tracer[k] =
            material >= 0 ? p->material[i] == material : p->radius[i] > mean * (1 + 1e-12);
        m->tracers += m->tracer[k];
    }
}

/* ---- samples ---- */

/* The region in equal parts: along edges of a periodic cell in parts of these, else along the axes */
struct samples {
    int64_t n[3], all;
    int32_t *bodies, *tracers; /* [all] */
};

static double mixing_mean_diameter(const struct mixture *m, const struct packing *p)
{
    double sum = 0;
    for (int64_t k = 0; k < m->n; k++) sum += 2 * p->radius[m->body[k]] / (double)m->n;
    return sum;
}

static bool along_edge(const struct snapshot *s, int k)
{
    return s->region.all && s->region.period.any && s->p->cell.repeats[k];
}

/* Returns why there are none, or NULL; memory: bodies is NULL. */
static const char *samples_init(struct samples *y, const struct snapshot *s,
                                const struct mixture *m)
{
    const struct region *r = &s->region;
    double wide = s->asked->sample, all = 1;
    *y = (struct samples){ { 1, 1, 1 }, 1, NULL, NULL };
    if (!(wide > 0)) wide = SAMPLE_DIAMETERS * mixing_mean_diameter(m, s->p);
    for (int k = 0; k < s->p->dim; k++) {
        double size = along_edge(s, k) ? 1 / v3_norm(r->period.inverse[k]) : r->hi[k] - r->lo[k];
        double parts = fmax(ceil(size / wide * (1 - 1e-9)), 1);
        if (!(size > 0)) return "the region has no volume";
        all *= parts;
        if (!(all <= SAMPLES_MOST)) return "--sample makes more than 1e8 samples";
        y->n[k] = (int64_t)parts, y->all *= y->n[k];
    }
    y->bodies = calloc((size_t)y->all, sizeof *y->bodies);
    y->tracers = calloc((size_t)y->all, sizeof *y->tracers);
    return NULL;
}

static int64_t mixing_sample_of(const struct samples *y, const struct snapshot *s, vec3 x)
{
    const struct region *r = &s->region;
    const double at[3] = { x.x, x.y, x.z };
    int64_t place[3] = { 0, 0, 0 };
    for (int k = 0; k < 3 && k < s->p->dim; k++) {
        double part = (at[k] - r->lo[k]) / (r->hi[k] - r->lo[k]);
        if (along_edge(s, k)) {
            part = v3_dot(r->period.inverse[k], v3_sub(x, s->p->cell.origin));
            part -= floor(part);
        }
        place[k] = (int64_t)(fmin(fmax(part, 0), 1) * (double)y->n[k]);
        if (place[k] == y->n[k]) place[k]--;
    }
    return (place[2] * y->n[1] + place[1]) * y->n[0] + place[0];
}

/* samples, sample_bodies, variance, lacey, intensity */
static void put_samples(double **at, struct table *t, struct samples *y, const struct snapshot *s,
                        const struct mixture *m)
{
    const double n = (double)m->n, p = (double)m->tracers / n;
    double held = 0, square = 0;
    for (int64_t k = 0; k < m->n; k++) {
        const vec3 x = s->p->x[m->body[k]];
        struct region_walk w = region_walk(&s->region, x, 0);
        for (vec3 image; region_next(&w, &s->region, x, &image);) {
            if (!s->region.all && !region_holds(&s->region, image)) continue;
            int64_t place = mixing_sample_of(y, s, image);
            y->bodies[place]++, y->tracers[place] += m->tracer[k];
            break;
        }
    }
    for (int64_t k = 0; k < y->all; k++) {
        if (!y->bodies[k]) continue;
        const double share = (double)y->tracers[k] / y->bodies[k];
        held++, square += y->bodies[k] * (share - p) * (share - p);
    }
    const double variance = square / n, apart = p * (1 - p), random = apart * held / n;
    put(at, held), put(at, n / held), put(at, variance);
    if (!(held < n)) table_null(t, "no sample holds two bodies: --sample is too small");
    put(at, held < n ? (apart - variance) / (apart - random) : NAN), put(at, variance / apart);
}

/* ---- neighbours ---- */

enum { ROUNDS_MOST = 60 };

/* The nearest neighbours in space: as many as balls touch in a dense packing */
static int nearest(const struct packing *p)
{
    return p->dim == 2 ? 6 : 12;
}

/* The centres that count, and in a cell their images within `reach`; of[] are rows of the mixture. */
static bool mixing_gather(struct scatter *a, struct near *g, const struct snapshot *s,
                          const struct mixture *m, double reach)
{
    bool room = true;
    *a = (struct scatter){ 0 };
    for (int64_t k = 0; k < m->n && room; k++) room = scatter_add(a, s->p->x[m->body[k]], k);
    a->seekers = a->n;
    if (room && s->region.period.any && s->region.all)
        room = scatter_images(a, &s->region.period, reach);
    return room && near_init(g, a->x, a->n, reach);
}

/* Does a search as far as this see all there is, or as much as images are made of? */
static bool sees_all(const struct snapshot *s, double reach)
{
    const struct region *r = &s->whole;
    double far = 0;
    for (int k = 0; k < 3; k++) {
        if (r->period.any && s->p->cell.repeats[k] && reach * v3_norm(r->period.inverse[k]) > 1)
            return true;
        far += fmax(r->hi[k] - r->lo[k], 0);
    }
    return reach > far;
}

/* The sum over bodies of the part of their nearest neighbours that is unlike them. Who has found too few looks
   twice as far in the next round. *looked grows without end where bodies crowd. False when memory is short. */
static bool unlike(double *sum, const struct snapshot *s, const struct mixture *m, int64_t *looked)
{
    const int64_t most = ((int64_t)1 << 26) + 20000 * m->n;
    const int wanted = nearest(s->p);
    bool *found = calloc((size_t)m->n + 1, sizeof *found), room = found;
    double reach = 1.5 * mixing_mean_diameter(m, s->p);
    int64_t left = m->n;
    for (int round = 0; room && left > 0 && round < ROUNDS_MOST && *looked <= most; round++) {
        struct scatter a;
        struct near g = { 0 };
        const bool last = sees_all(s, reach) || round == ROUNDS_MOST - 1;
        room = mixing_gather(&a, &g, s, m, reach);
        for (int64_t k = 0; room && k < m->n && *looked <= most; k++) {
            int64_t of[NEAREST_MOST];
            if (found[k]) continue;
            int n = near_nearest(&g, a.x[k], wanted, of, looked), others = 0;
            if (n < wanted && !last) continue;
            for (int l = 0; l < n; l++) others += m->tracer[a.of[of[l]]] != m->tracer[k];
            *sum += n ? (double)others / n : 0, found[k] = true, left--;
        }
        near_free(&g), scatter_free(&a);
        reach *= 2;
    }
    free(found);
    return room;
}

static bool put_neighbours(double **at, struct table *t, const struct snapshot *s,
                           const struct mixture *m)
{
    const double n = (double)m->n, p = (double)m->tracers / n;
    double sum = 0;
    int64_t looked = 0;
    if (!unlike(&sum, s, m, &looked)) return false;
    const bool crowd = looked > ((int64_t)1 << 26) + 20000 * m->n;
    if (crowd) table_null(t, "too many bodies close together: neighbours are not counted");
    put(at, crowd ? NAN : sum / n / (2 * p * (1 - p)));
    return true;
}

/* ---- heights ---- */

/* m: along up, or the axis that layers are asked along */
static double mixing_height(const struct snapshot *s, int axis, int64_t i)
{
    const vec3 x = s->p->x[i], d = v3_sub(x, s->asked->point);
    return axis == 3 ? hypot(d.x, d.y) : axis == 0 ? x.x : axis == 1 ? x.y : x.z;
}

/* Fully apart and spread evenly over a height H, the two means are H/2 apart; H^2/12 is the variance. */
static void put_segregation(double **at, struct table *t, const struct snapshot *s,
                            const struct mixture *m)
{
    const int axis = snapshot_axis(s);
    const double n = (double)m->n, nt = (double)m->tracers;
    double sum = 0, tracers = 0, square = 0;
    if (axis >= s->p->dim && axis < 3) {
        table_null(t, "in the plane there are no heights along z");
        return;
    }
    for (int64_t k = 0; k < m->n; k++) {
        double h = mixing_height(s, axis, m->body[k]);
        sum += h, tracers += m->tracer[k] ? h : 0;
    }
    for (int64_t k = 0; k < m->n; k++) {
        double d = mixing_height(s, axis, m->body[k]) - sum / n;
        square += d * d;
    }
    if (!(square > 0)) table_null(t, "all bodies are at the same height");
    put(at, square > 0 ? (tracers / nt - (sum - tracers) / (n - nt)) / sqrt(3 * square / n) : NAN);
}

static int mixing_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    struct mixture m = { 0 };
    struct samples y = { { 0 }, 0, NULL, NULL };
    double *at = table_row(t, failure);
    const char *reason = NULL;
    if (!at) return failure->status;
    bool room = mixture_gather(&m, s);
    if (room && !m.n) reason = "no body that moves is in the region";
    if (room && !reason) {
        mixture_divide(&m, s);
        put(&at, (double)m.n), put(&at, (double)m.tracers);
        if (!m.tracers || m.tracers == m.n)
            reason = "all bodies are of one sort: --tracer MATERIAL, or large";
    }
    if (room && !reason) reason = samples_init(&y, s, &m);
    if (room && !reason) room = y.bodies && y.tracers;
    if (room && !reason) {
        put_samples(&at, t, &y, s, &m);
        room = put_neighbours(&at, t, s, &m);
        if (room) put_segregation(&at, t, s, &m);
    }
    if (reason) table_null(t, "%s", reason);
    free(y.bodies), free(y.tracers), mixture_free(&m);
    return room ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for mixing");
}

const struct measure measure_mixing = {
    .name = "mixing",
    .help = "mixing of the bodies of one material, or of large ones, with the others",
    .quantity = quantities,
    .rows = mixing_rows,
};
