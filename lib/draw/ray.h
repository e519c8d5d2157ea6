/*
 * draw/ray.h: what a line of sight meets of a shape, exactly: rounded hulls are seen as the union of
 * their core, the prisms on its faces, and the tubes and balls along its edges.
 *
 * All is in the shape's own axes and unit [shape/shape.h].
 */
#pragma once

#include "shape/shape.h"

struct ray {
    vec3 from, along; /* the line: from + t along, a unit vector; the viewer is at t = infinity */
    double before;    /* what is beyond this t is cut away; infinite: nothing */
};

/* The largest t at which the line is in the shape, and the outward unit normal there, 0 where it is cut.
   False: it passes by. */
bool ray_meets(const struct shape *s, const struct ray *line, double *t, vec3 *n);

/* In the plane: how deep a point lies inside, < 0: outside */
double ray_depth(const struct shape *s, vec3 x);
