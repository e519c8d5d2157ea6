/*
 * scene/line_crossings.h: where lines along an axis go through the triangles of a surface, and what the winding number along
 * them says of it: of the surface of a body it is 1 inside and 0 outside.
 */
#pragma once

#include "shape/mesh.h"

#include <stdbool.h>

/* Lines along an axis (0: x), through the points (j, k) of a grid across it, j along the next axis; line k n[0] + j */
struct lines {
    int axis, n[2];
    double h;    /* m: between lines */
    vec3 origin; /* m: of the first, in the order of the axes from `axis` on */
};

/* Where a line goes through a triangle; way: +1 out of the body, -1 into it */
struct tunnelling {
    int32_t line, way;
    double x; /* m */
};

struct crossings {
    int64_t n, room;
    struct tunnelling *c; /* [n] by line, x and way */
};

/* Returns 0, EX_DATAERR where there are too many, or EX_SOFTWARE; crossings_free() in any case. */
int crossings_find(struct crossings *out, const struct mesh *m, const struct lines *l,
                   struct failure *failure);
void crossings_free(struct crossings *c);

/* The way of the line y, z along x through a triangle, as above, and where; 0: it passes beside. Of two triangles at a side a
   line meets one. */
int crossing_of(const vec3 v[3], double y, double z, double *x);

/* Is a closed surface that of a body: nowhere twice around a place, and nowhere inside out? Lines along each axis, 128
   along the longest side, look for parts of 1e-3 of the volume. Returns 0, EX_DATAERR or EX_SOFTWARE. */
int crossings_judge(const struct mesh *m, struct failure *failure);
