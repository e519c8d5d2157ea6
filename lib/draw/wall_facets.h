/*
 * draw/wall_facets.h: walls that are drawn solid and shaded: which of their faces, and in which colour: one for each name,
 * or by what bodies have done to each face, from the sums of nsd-step --wall-loads [state/wall_load.h].
 */
#pragma once

#include "draw/outline.h"
#include "draw/paint.h"
#include "draw/walls.h"
#include "state/face_of.h"

enum solid_by { SURFACE_NAME, SURFACE_PRESSURE, SURFACE_FRICTION, SURFACE_RUB, SURFACE_COUNT };

/* What the colour of a face shows; a table in solid.c */
struct surface_meaning {
    const char *name, *unit, *help;
};
extern const struct surface_meaning surface_meaning[SURFACE_COUNT];

enum { SOLID_NAMES = 8 }; /* that a legend has, at most */

struct solid_walls {
    struct wall_faces faces;
    struct rgb *colour; /* [faces.n]; r < 0: it is not drawn solid */
    enum solid_by by;
    double lo, hi; /* at the palette's ends; of SURFACE_NAME nothing */
    int named;     /* names of the legend, */
    char name[SOLID_NAMES][NAME_BYTES + 12];
    struct rgb shown[SOLID_NAMES]; /* and their colours */
};

struct solid_opt {
    const char *list; /* names and numbers of walls [state/selection.h]; NULL: all */
    enum solid_by by;
    double lo, hi; /* the palette's ends; NAN: those of what there is */
    const struct paint *paint;
};

/* Returns 0, EX_DATAERR (an unknown name, no sums) or EX_SOFTWARE with nothing to free. */
int solid_init(struct solid_walls *s, const struct packing *p, const struct solid_opt *o,
               struct failure *failure);
void solid_free(struct solid_walls *s);

/*
 * Walls as half-transparent facets, so that a picture shows where they are and what
 * they hold.
 *
 * At a sample, facets in front of what is seen take part k, 0 < k < 1, of its light and give their own:
 * c (1 - T) + seen T, T = product of (1 - k), c the mean of their light with weights k. This does not
 * depend on their order, so none has to be sought.
 */

struct facet {
    vec3 corner[3]; /* m */
    vec3 n;         /* its unit normal; both sides look the same */
    struct rgb own; /* its colour where it is solid; r < 0: it is glass */
};

struct glass {
    int64_t facets;
    struct facet *facet;
};

/* Which walls are drawn as facets */
struct glass_opt {
    struct extent region;
    vec3 toward;                     /* unit vector to the viewer */
    const struct solid_walls *solid; /* those that are solid; NULL: none */
    bool glass;                      /* the others, too */
};

/* The walls of p inside the region, at p's time, in space; none in the plane. Planes that are drawn
   as floors where the viewer sees them are left out, unless they are solid. Returns 0, or
   EX_SOFTWARE with nothing to free. */
int glass_init(struct glass *g, const struct packing *p, const struct glass_opt *o,
               struct failure *failure);
void glass_free(struct glass *g);

/* The part of the light that a facet takes; z: the cosine between its normal and the line of sight */
static inline float glass_part(double z)
{
    double beside = 1 - fabs(z); // where it is seen edgewise, there is more of it in the way
    return (float)(0.10 + 0.35 * beside * beside * beside);
}
