/*
 * step/small_near.h: how fast bodies close the gaps to what is near them, from which the number of small steps follows. A body that
 * flies alone, or with its neighbours, needs none: its motion is exact for any h.
 */
#pragma once

#include "step/small_run.h"

/* m/s: the largest speed with which a pair or a touch of the list closes its gap, or a part of that with which its surfaces
   pass each other, where the interval begins. The list has straight ways. */
double small_near_speed(struct small_run *r);
