/*
 * shape/wall_edge.h: the rims of walls that end, and the ridges of those that bend: the lines which
 * faces and edges of bodies meet, where corners of bodies do not. In the plane, points.
 *
 * Those of rectangles, segments, surfaces of triangles and chains. A rim is next to a body only where the
 * surfaces that meet there turn away from it: the way from the rim into none of them leads nearer. Where
 * two surfaces are in one plane there is none.
 */
#pragma once

#include "shape/mesh.h"

#include <stdbool.h>

enum { RIM_SIDES_MOST = 4, RIMS_MOST = 64 /* near a body: of more the first */ };

/* As its wall is described, before any motion */
struct rim {
    int32_t n;                 /* ends: 2, in the plane 1 */
    vec3 v[2];                 /* m, from the point of reference of the wall */
    int32_t sides;             /* surfaces that meet there */
    vec3 into[RIM_SIDES_MOST]; /* unit vectors from the rim into each, across it */
    int32_t key, corner[2];    /* which it is of the wall, and its ends */
};

struct rims {
    int n;
    struct rim rim[RIMS_MOST];
};

/* Those at most `reach` (m) from c (m, from the wall's point of reference). surface: of a mesh. */
void rims_near(struct rims *out, const struct wall *w, int dim, const struct surface *surface,
               vec3 c, double reach);

/* Does the wall end at the place t that is next to c (m, from its point of reference)? There it has no
   other side. */
bool wall_ends_at(const struct wall *w, int dim, const struct surface *surface, vec3 c,
                  const struct touch *t);
/* Do the elements that meet at a feature of a surface lie in different planes? Then rims are there. */
bool surface_bends(const struct surface *s, int dim, int32_t feature);
/* Elements of grooves, as they are next to a point behind them; of more than there is room for the first */
struct grooves {
    int n;
    struct touch touch[TOUCHES_MOST];
};
/* In a groove, seen from the point `middle`, there are none: adds those elements at the feature t above which others
   rise, as they are next to c behind them. */
void surface_groove(struct grooves *out, const struct surface *s, int dim, const struct touch *t,
                    vec3 c, vec3 middle);

/* Whether a wall of two sides lies between two places: a corner of a body on the
   other side than its middle has gone through. */

/* Does the way from a to b (m, from the wall's point of reference, before any motion) cross the
   wall? Of rectangles, discs and meshes (surface); of others that is not looked at: true. */
bool wall_between(const struct wall *w, int dim, const struct surface *surface, vec3 a, vec3 b);
