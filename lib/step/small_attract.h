/*
 * step/small_attract.h: what attracts bodies at the points of their meetings in small steps: a constant pull within a range and
 * liquid bridges [solve/small_hold.h]. A meeting has one bridge, and its points share its pull as the places of a
 * pair do in a step made at once [state/attraction.h].
 */
#pragma once

#include "step/small_run.h"

/* Points pull in the small step in hand, by t->pull; after they have been looked for, by one thread */
void small_attract(struct small_run *r);
void small_attract_free(struct small_run *r);

/* m: points of the meeting are attracted up to this gap; 0: none is */
double small_attract_reach(const struct small_meeting *m);
/* J: stored in it */
double small_attract_energy(const struct small_meeting *m);
/* m: the smallest gap of its points; infinite without one */
double small_attract_gap(const struct small_meeting *m);
