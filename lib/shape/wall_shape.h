/*
 * shape/wall_shape.h: walls: bodies of a shape that grains do not have, whose motion is
 * prescribed or yields to a load.
 *
 * What is said of its shape is said of where it is before any drive has moved it, at t = 0.
 */
#pragma once

#include "base/vec.h"
#include "shape/drive.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 * WALL_PLANE      half of space: bodies stay on the side that the normal points to; in the plane
 *                     half of it.
 * WALL_RECTANGLE  around x, size[0] along `along` and size[1] along n x along; in the plane a
 *                     segment of length size[0].
 * WALL_DISC       around x, from the radius size[0] (0: no hole) to size[1].
 * WALL_CYLINDER   around the axis n through x, of radius size[0], from x to x + size[2] n, or
 *                     endless where size[2] is 0; in the plane a circle.
 * WALL_CONE       the same with radius size[0] at x and size[1] at x + size[2] n.
 * WALL_SPHERE     around x, of radius size[0].
 * WALL_MESH       triangles, in the plane segments, with corners from x.
 *
 * Cylinder and cone may be a sector: `arc` rad from `along` on, counterclockwise about n; 0: all.
 */
enum wall_shape {
    WALL_PLANE,
    WALL_RECTANGLE,
    WALL_DISC,
    WALL_CYLINDER,
    WALL_CONE,
    WALL_SPHERE,
    WALL_MESH,
    WALL_SHAPES
};
extern const char *const wall_shape_name[WALL_SHAPES + 1]; /* the last one NULL */

/* Where bodies may be. Inside and outside hold for cylinder, cone and sphere; a body that is beyond
   the surface by more than its radius has left one that ends somewhere. */
enum wall_side { WALL_INSIDE, WALL_OUTSIDE, WALL_BOTH, WALL_SIDES };
extern const char *const wall_side_name[WALL_SIDES + 1]; /* the last one NULL */

struct wall {
    vec3 x, n; /* m: its point of reference at t = 0; unit normal or axis */
    vec3 v;    /* m/s: at time t the point is at x + v t, and where drives and load bring it */
    vec3 belt; /* m/s: of its surface along itself, beside its shape; turns with it */
    int32_t material; /* row of the material tables */
    struct load load; /* that it yields to; LOAD_NONE: it does not */

    int32_t shape, side; /* enum wall_shape, wall_side */
    vec3 along;          /* unit vector across n, for shapes that have a direction there */
    double size[3];      /* m */
    double arc;          /* rad */
    double weld; /* m: places nearer than this are one, where parts of a surface meet; 0: the
                            default [shape/mesh.h] */
    int32_t first_element, elements; /* of the packing's mesh */
    int32_t first_drive, drives;
    int32_t first_push, pushes; /* what the force of its load is in time, besides its constant */
    double
        wear; /* 1/Pa: Archard's coefficient, volume worn away a work of normal force times way; 0: none */
    double until; /* s: the packing's time at which it vanishes; infinite: never */
};

/* A plane that is there for ever, at rest */
struct wall wall_plane(vec3 x, vec3 n, int32_t material);
/* NULL, or what is wrong with its shape */
const char *wall_shape_trouble(const struct wall *w, int dim);
/* m: the distance of its farthest point from its x; infinite for shapes without an end */
double wall_reach(const struct wall *w);

/* Where the surface is next to a point: n from the surface to the point, but where a side is
   forbidden, to the other; the point is then at a negative distance. */
struct touch {
    vec3 n;
    double distance; /* m */
    int32_t feature; /* which of several places of a mesh */
};
/* Of all shapes but the mesh: the nearest place to the point c (m, from x, before any motion). False:
   none, for a ball of radius r (m) that has left it. */
bool wall_nearest(const struct wall *w, int dim, vec3 c, double r, struct touch *t);
