/*
 * contact/crossing.h: pairs of bodies that both may move and go through one another in a step, without a contact
 * where contacts are sought.
 *
 * Two bodies cross if their relative path in the window, from the place where contacts were sought to where they will
 * be sought next, is longer than both are thick, begins and ends apart, and between meets the other: a ball its
 * surface, a hull the path of the other's centre. A capsule or a clump counts as the ball inside it. In a periodic cell
 * images one edge away count [contact/fast_pairs.h], so a path longer than an edge is not seen whole.
 *
 * They are counted. Substeps [contact/meeting.h] are there to leave nothing to count.
 */
#ifndef NSD_CROSSING_H
#define NSD_CROSSING_H

#include "contact/fast_pairs.h"

/* Adds to `s` the crossings of the bodies for which of[p->n] is true (NULL: all) with those of the list, which has all fast bodies of
   all ranks, in any order. A pair is one of the body with the lower number where both are fast, else of the other
   one. beyond: balls need not end apart, but beyond the place at which they are nearest, where a contact would have the
   wrong normal. Returns 0 or EX_SOFTWARE. */
int tunnelling_count(struct passed *s, const struct packing *p, const bool *of,
                   const struct fast_list *list, struct window window, bool beyond,
                   struct failure *failure);

#endif
