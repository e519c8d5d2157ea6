#include "scene/size_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BINS = 8192 /* of what is asked for: quantiles of a range of 1000 are known to 1e-3 */ };

static int size_table_alloc(struct size_table *t, int64_t n, struct failure *failure)
{
    *t = (struct size_table){ .n = n };
    t->d = calloc((size_t)n + 1, sizeof *t->d);
    bool good = t->d != NULL;
    for (int k = 0; k < SIZE_SHARES; k++) {
        t->below[k] = calloc((size_t)n + 1, sizeof **t->below);
        good = good && t->below[k];
    }
    return good ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for the sizes of grains");
}

void size_table_free(struct size_table *t)
{
    free(t->d);
    for (int k = 0; k < SIZE_SHARES; k++) free(t->below[k]);
    *t = (struct size_table){ 0 };
}

/* Share below r of the density r^-a on [lo, hi] */
static double power_below(double a, double lo, double hi, double r)
{
    const double all = log(hi / lo), x = log(r / lo), b = 1 - a;
    if (r <= lo || r >= hi) return r >= hi;
    return fabs(all * b) < 1e-9 ? x / all : expm1(x * b) / expm1(all * b);
}

static double size_table_normal_below(double z)
{
    return 0.5 * erfc(-z * M_SQRT1_2);
}

static double bell_below(const struct scene_size *z, double r)
{
    const bool gauss = z->law == SIZE_GAUSSIAN;
    const double lo = (gauss ? z->min - z->mid : log(z->min / z->mid)) / z->spread,
                 hi = (gauss ? z->max - z->mid : log(z->max / z->mid)) / z->spread,
                 at = (gauss ? r - z->mid : log(r / z->mid)) / z->spread;
    return (size_table_normal_below(at) - size_table_normal_below(lo)) /
           (size_table_normal_below(hi) - size_table_normal_below(lo));
}

static double sieve_below(const struct scene_size *z, double r)
{
    double had = 0;
    for (int64_t k = 0; k < z->segments; k++) {
        const struct scene_sieve *s = &z->sieve[k];
        if (r < s->to) return had + (s->below - had) * power_below(1 + z->dim, s->from, s->to, r);
        had = s->below;
    }
    return 1;
}

/* Share of the grains that are smaller than r, min < r < max */
static double number_below(const struct scene_size *z, double r)
{
    switch (z->law) {
    case SIZE_UNIFORM:
        return (r - z->min) / (z->max - z->min);
    case SIZE_POWER:
        return power_below(z->exponent, z->min, z->max, r);
    case SIZE_SIEVE:
        return sieve_below(z, r);
    default:
        return z->spread > 0 ? bell_below(z, r) : r >= z->mid;
    }
}

/* Sums of shares become what is below, of the whole. */
static void sum_up(struct size_table *t)
{
    for (int k = 0; k < SIZE_SHARES; k++) {
        double *below = t->below[k];
        for (int64_t i = 1; i < t->n; i++) below[i] += below[i - 1];
        for (int64_t i = 0; i < t->n; i++) below[i] /= below[t->n - 1];
    }
}

int size_table_asked(struct size_table *t, const struct scene_size *z, int dim,
                     struct failure *failure)
{
    const bool one = !(z->min < z->max);
    if (size_table_alloc(t, one ? 1 : BINS + 1, failure)) return failure->status;
    t->smooth = !one;
    double had = 0;
    for (int64_t i = 0; i < t->n; i++) {
        const double r = one ? z->min : z->min * pow(z->max / z->min, (double)i / BINS);
        const double now = one || i == BINS ? 1 : i ? number_below(z, r) : 0, share = now - had;
        const double middle = i ? 0.25 * t->d[i - 1] + 0.5 * r : r;
        t->d[i] = 2 * r, had = now;
        t->below[SIZE_BY_NUMBER][i] = share;
        t->below[SIZE_BY_MASS][i] = share * pow(middle / z->max, dim);
        t->mean += share * 2 * middle;
    }
    sum_up(t);
    return 0;
}

static int size_table_by_value(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

int size_table_drawn(struct size_table *t, const double *radius, int64_t n, int dim,
                     struct failure *failure)
{
    if (size_table_alloc(t, n, failure)) return failure->status;
    for (int64_t i = 0; i < n; i++) t->d[i] = 2 * radius[i];
    qsort(t->d, (size_t)n, sizeof *t->d, size_table_by_value);
    for (int64_t i = 0; i < n; i++) {
        t->below[SIZE_BY_NUMBER][i] = 1;
        t->below[SIZE_BY_MASS][i] = pow(t->d[i] / t->d[n - 1], dim);
        t->mean += t->d[i] / (double)n;
    }
    sum_up(t);
    return 0;
}

/* The first of n rising numbers that is at least x, in n - 1 the last */
static int64_t first_from(const double *a, int64_t n, double x)
{
    int64_t low = 0, high = n - 1;
    while (low < high) {
        const int64_t k = (low + high) / 2;
        if (a[k] >= x)
            high = k;
        else
            low = k + 1;
    }
    return low;
}

double size_table_quantile(const struct size_table *t, enum size_share of, double share)
{
    const double *below = t->below[of];
    if (!t->n) return NAN;
    const int64_t k = first_from(below, t->n, share);
    if (!t->smooth || !k || !(below[k] > below[k - 1])) return t->d[k];
    return t->d[k - 1] +
           (t->d[k] - t->d[k - 1]) * (share - below[k - 1]) / (below[k] - below[k - 1]);
}

double size_table_below(const struct size_table *t, enum size_share of, double d)
{
    const double *below = t->below[of], hair = 1e-12 * d;
    if (!t->n || d + hair < t->d[0]) return 0;
    if (d + hair >= t->d[t->n - 1]) return 1;
    const int64_t k = first_from(t->d, t->n, d + hair); // d[k - 1] < d <= d[k]
    if (!t->smooth) return below[k - 1];
    return below[k - 1] + (below[k] - below[k - 1]) * (d - t->d[k - 1]) / (t->d[k] - t->d[k - 1]);
}
