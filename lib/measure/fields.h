/*
 * measure/fields.h: coarse graining: fields that are defined at every point and obey the balances of
 * mass and momentum exactly [Goldhirsch 2010], by his Gaussian
 *
 *     phi(R) = (sqrt(pi) w)^-dim exp(-R^2/w^2),
 *
 * cut off at 4 w, where it is 1e-7 of its greatest. A contact's stress is f l^T times the integral of
 * phi along its branch vector l, which is a difference of two error functions.
 *
 * The velocity gradient is that of the affine flow which fits the velocities best by least squares with weights m phi:
 * exact where the flow is affine, however the bodies lie. The granular temperature is about that flow.
 */
#pragma once

#include "measure/snapshot.h"
#include "measure/table.h"

enum continuum {
    CONTINUUM_DENSITY,
    CONTINUUM_FRACTION,
    CONTINUUM_MOMENTUM,
    CONTINUUM_VELOCITY,
    CONTINUUM_STRESS,
    CONTINUUM_CONTACTS,
    CONTINUUM_KINETIC,
    CONTINUUM_GRADIENT,
    CONTINUUM_STRAIN_RATE,
    CONTINUUM_SHEAR_RATE,
    CONTINUUM_TEMPERATURE,
    CONTINUUM_INERTIAL,
    CONTINUUM_COUNT
};
/* Their names and units; one without a name ends them. */
extern const struct quantity field_quantity[CONTINUUM_COUNT + 1];

struct fields {
    int64_t n[3];               /* points along the axes; x counts fastest */
    vec3 origin, step;          /* m: the first point, and from one to the next */
    double width;               /* m: w */
    double *moment;             /* [points][MOMENTS] sums that the fields are made of */
    double *x[CONTINUUM_COUNT]; /* [points][width of the quantity] */
};

/*
 * A grid over a region, its points in the middle of cells that are at most `spacing` (m) wide; 0: as
 * the mean diameter, but not more than 32 cells along an axis. width (m) 0: the mean diameter.
 * Returns 0, EX_SOFTWARE, or EX_DATAERR where there is nothing to lay it over.
 */
int fields_init(struct fields *f, const struct snapshot *s, double width, double spacing,
                struct failure *failure);
void fields_free(struct fields *f);
/* The fields of a snapshot, on the grid that there is; without solved contacts their stress is NaN. Returns 0, or
   EX_DATAERR where too many images of the bodies in a periodic cell are within reach. */
int fields_set(struct fields *f, const struct snapshot *s, struct failure *failure);

static inline int64_t fields_points(const struct fields *f)
{
    return f->n[0] * f->n[1] * f->n[2];
}
