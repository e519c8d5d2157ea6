/*
 * shape/fracture.h: convex shapes cut into pieces, and balls replaced by what lies inside them.
 *
 * A sharp hull is cut by the Voronoi tessellation of points inside it: the piece of a point is what is nearer to it than to
 * the others, the hull cut by the planes in the middle between the point and each of them. Pieces are convex and leave no
 * gaps, so that their volume and their first and second moments sum to those of the hull.
 *
 * A ball becomes a polyhedron inscribed in it, which is cut so, or a centre and 12 equal balls around it (in the plane 6
 * discs), each of a third of its radius: 13/27 of its volume (7/9 of its area). The packings that tests of crushing use
 * lose as much [Ciantia, Arroyo, Calvetti, Gens, Geotechnique 65 (2015): 14 balls, 47 %].
 */
#pragma once

#include "shape/solid.h"

#include <gsl/gsl_rng.h>

enum {
    FRACTURE_MOST = 64, /* points, and so pieces, of a hull */
    FRACTURE_BALLS = 13 /* at most, in a ball */
};

/* Points inside a hull, of which each place is as likely; it has finished [shape_finish()]. */
void fracture_draw(vec3 *point, int n, const struct shape *hull, int dim, gsl_rng *rng);

/* Can it be cut: is it a hull without a round? */
static inline bool fracture_cuts(const struct shape *s)
{
    return shape_has_faces(s) && s->round == 0;
}

/*
 * The pieces of a hull, of its n points, in its frame and its unit: vertices, faces and corners, and neither a name nor what
 * solid_settle() and shape_finish() add. Returns 0, EX_SOFTWARE or, where rounding leaves a piece without a closed
 * surface, EX_DATAERR: other points may do. piece[n] is to be freed by fracture_free() after 0.
 */
int fracture_cut(struct shape *piece, int n, const vec3 *point, const struct shape *hull, int dim,
                 struct failure *failure);
void fracture_free(struct shape *piece, int n);

/* The polyhedron of 42 vertices and 80 faces, or the polygon of 24, inscribed in the ball of radius 1; without what
   solid_settle() adds. Returns 0 or EX_SOFTWARE. */
int fracture_inscribe(struct shape *out, int dim, struct failure *failure);

/* Centres of the equal balls of radius 1/3 in a ball of radius 1; returns how many. */
int fracture_balls(vec3 centre[FRACTURE_BALLS], int dim);
