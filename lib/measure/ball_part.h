/*
 * measure/ball_part.h: how much of a ball or disc lies in a box, exactly, and in a shell between two
 * cylinders, by quadrature.
 *
 * A box is a sum and difference of the eight octants at its corners. Of the unit ball the part with
 * x > a, y > b, z > c, whose corner (a, b, c) is inside, is by Gauss's theorem
 *
 *     V = (S - a A_a - b A_b - c A_c)/3,
 *
 * A the areas of its plane faces and S that of its piece of the sphere, which by Gauss and Bonnet is
 * 2 pi - (sum of the exterior angles) - (sum of the geodesic curvatures of the arcs).
 */
#pragma once

#include "state/packing.h"

/* m^3, of a disc m^2: of the whole ball */
double ball_volume(int dim, double radius);

/* The volume of a grain of any shape, in volumes of the ball around it, over which its parts are counted as
   if it were spread; and m^3, of the plane m^2 */
static inline double grain_fill(const struct packing *p, int64_t i)
{
    const struct shape *s = packing_shape(p, i);
    return s ? s->volume / p->shapes.s[0].volume : 1;
}
static inline double grain_volume(const struct packing *p, int64_t i)
{
    return grain_fill(p, i) * ball_volume(p->dim, p->radius[i]);
}

/* m^3, of a disc m^2: the part between lo and hi (m, along each axis; may be infinite) of the ball
   with its centre at x. In the plane the third axis has no bounds. */
double ball_in_box(int dim, vec3 x, double radius, const double lo[3], const double hi[3]);

/*
 * The same with a distance of at most R (m) from the line along z at a distance of d (m) from the
 * centre. Discs: exactly. Balls: slices by Gauss's quadrature with 32 points, to 1e-4 of the ball.
 */
double ball_in_cylinder(int dim, double d, double radius, double R);
