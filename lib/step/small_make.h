/*
 * step/small_make.h: the list of small steps is made: pairs and touches of walls that come near on straight ways.
 */
#pragma once

#include "step/small_list.h"

/* What a list is made of */
struct small_start {
    const vec3 *x,
        *v; /* [bodies] m, m/s; v NULL: where they go is not known, and the list serves a shorter way */
    const vec3 *edge; /* [3] m: of the cell */
    double t, span;   /* s: of the walls; in which it is to serve */
    double wall;      /* m/s: of the fastest point of walls */
};
/*
 * Finds the pairs of bodies, and of these with walls. What pairs and touches of the list before have is kept. Returns 0,
 * EX_SOFTWARE or EX_DATAERR.
 */
int small_list_make(struct small_list *l, const struct packing *p, const struct small_start *o,
                    struct failure *failure);
