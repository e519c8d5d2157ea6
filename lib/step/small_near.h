/*
 * step/small_near.h: how fast bodies are against what is near them, from which the number of small steps follows. A body that
 * flies alone, or with its neighbours, needs none: its motion is exact for any h.
 */
#pragma once

#include "step/small_run.h"

/* m/s: the largest speed of the bodies of a pair of the list against each other where the interval begins, or of a body against a wall
   that it comes near, which may then be as fast as it ever is. The list has straight ways. */
double small_near_speed(struct small_run *r);
