/*
 * draw/solid.h: boundaries that are drawn solid and shaded: which of their faces, and in which colour: one for each name,
 * or by what bodies have done to each face, from the sums of nsd-step --sums [state/wall_load.h].
 */
#ifndef NSD_SOLID_H
#define NSD_SOLID_H

#include "state/face_of.h"
#include "draw/paint.h"

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
    const char *list; /* names and numbers of boundaries [state/selection.h]; NULL: all */
    enum solid_by by;
    double lo, hi; /* the palette's ends; NAN: those of what there is */
    const struct paint *paint;
};

/* Returns 0, EX_DATAERR (an unknown name, no sums) or EX_SOFTWARE with nothing to free. */
int solid_init(struct solid_walls *s, const struct packing *p, const struct solid_opt *o,
               struct failure *failure);
void solid_free(struct solid_walls *s);

#endif
