/*
 * draw/shade.h: the colours of the samples of a band, once it is known what is in front at each.
 *
 * A ball is lit by a lamp over the viewer's left shoulder [Lambert], whose soft reflection it shows
 * [Blinn], and by the sky all around unless something near is in the way. Of the sky over a point
 * with normal n, a ball of radius r whose centre lies d away along the unit vector e hides n.e
 * (r/d)^2.
 */
#pragma once

#include "draw/paint.h"
#include "draw/picture.h"
#include "draw/walls.h"

#include <stddef.h>

/*
 * What raster and shade share: struct raster, the things placed among the samples of a
 * picture, and struct band, some rows of samples with what has been found at each.
 *
 * Lengths are in samples here: x to the right, y down, z towards the viewer; sample (i, j) lies at
 * (i + 1/2, j + 1/2).
 */

/* A ball or disc */
struct spot {
    vec3 x;   /* its centre */
    double r; /* its radius */
    int64_t body;
    struct rgb own;            /* the body's colour */
    const struct shape *shape; /* NULL: a ball or disc; else r is that of the ball around it, */
    double dark; /* and this that of a ball of its volume, by which it darkens others */
};

/* A floor: the plane z = plane[0] + plane[1] x + plane[2] y inside a convex polygon. square[k] /
   over, both in the same form, is the coordinate along side k of its pattern, in squares, of what
   is seen at (x, y). */
struct ground {
    vec3 n;
    double plane[3], square[2][3], over[3];
    int corners;
    double x[WALLS_CORNERS], y[WALLS_CORNERS]; /* of the corners */
};

/* A facet, half-transparent or solid: the plane z = plane[0] + plane[1] x + plane[2] y inside a triangle */
struct pane {
    double x[3], y[3], plane[3];
    float part;     /* of the light behind it that it takes [draw/wall_facets.h] */
    float light;    /* its brightness */
    vec3 n;         /* its unit normal, to the viewer: y down */
    struct rgb own; /* its colour where it is solid; r < 0: it is glass */
};

/* What is cut away: where side[0] x + side[1] y + side[2] z + side[3] > 0 */
struct cutting {
    bool cuts;
    double side[4];
    vec3 n; /* the plane's normal, as the viewer sees it: y down */
};

struct raster {
    int width, height, samples; /* of the picture, in samples; samples a pixel along a side */
    int threads;
    bool flat; /* discs, not balls */
    struct rgb background;
    const struct paint *paint;
    const quat *q;          /* [bodies] orientations */
    vec3 right, up, toward; /* of the camera */
    int64_t spots;
    struct spot *spot;
    int grounds, edges;
    struct ground *ground;
    struct edge *edge;
    int64_t panes;
    struct pane *pane;
    struct cutting cutting;
    float pale;   /* 0 to 1: how much the bodies are mixed with the background */
    double thick; /* half the width of an edge */
};

#define SHADE_REACH 2.2 /* radii: how far from its centre a ball darkens other things */

enum { NOTHING = -1, GROUND = -2, SOLID = -(1 << 20) };
/* what is seen; GROUND - i: floor i; SOLID - i: pane i; i >= 0: spot i */

enum { SHADE_TILE = 8 }; /* samples: side of the squares of which shade_near knows the depths */

struct span {
    double lo, hi;
};

struct normal {
    float x, y, z;
};

/* The panes in front of a sample: the part of the light that passes, sums of their parts and lights */
struct veil {
    float passes, parts, lights;
};

struct band {
    int width, y0, y1;  /* samples: all of these columns, rows y0 to y1 - 1 */
    double *z;          /* [width (y1 - y0)] depth of what is in front; -INFINITY: nothing */
    int64_t *what;      /* [width (y1 - y0)] what is in front */
    struct normal *n;   /* [width (y1 - y0)] its unit normal */
    struct span *range; /* [squares] least and largest depth of what is in front */
    float *dark;        /* [width (y1 - y0)] share of the sky that is hidden */
    struct veil *veil;  /* [width (y1 - y0)] what panes in front of it do; NULL without panes */
    float *edge;        /* [width (y1 - y0)] opacity of an edge over it, 0 to 1 */
    int64_t spots;
    int64_t *spot; /* [spots] those near the band */
};

/* Samples x0 <= x < x1, y0 <= y < y1 */
struct patch {
    int x0, x1, y0, y1;
};
/* The samples of the band in [x - r, x + r] x [y - r, y + r] */
struct patch band_patch(const struct band *b, double x, double y, double r);

/* x as an integer, not below lo (also where x is not a number) and not above hi */
int band_clamp(double x, int lo, int hi);

/* Memory for `rows` rows of samples; false when it is short. To be freed in both cases. */
bool band_init(struct band *b, const struct raster *s, int rows);
void band_free(struct band *b);
/* The index of a sample */
static inline size_t band_at(const struct band *b, int x, int y)
{
    return (size_t)(y - b->y0) * (size_t)b->width + (size_t)x;
}

/* In this order: b->n; b->dark; the pixels of p in the band */
void shade_normals(struct band *b, const struct raster *s);
void shade_near(struct band *b, const struct raster *s);
void shade_pixels(const struct band *b, const struct raster *s, struct picture *p);
