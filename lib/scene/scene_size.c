#include "scene/scene_size.h"

#include <gsl/gsl_randist.h>
#include <math.h>
#include <stdlib.h>

void scene_size_free(struct scene_size *z)
{
    free(z->sieve);
    z->sieve = NULL;
}

double scene_draw_normal(gsl_rng *rng, double sd)
{
    // rounded to float: the last bits of libm's logarithm and exponential, from which it is made,
    // differ on machines without FMA
    return (float)gsl_ran_gaussian(rng, sd);
}

static double scene_size_within(const struct scene_size *z, double r)
{
    return fmin(fmax(r, z->min), z->max);
}

static double draw_bell(const struct scene_size *z, gsl_rng *rng)
{
    double r;
    do {
        double z1 = scene_draw_normal(rng, z->spread);
        r = z->law == SIZE_GAUSSIAN ? z->mid + z1 : z->mid * (float)exp(z1);
    } while (r < z->min || r > z->max); // ends: [min, max] has a share of 1e-3 at least (read_bell)
    return r;
}

/* The radius below which there is a share u of the density r^-a on [lo, hi], in lo */
static double invert_power(double a, double lo, double hi, double u)
{
    double x = log(hi / lo) * (1 - a);
    if (fabs(x) < 1e-9) return (float)exp(u * log(hi / lo));
    return (float)exp(log1p(u * expm1(x)) / (1 - a));
}

static double draw_sieve(const struct scene_size *z, gsl_rng *rng)
{
    double u = gsl_rng_uniform(rng), v = gsl_rng_uniform(rng);
    int64_t low = 0, high = z->segments - 1; // the first segment whose end lies above u
    while (low < high) {
        int64_t k = (low + high) / 2;
        if (z->sieve[k].below > u)
            high = k;
        else
            low = k + 1;
    }
    const struct scene_sieve *s = &z->sieve[low];
    return s->from * invert_power(1 + z->dim, s->from, s->to, v);
}

void scene_size_scale(struct scene_size *z, double factor)
{
    z->min *= factor, z->max *= factor, z->mid *= factor, z->unit = factor;
    if (z->law == SIZE_GAUSSIAN) z->spread *= factor; // lognormal: that of the logarithm
    for (int64_t k = 0; k < z->segments; k++) z->sieve[k].from *= factor, z->sieve[k].to *= factor;
}

double scene_size_draw(const struct scene_size *z, gsl_rng *rng)
{
    switch (z->law) {
    case SIZE_UNIFORM:
        if (z->min == z->max) return z->min;
        return gsl_ran_flat(rng, z->min, z->max);
    case SIZE_POWER:
        return scene_size_within(
            z, z->min * invert_power(z->exponent, z->min, z->max, gsl_rng_uniform(rng)));
    case SIZE_SIEVE:
        return scene_size_within(z, draw_sieve(z, rng));
    default:
        return draw_bell(z, rng);
    }
}
