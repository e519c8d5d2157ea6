/*
 * scene/clump_fit.h: balls that fill a closed surface, for grains that are not convex: a clump whose mass and moments
 * are the surface's.
 *
 * Balls are chosen one after another among those that touch the surface from within, at the points of a grid of 64
 * along the longest side: each time the one that fills most of what is still empty [greedy cover; its gain only falls,
 * so that few have to be counted again]. Then all radii grow by the same length, so that the balls together have the
 * volume of the surface. The same surface gives the same balls.
 */
#pragma once

#include "shape/mesh.h"
#include "shape/shape.h"
#include "shape/solid.h"

enum { CLUMP_BALLS_MOST = 1000 };

/* How far the balls are from the surface */
struct clump_errors {
    int32_t balls;
    double volume; /* of the balls together, over that of the surface, less 1 */
    double
        distance; /* the largest from the one surface to the other, of the radius of the ball around */
    double
        moments; /* norm of the difference of int x x^T about the centre, of the surface's trace */
};

/* When no more balls are chosen */
struct clump_limits {
    int32_t balls; /* at most CLUMP_BALLS_MOST */
    double error;  /* the distance that is enough, as in struct clump_errors; 0: none */
};

/*
 * s = balls (m) within the limits; *of: the surface's moments. Returns 0,
 * EX_DATAERR with what is wrong with the surface, or EX_SOFTWARE.
 */
int clump_fit(struct shape *s, struct solid *of, const struct mesh *m,
              const struct clump_limits *limits, struct clump_errors *errors,
              struct failure *failure);
