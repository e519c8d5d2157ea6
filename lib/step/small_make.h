/*
 * step/small_make.h: the list of small steps is made: pairs and touches of walls that come near on straight ways;
 * and its pairs are laid in bundles, in groups without a common body, those that are near first.
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

/* Of the smallest radius: how much farther than contacts pairs are listed, and how near those are that come first */
#define SMALL_MARGIN 0.3
#define SMALL_BESIDE 0.1

/* Lays l->pairs, whose bodies are at x (m) with these edges of the cell (m): l->slot, and what the laws of p give their bundles.
   False when memory is short. */
bool small_pairs_lay(struct small_list *l, const struct packing *p, const vec3 *x,
                     const vec3 edge[3]);
