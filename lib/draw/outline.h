/*
 * draw/outline.h: walls that are not planes as triangles and lines, for pictures, pages and other
 * programs: each at the packing's time, round shapes by OUTLINE_FACETS facets. Planes have no end:
 * draw/walls.h cuts them.
 */
#pragma once

#include "base/failure.h"
#include "state/packing.h"

enum { OUTLINE_FACETS = 64 };

struct outline_triangle {
    vec3 corner[3]; /* m */
    int32_t wall;   /* whose it is */
    int32_t face;   /* of a mesh its triangle, from the wall's first one; else 0 */
};

/* In space the borders and sharp edges of shapes; in the plane all of them */
struct outline_line {
    vec3 end[2]; /* m */
    int32_t wall;
    int32_t face; /* in the plane, of a mesh its segment; else 0 */
};

struct outline {
    int64_t triangles, lines, triangle_room, line_room;
    struct outline_triangle *triangle;
    struct outline_line *line;
};

/* reach (m): as far as shapes without an end are followed from the point of reference, to both sides.
   Returns 0, or EX_SOFTWARE with nothing to free. */
int outline_init(struct outline *o, const struct packing *p, double reach, struct failure *failure);
void outline_free(struct outline *o);
