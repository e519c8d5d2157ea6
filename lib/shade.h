/*
 * shade.h: what the samples of a band look like, once it is known what is in front.
 *
 * A ball's light: from a lamp over the viewer's left shoulder [Lambert], its soft reflection
 * [Blinn], and from all around as far as nothing near is in the way. Of the sky over a point with
 * normal n, a ball of radius r whose centre lies d along the unit vector e takes away n.e (r/d)^2.
 */
#ifndef NSD_SHADE_H
#define NSD_SHADE_H

#include "raster.h"

#include <stddef.h>

#define SHADE_REACH 2.2 /* radii from its centre a ball darkens what is there */

enum { NOTHING = -1, GROUND = -2 }; /* and GROUND - i: floor i; from 0 on a spot */

enum { SHADE_TILE = 8 };

struct span {
    double lo, hi;
};

struct normal {
    float x, y, z;
};

struct band {
    int width, y0, y1;  /* samples: all of these columns, rows y0 to y1 - 1 */
    double *z;          /* [width (y1 - y0)] of what is in front, -INFINITY where nothing is */
    int64_t *what;      /* [...] and what it is */
    struct normal *n;   /* [...] and where it looks */
    struct span *range; /* of squares of samples: between which depths something is in them */
    float *dark;        /* [...] how much of the sky is hidden */
    float *edge;        /* [...] how much of an edge is over it */
    int64_t spots;
    int64_t *spot; /* those near the band */
};

/* The samples of the band that lie in [x - r, x + r] x [y - r, y + r]. */
struct part {
    int x0, x1, y0, y1;
};
struct part part_of(const struct band *, double x, double y, double r);

static inline size_t band_at(const struct band *b, int x, int y)
{
    return (size_t)(y - b->y0) * (size_t)b->width + (size_t)x;
}

void shade_normals(struct band *, const struct raster *);
void shade_near(struct band *, const struct raster *);
void shade_pixels(const struct band *, const struct raster *, struct picture *);

#endif
