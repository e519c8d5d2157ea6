/*
 * step/small_lay.h: the pairs of a list in bundles, in groups without a common body: those that are near come first.
 */
#pragma once

#include "step/small_list.h"

/* Of the smallest radius: how much farther than contacts pairs are listed, and how near those are that come first */
#define SMALL_MARGIN 0.3
#define SMALL_BESIDE 0.1

/* Lays l->pairs, whose bodies are at x (m) with these edges of the cell (m): l->slot, and what the laws of p give their bundles.
   False when memory is short. */
bool small_pairs_lay(struct small_list *l, const struct packing *p, const vec3 *x,
                     const vec3 edge[3]);
