/*
 * step/small_tie.h: what the materials of a packing attract by in small steps [solve/small_hold.h], and static friction.
 */
#pragma once

#include "solve/small.h"
#include "state/packing.h"

/* Does any pair of materials attract? */
bool small_tie_holds(const struct packing *p);
/* m: no pair is held together at a larger gap, and, without a bridge, none in a step of h (s) */
double small_tie_reach(const struct packing *p);
double small_tie_range(const struct packing *p, double h);
/* m/s^2: no pull gives more to a body */
double small_tie_most(const struct packing *p);
/* m/s: no pull makes a body faster in a step of the packing's dt: it comes no farther than the reach */
double small_tie_speed(const struct packing *p);
/* x = that of body a (< 0: wall -1-a) and body b, dry and without a pull, in steps of h (s) */
void small_tie_set(double x[HOLD_COUNT], const struct packing *p, int32_t a, int32_t b, double h);
/* Static and kinetic friction of a pair, as struct small_stick has them */
void small_tie_stick(double mu[2], double *v_s, const struct packing *p, int32_t pair);
