/*
 * draw/band.h: a band of a picture at work: the things placed among its samples, and what is known of
 * each sample so far.
 *
 * Lengths are in samples here: x to the right, y down, z towards the viewer; sample (i, j) lies at
 * (i + 1/2, j + 1/2).
 */
#ifndef NSD_BAND_H
#define NSD_BAND_H

#include "draw/paint.h"
#include "draw/picture.h"
#include "draw/walls.h"

#include <stddef.h>

struct spot {
    vec3 x;
    double r;
    int64_t body;
    struct rgb own;
};

/* A floor: the plane z = plane[0] + plane[1] x + plane[2] y inside of a convex polygon. Where it is
   seen at (x, y), square[k] says in the same way, in squares of its pattern. */
struct ground {
    vec3 n;
    double plane[3], square[2][3];
    int corners;
    double x[WALLS_CORNERS], y[WALLS_CORNERS];
};

struct raster {
    int width, height, samples; /* samples of the picture, and of a pixel, on a side */
    int threads;
    bool flat; /* discs, not balls */
    struct rgb background;
    const struct paint *paint;
    const quat *q;          /* [bodies] orientations, */
    vec3 right, up, toward; /* and how the camera stands */
    int64_t spots;
    struct spot *spot;
    int grounds, edges;
    struct ground *ground;
    struct edge *edge;
    double thick; /* half of an edge */
};

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
struct patch {
    int x0, x1, y0, y1;
};
struct patch band_patch(const struct band *, double x, double y, double r);

/* x as an index from lo to hi */
int band_clamp(double x, int lo, int hi);

/* Room for a band of `rows` rows of samples; false when memory is short. Free in any case. */
bool band_init(struct band *, const struct raster *, int rows);
void band_free(struct band *);

static inline size_t band_at(const struct band *b, int x, int y)
{
    return (size_t)(y - b->y0) * (size_t)b->width + (size_t)x;
}

#endif
