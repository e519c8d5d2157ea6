/*
 * scene/hull_faces.h: the triangles of a convex hull joined to faces [scene/hull.h]. Triangles next to each other
 * that are in one plane become one face. Then corners that only two faces have, and faces of two corners, are left
 * out until there are none: each step leaves a closed surface closed.
 */
#ifndef NSD_HULL_FACES_H
#define NSD_HULL_FACES_H

#include "base/vec.h"
#include "base/failure.h"

#include <stdint.h>

/* A triangle of the hull; in the plane a segment, which has two points */
struct facet {
    int32_t point[3]; /* counterclockwise seen from outside */
    int32_t next[3];  /* the facet across from each of them */
    int32_t face;     /* that it belongs to; -1: to none yet */
    vec3 n;           /* outward */
    double area;      /* twice */
};

/* All of a hull */
struct facets {
    int32_t n;
    struct facet *of; /* [n] */
    int32_t points;
    const vec3 *x; /* [points] */
};

/* Loops of points: of face f corner[first[f]] .. corner[first[f + 1] - 1], from the least on */
struct loops {
    int32_t faces;
    int32_t *first, *corner;
};

/* The faces of a hull; in a plane: what is closer to it than `flat`. Returns 0, EX_DATAERR where
   no body is left, or EX_SOFTWARE; loops_free() in any case. */
int hull_faces(struct loops *l, const struct facets *hull, double flat, struct failure *failure);
/* The same in the plane: one loop, of segments. */
int hull_loop(struct loops *l, const struct facets *hull, double flat, struct failure *failure);
void loops_free(struct loops *l);

#endif
