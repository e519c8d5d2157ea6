/*
 * contact/time_of_impact.h: pairs of bodies that both may move and go through one another in a step, without a contact
 * where contacts are sought.
 *
 * Two bodies cross if their relative path in the window, from the place where contacts were sought to where they will
 * be sought next, is longer than both are thick, begins and ends apart, and between meets the other: a ball its
 * surface, a hull the path of the other's centre. A capsule or a clump counts as the ball inside it. In a periodic cell
 * images one edge away count [contact/fast_pairs.h], so a path longer than an edge is not seen whole.
 *
 * They are counted. Substeps [contact/time_of_impact.h] are there to leave nothing to count.
 */
#pragma once

#include "contact/fast_pairs.h"

/* Adds to `s` the crossings of the bodies for which of[p->n] is true (NULL: all) with those of the list, which has all fast bodies of
   all ranks, in any order. A pair is one of the body with the lower number where both are fast, else of the other
   one. beyond: balls need not end apart, but beyond the place at which they are nearest, where a contact would have the
   wrong normal. Returns 0 or EX_SOFTWARE. */
int tunnelling_count(struct passed *s, const struct packing *p, const bool *of,
                     const struct fast_list *list, struct window window, bool beyond,
                     struct failure *failure);

/*
 * When fast bodies meet others, and how long a substep may be for that.
 *
 * Bodies go straight on until contacts act. Two of which at least one is fast [contact/fast_pairs.h] meet where their surfaces
 * touch: of balls, and of the balls of clumps, the first root of |d + w t| = r_a + r_b, with d from centre to centre
 * and w the relative velocity; of capsules and hulls by conservative advancement [Mirtich 1996], t += gap/|w|, with
 * the distance of their cores [shape/gjk.h] and without their rotation.
 *
 * A substep ends before the first of these meetings, or has its contacts just there, and is then so short that bodies
 * go by no more than 0.01 to 0.05 of the thinner one's thickness before the next contacts are sought: they leave on
 * straight paths from where they have met. Between such meetings substeps may be as long as the step.
 */

/* Of the bodies for which of[p->n] is true (NULL: all) with those of the list, which has the fast bodies of all ranks for a step of p->dt,
   of which `rest` (s) is left, for `left` substeps at most: *part = how long (s) the next substep may be, at most the rest. Bodies lie in the cell.
   Returns 0 or EX_SOFTWARE. */
int time_of_impact_part(double *part, const struct packing *p, const bool *of,
                        const struct fast_list *list, double rest, int64_t left,
                        struct failure *failure);
