/*
 * draw/facets.h: the surfaces of grains as polygons: sharp hulls by their faces, clumps by the
 * triangles of their balls, rounded shapes by those of a ball whose corners are moved along its radii.
 * Balls are icosahedra whose faces are divided into four `detail` times; discs have 48 corners.
 */
#pragma once

#include "base/failure.h"
#include "state/packing.h"

struct facets_triangle {
    vec3 corner[3];
};

/* Triangles of the unit ball */
struct facets {
    int64_t n;
    struct facets_triangle *t; /* [n] */
};

/* Returns 0 or EX_SOFTWARE, with nothing to free. */
int facets_init(struct facets *f, int detail, struct failure *failure);
void facets_free(struct facets *f);

/* Each polygon of grain i to `put`, its corners (m) counterclockwise seen from outside */
typedef void facets_text(void *to, int corners, const vec3 *x);
void facets_of(const struct facets *f, const struct packing *p, int64_t i, facets_text *put,
               void *to);
/* Are the polygons of this shape its faces, and not pieces of something round? */
static inline bool facets_are_faces(const struct shape *s)
{
    return shape_has_faces(s) && s->round == 0;
}
/* How many triangles these polygons are, each cut into a fan */
int64_t facets_triangles(const struct facets *f, const struct packing *p, int64_t i);
