/*
 * shape/solid.h: volume, centre and moments of inertia of shapes of density 1, and a shape brought to
 * its principal axes about its centre, in units of the ball around it [shape/shape.h].
 *
 * Of sharp hulls by the divergence theorem, exact to rounding: a polyhedron is the sum of the tetrahedra
 * from the origin to its faces, cut into triangles, and int x x^T of one with corners 0, a, b, c is
 * det(a, b, c)/120 times the sum over its corners p, q of p q^T, those with p = q twice. Of capsules in
 * closed form. Of clumps whose balls do not overlap as sums; of other clumps, and of rounded hulls, the
 * lines of a grid are integrated: chords are exact, and the error is that of the grid, 1e-4 relative.
 */
#pragma once

#include "shape/shape.h"

/* Moments of the volume (in the plane: the area); second[i][j] = int x_i x_j */
struct solid {
    double volume;
    vec3 centre;
    double second[3][3]; /* about the centre */
};

/* Of a shape in any frame and any unit, its faces outward */
int solid_of(struct solid *out, const struct shape *s, int dim, struct failure *failure);

/* What a shape was before it was brought to its own axes and unit */
struct solid_frame {
    double reach; /* m: the radius of the ball around it */
    vec3 centre;  /* m: of mass */
    quat turn;    /* from its axes to those it was described in */
};

/*
 * Brings s, in metres and whatever axes it was described in, to its own axes and unit, and fills in
 * volume and moments. Axes that are principal ones already stay, so that a brick
 * described along x, y and z lies along them. Returns 0, EX_DATAERR or EX_SOFTWARE.
 */
int solid_settle(struct shape *s, int dim, struct solid_frame *was, struct failure *failure);

/* The same of a shape that has the volume, centre and moments of something else, such as the surface that its balls
   fill. */
int solid_settle_as(struct shape *s, int dim, const struct solid *of, struct solid_frame *was,
                    struct failure *failure);
