/*
 * contact/neighbours.h: which bodies are near each other. A list made at one step serves later steps
 * for as long as no pair that is missing from it can have come too close.
 */
#pragma once

#include "base/failure.h"
#include "contact/seek.h"
#include "state/placement.h"

/* All zero to begin with. */
struct neighbours {
    struct pairs list;
    vec3 *listed; /* [list.bodies] m: where the bodies were when it was made; NULL: not kept */
    /* Where the cell repeats: their images then, and the inverse of the edges */
    int32_t (*image)[3]; /* [list.bodies] */
    vec3 inverse[3];     /* 1/m */
    double thick; /* m: of the largest body with which walls have been checked to fit there */
    /* Of the walls that are meshes; they move as a whole, so that one made once serves for ever. */
    int32_t surfaces;        /* 0: not made yet, else walls */
    struct surface *surface; /* [surfaces] */
};

/*
 * Makes s->list hold every pair whose gap is at most `gap` (m) at these positions, of which centres and edges count,
 * and perhaps others that are near. Where the cell repeats a pair is
 * there once for each image of b that is near a. keep: s will be asked again, after a step of the same bodies; the
 * list is then made to reach further, and is computed again only when it no longer serves.
 *
 * The search is contact/seek.h's. Returns 0, EX_SOFTWARE or, where bodies crowd or a body is within the gap of its
 * own image, EX_DATAERR.
 */
int neighbours_find(struct neighbours *s, const struct packing *p, const struct positions *at,
                    double gap, bool keep, struct failure *failure);
/* The pair's shift now, bodies having been wrapped since the list was made */
void neighbours_shift(const struct neighbours *s, const struct packing *p, const struct pair *pair,
                      int8_t shift[3]);
/* Makes s->surface, if it is not there. Returns 0 or EX_SOFTWARE. */
int neighbours_surfaces(struct neighbours *s, const struct packing *p, struct failure *failure);
void neighbours_free(struct neighbours *s);
