/* measure/friction.c: forces of contacts, their distributions, and how much of friction is used. */

#include "measure/branch.h"
#include "measure/measures.h"
#include "measure/table.h"
#include "solve/local.h"

#include <gsl/gsl_histogram.h>
#include <math.h>
#include <stdlib.h>

/* How numbers are distributed, by GSL's histograms. */

/* The quantities of a distribution of numbers called "from" and "to" with this unit */
#define HISTOGRAM_QUANTITIES(unit, what)                                                           \
    { "from", unit, 1, "lower end of the bin, " what }, { "to", unit, 1, "upper end of the bin" }, \
        { "contacts", "1", 1, "number of contacts in the bin" },                                   \
    {                                                                                              \
        "density", "1", 1, "probability density: its integral is 1"                                \
    }

/* A row for each of `bins` bins of the same width from 0 to `most`, which is in the last.
   Returns 0 or EX_SOFTWARE. */
static int histogram_rows(struct table *t, const double *x, int64_t n, double most, int64_t bins,
                          struct failure *failure);

static int histogram_rows(struct table *t, const double *x, int64_t n, double most, int64_t bins,
                          struct failure *failure)
{
    // GSL's own allocation ends the program when memory is short
    gsl_histogram h = { (size_t)bins, calloc((size_t)bins + 1, sizeof(double)),
                        calloc((size_t)bins + 1, sizeof(double)) };
    if (!h.range || !h.bin) {
        free(h.range), free(h.bin);
        return failure_set(failure, EX_SOFTWARE, "no memory for a histogram");
    }
    gsl_histogram_set_ranges_uniform(&h, 0, most);
    // the largest number belongs to the last bin, whose end GSL does not count to it
    h.range[bins] = nextafter(most, INFINITY);
    for (int64_t i = 0; i < n; i++) gsl_histogram_increment(&h, x[i]);
    for (int64_t k = 0; k < bins; k++) {
        double from = h.range[k], to = k + 1 == bins ? most : h.range[k + 1];
        double *at = table_row(t, failure);
        if (!at) break;
        put(&at, from), put(&at, to), put(&at, h.bin[k]);
        put(&at, h.bin[k] / (double)n / (to - from));
    }
    free(h.range), free(h.bin);
    return failure->status;
}

/* Does contact i push or pull, in the region? */
static bool friction_pushes(const struct snapshot *s, int64_t i)
{
    return branch_counts(s->s, i) && region_holds(&s->region, s->s->c[i].x);
}

/* N: the tangential force */
static double friction_tangential(const struct snapshot *s, int64_t i)
{
    const double *r = s->s->found[i].r;
    return hypot(r[1], r[2]) / s->p->dt;
}

static double normal(const struct snapshot *s, int64_t i)
{
    return s->s->found[i].r[0] / s->p->dt;
}

/* Of the force: less of a push beside a pull is what the solve leaves */
static const double CONTACT_LAW_NOISE = 1e-3;

/* N: how much of friction there is, and how much there could be: of the push of the surfaces, which a tie that pulls
   the bodies together adds to */
struct rub {
    double is, most;
};

static struct rub rub_of(const struct snapshot *s, int64_t i)
{
    const struct found *f = &s->s->found[i];
    const bool tied = s->s->law && contact_law_holds(&s->s->law[i]);
    double dt = s->p->dt, r[3] = { f->r[0], f->r[1], f->r[2] };
    if (tied) contact_law_push(dt, &s->s->law[i], f, r);
    double is = hypot(r[1], r[2]) / dt, most = s->s->c[i].mu * r[0] / dt;
    if (!tied) return (struct rub){ is, most };
    // what is a difference of push and pull has the error of both
    if (r[0] <= CONTACT_LAW_NOISE * fabs(f->r[0])) return (struct rub){ 0, 0 };
    return (struct rub){ fmin(is, most), most };
}

static double mobilised(const struct snapshot *s, int64_t i)
{
    struct rub rub = rub_of(s, i);
    return rub.most > 0 ? rub.is / rub.most : NAN;
}

static const struct quantity quantities[] = {
    { "contacts", "1", 1, "number of contacts with their point in the region" },
    { "sliding", "1", 1, "number of those that slide" },
    { "mobilised", "1", 1, "mean of |f_t| / (mu f_n) of those with friction, attraction excluded" },
    { "ratio", "1", 1, "sum of |f_t| over sum of mu f_n" },
    { "normal_mean", "N", 1, "mean normal force" },
    { "normal_most", "N", 1, "largest normal force" },
    { "normal_spread", "1", 1, "standard deviation of the normal force over its mean" },
    { "tangential_mean", "N", 1, "mean tangential force" },
    { "tangential_most", "N", 1, "largest tangential force" },
    { 0 },
};

struct friction_sums {
    int64_t contacts, sliding, rough;
    double mobilised, tangential, rub, limit, normal, normal_most, tangential_most;
};

static void friction_add(struct friction_sums *m, const struct snapshot *s, int64_t i)
{
    double fn = normal(s, i), ft = friction_tangential(s, i);
    struct rub rub = rub_of(s, i);
    m->contacts++, m->sliding += s->s->found[i].status == LOCAL_SLIDE;
    m->normal += fn, m->tangential += ft, m->rub += rub.is, m->limit += rub.most;
    m->normal_most = fmax(m->normal_most, fn), m->tangential_most = fmax(m->tangential_most, ft);
    if (rub.most > 0) m->rough++, m->mobilised += rub.is / rub.most;
}

static int friction_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    struct friction_sums m = { 0 };
    double square = 0, *at = table_row(t, failure);
    if (!at) return failure->status;
    for (int64_t i = 0; i < s->s->n; i++)
        if (friction_pushes(s, i)) friction_add(&m, s, i);
    double n = (double)m.contacts, mean = m.normal / n;
    for (int64_t i = 0; i < s->s->n; i++)
        if (friction_pushes(s, i)) square += (normal(s, i) - mean) * (normal(s, i) - mean);
    put(&at, n), put(&at, (double)m.sliding);
    if (!m.contacts) {
        table_null(t, "no contact pushes or pulls");
        return 0;
    }
    if (!m.rough) table_null(t, "no contact has friction");
    put(&at, m.rough ? m.mobilised / (double)m.rough : NAN);
    put(&at, m.rough ? m.rub / m.limit : NAN);
    put(&at, mean), put(&at, m.normal_most), put(&at, sqrt(square / n) / mean);
    put(&at, m.tangential / n), put(&at, m.tangential_most);
    return 0;
}

const struct measure measure_friction = {
    .name = "friction",
    .help = "contact forces, and mobilised friction",
    .quantity = quantities,
    .usual = true,
    .needs = NEEDS_FORCES,
    .rows = friction_rows,
};

/* ---- distributions ---- */

/* Rows of a histogram of what value() says of the contacts that count; over its mean where `by_mean`,
   up to `most`, 0: the largest */
static int distribution(struct table *t, const struct snapshot *s,
                        double (*value)(const struct snapshot *, int64_t), bool by_mean,
                        double most, struct failure *failure)
{
    double *x = malloc(((size_t)s->s->n + 1) * sizeof *x), sum = 0, largest = 0;
    int64_t n = 0;
    if (!x) return failure_set(failure, EX_SOFTWARE, "no memory for a distribution");
    for (int64_t i = 0; i < s->s->n; i++) {
        double v = friction_pushes(s, i) ? value(s, i) : NAN;
        if (v >= 0) x[n++] = v, sum += v, largest = fmax(largest, v);
    }
    double mean = n ? sum / (double)n : 0, unit = by_mean ? mean : 1;
    if (!(mean > 0) || !isfinite(sum)) {
        table_null(t, n ? "all are zero" : "no contact pushes or pulls");
        free(x);
        return 0;
    }
    for (int64_t i = 0; i < n; i++) {
        x[i] /= unit;
        if (most > 0) x[i] = fmin(x[i], most); // rounding
    }
    histogram_rows(t, x, n, most > 0 ? most : largest / unit, s->asked->bins, failure);
    free(x);
    return failure->status;
}

static const struct quantity of_force[] = { HISTOGRAM_QUANTITIES("1", "in units of the mean force"),
                                            { 0 } };
static const struct quantity of_part[] = { HISTOGRAM_QUANTITIES("1", "|f_t| / (mu f_n)"), { 0 } };

static int normal_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    return distribution(t, s, normal, true, 0, failure);
}
static int tangential_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    return distribution(t, s, friction_tangential, true, 0, failure);
}
static int mobilised_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    return distribution(t, s, mobilised, false, 1, failure);
}

const struct measure measure_normal_forces = {
    .name = "normal_forces",
    .help = "distribution of normal forces over their mean",
    .quantity = of_force,
    .list = true,
    .needs = NEEDS_FORCES,
    .rows = normal_rows,
};

const struct measure measure_tangential_forces = {
    .name = "tangential_forces",
    .help = "distribution of tangential forces over their mean",
    .quantity = of_force,
    .list = true,
    .needs = NEEDS_FORCES,
    .rows = tangential_rows,
};

const struct measure measure_mobilised = {
    .name = "mobilised",
    .help = "distribution of mobilised friction",
    .quantity = of_part,
    .list = true,
    .needs = NEEDS_FORCES,
    .rows = mobilised_rows,
};
