/*
 * scene/scene_size.h: how large grains are: the SIZE of a scene [scene/scene.h], a distribution of
 * radii by number.
 *
 * A sieve curve gives the share F(d) of the mass that passes a sieve of aperture d, d the diameter.
 * Between its points F is linear in log d, as it is drawn on the usual sheet. By number the density
 * is then dF/dd / d^dim: on a segment it is proportional to d^(-1-dim), whose distribution is
 * inverted in closed form.
 */
#pragma once

#include <gsl/gsl_rng.h>
#include <stdint.h>

/* A segment of a sieve curve */
struct scene_sieve {
    double from, to; /* m, radii */
    double below;    /* share of the grains, by number, in this segment and those before it */
};

struct scene_size {
    enum {
        SIZE_UNIFORM,
        SIZE_GAUSSIAN,
        SIZE_LOGNORMAL,
        SIZE_POWER, /* density by number proportional to r^-exponent */
        SIZE_SIEVE
    } law;
    double mid, spread; /* gaussian: mean and sd, m; lognormal: median, m, and sigma */
    double min, max;    /* m; a single radius is min = max */
    double unit; /* m: the radius at size 1, where sizes were scale factors; 0: they were not */
    double exponent;
    int dim;          /* of a sieve: 3, or 2 where grains are discs */
    int64_t segments; /* of a sieve */
    struct scene_sieve *sieve;
};

/* m: the next radius */
double scene_size_draw(const struct scene_size *size, gsl_rng *rng);
/* Makes all grains `factor` times as large. */
void scene_size_scale(struct scene_size *size, double factor);
/* A normal deviate with standard deviation sd, the same on every machine */
double scene_draw_normal(gsl_rng *rng, double sd);
void scene_size_free(struct scene_size *size);
