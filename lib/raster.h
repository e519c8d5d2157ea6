/*
 * raster.h: from things placed among the samples of a picture to its pixels, in bands that know
 * nothing of each other: any number of threads draws the same.
 *
 * Lengths are in samples here: x to the right, y down, z towards the viewer; sample (i, j) lies at
 * (i + 1/2, j + 1/2).
 */
#ifndef NSD_RASTER_H
#define NSD_RASTER_H

#include "backdrop.h"
#include "paint.h"
#include "picture.h"

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
    double x[BACKDROP_CORNERS], y[BACKDROP_CORNERS];
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

/* All pixels of the picture, which is there already. Returns 0 or EX_SOFTWARE without memory. */
int raster_draw(const struct raster *, struct picture *, struct why *);

#endif
