/* measure/breakage.c: what has broken, and the sizes of grains, to which distributions are fitted. */
#include "measure/ball_part.h"
#include "measure/branch.h"
#include "measure/measures.h"
#include "state/breakable.h"

#include <math.h>
#include <stdlib.h>

enum { EDGES = 51 }; /* sizes from the smallest to the largest, by equal factors */

struct sized {
    double d, mass; /* m, kg */
};

/* The grains that move, in the region, by size; mass[k], number[k]: of those that are smaller than edge k, and of the
   others */
struct grading {
    int64_t n;
    struct sized *grain; /* [n] rising */
    double total;        /* kg */
    double edge[EDGES], passing[EDGES], number[EDGES];
};

static int by_size(const void *a, const void *b)
{
    const double x = ((const struct sized *)a)->d, y = ((const struct sized *)b)->d;
    return x < y ? -1 : x > y;
}

static int grading_of(struct grading *g, const struct snapshot *s, struct failure *failure)
{
    const struct packing *p = s->p;
    double finer = 0;
    *g = (struct grading){ .grain = malloc(((size_t)p->n + 1) * sizeof *g->grain) };
    if (!g->grain) return failure_set(failure, EX_SOFTWARE, "no memory for sizes");
    for (int64_t i = 0; i < p->n; i++)
        if (counts_body(s, i))
            g->grain[g->n++] = (struct sized){ breakage_diameter(p, i), p->mass[i] };
    qsort(g->grain, (size_t)g->n, sizeof *g->grain, by_size);
    for (int64_t i = 0; i < g->n; i++) g->total += g->grain[i].mass;
    const double least = g->n ? g->grain[0].d : 0, most = g->n ? g->grain[g->n - 1].d : 0;
    int64_t at = 0;
    for (int k = 0; k < EDGES; k++) {
        g->edge[k] = k + 1 < EDGES ? least * pow(most / least, k / (EDGES - 1.)) : most;
        for (; at < g->n && g->grain[at].d < g->edge[k]; at++) finer += g->grain[at].mass;
        g->passing[k] = finer / g->total, g->number[k] = (double)(g->n - at);
    }
    return 0;
}

/* m: the size that a part of the mass is smaller than, or has */
static double grading_size(const struct grading *g, double part)
{
    double finer = 0;
    for (int64_t i = 0; i < g->n; i++)
        if ((finer += g->grain[i].mass) >= part * g->total) return g->grain[i].d;
    return g->n ? g->grain[g->n - 1].d : NAN;
}

/* The line y = a + b x of least squares; NaN: there are not two points */
struct line {
    double n, x, y, xx, xy;
};
static void line_add(struct line *l, double x, double y)
{
    l->n++, l->x += x, l->y += y, l->xx += x * x, l->xy += x * y;
}
static double line_slope(const struct line *l)
{
    const double d = l->n * l->xx - l->x * l->x;
    return l->n > 1 && d > 1e-12 * l->n * l->xx ? (l->n * l->xy - l->x * l->y) / d : NAN;
}
/* Where it is 0 */
static double line_root(const struct line *l)
{
    const double b = line_slope(l);
    return (l->x - l->y / b) / l->n;
}

static const struct quantity quantities[] = {
    { "bodies", "1", 1, "number of movable bodies with their centre in the region" },
    { "broken", "1", 1,
      "fraction of the first grains, of materials that break, that have broken, by number" },
    { "fragments", "1", 1, "fraction of the mass in fragments and dust" },
    { "generation", "1", 1, "largest generation" },
    { "dust", "kg", 1, "mass of dust" },
    { "kinetic", "J", 1, "kinetic energy that dust had" },
    { "potential", "J", 1, "potential energy that it had" },
    { "d10", "m", 1, "diameter that 10 % of the mass is smaller than" },
    { "d50", "m", 1, "the same of 50 %" },
    { "d90", "m", 1, "the same of 90 %" },
    { "ggs_size", "m", 1,
      "size modulus k of Gates, Gaudin, Schuhmann: (d/k)^a of the mass is smaller than d" },
    { "ggs_exponent", "1", 1, "its exponent a" },
    { "rr_size", "m", 1,
      "size l of Rosin, Rammler: 1 - exp(-(d/l)^b) of the mass is smaller than d" },
    { "rr_exponent", "1", 1, "its exponent b" },
    { "dimension", "1", 1,
      "fractal dimension D: the number of grains larger than d goes with d^-D" },
    { 0 },
};

/* The fits, over the edges where what they take the logarithm of is neither 0 nor infinite */
static void put_fits(double **at, struct table *t, const struct grading *g)
{
    struct line ggs = { 0 }, rr = { 0 }, fractal = { 0 };
    for (int k = 0; k < EDGES; k++) {
        const double x = log(g->edge[k]), P = g->passing[k];
        if (P >= 0.01 && P <= 0.9) line_add(&ggs, x, log(P));
        if (P >= 0.01 && P <= 0.99) line_add(&rr, x, log(-log1p(-P)));
        if (g->number[k] >= 5) line_add(&fractal, x, log(g->number[k]));
    }
    const double a = line_slope(&ggs), b = line_slope(&rr);
    if (isnan(a) || isnan(b)) table_null(t, "fits need grains of several sizes");
    put(at, exp(line_root(&ggs))), put(at, a);
    put(at, exp(line_root(&rr))), put(at, b);
    put(at, -line_slope(&fractal));
}

/* Of the mass that there is and that has become dust */
static double fragments_of(const struct snapshot *s, double dust, double total, double *generation)
{
    const struct packing *p = s->p;
    double mass = dust;
    *generation = 0;
    for (int64_t i = 0; p->generation && i < p->n; i++) {
        if (!counts_body(s, i) || p->generation[i] == 0) continue;
        mass += p->mass[i], *generation = fmax(*generation, p->generation[i]);
    }
    return mass / (total + dust);
}

static int breakage_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    struct grading g;
    const struct packing *p = s->p;
    const struct broken b = breakage_total(p);
    double *at = table_row(t, failure), whole = 0, generation = 0;
    if (!at || grading_of(&g, s, failure)) return failure->status;
    put(&at, (double)g.n);
    for (int64_t i = 0; i < p->n; i++)
        whole += p->breakage && p->breakage[p->material[i]].strength > 0 && p->mass[i] > 0 &&
                 snapshot_body(s, i) && p->generation[i] == 0;
    const double mass = fragments_of(s, b.dust, g.total, &generation), broken = (double)b.originals;
    put(&at, whole + broken > 0 ? broken / (whole + broken) : 0), put(&at, mass);
    put(&at, generation), put(&at, b.dust), put(&at, b.kinetic), put(&at, b.potential);
    if (g.n) {
        put(&at, grading_size(&g, 0.1)), put(&at, grading_size(&g, 0.5));
        put(&at, grading_size(&g, 0.9));
        put_fits(&at, t, &g);
    } else {
        table_null(t, "no body that moves is in the region");
    }
    free(g.grain);
    return 0;
}

const struct measure measure_breakage = {
    .name = "breakage",
    .help = "broken grains, dust, sizes and fits to their distribution",
    .quantity = quantities,
    .keeps_to = KEEPS_TO_BODIES,
    .rows = breakage_rows,
};

/* ---- the grading curve ---- */

static const struct quantity curve[] = {
    { "size", "m", 1, "diameter d, that of the ball or disc of the volume of a grain" },
    { "passing", "1", 1, "fraction of the mass of grains smaller than d" },
    { "larger", "1", 1, "number of grains that are not" },
    { 0 },
};

static int grading_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    struct grading g;
    if (grading_of(&g, s, failure)) return failure->status;
    for (int k = 0; k < EDGES && g.n; k++) {
        double *at = table_row(t, failure);
        if (!at) break;
        put(&at, g.edge[k]), put(&at, g.passing[k]), put(&at, g.number[k]);
    }
    if (!g.n) table_null(t, "no body that moves is in the region");
    free(g.grain);
    return failure->status;
}

const struct measure measure_grading = {
    .name = "grading",
    .help = "grading curve: mass of grains smaller than a size",
    .quantity = curve,
    .keeps_to = KEEPS_TO_BODIES,
    .list = true,
    .rows = grading_rows,
};
