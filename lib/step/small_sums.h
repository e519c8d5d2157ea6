/*
 * step/small_sums.h: what bodies do to walls in small steps, which an interval adds to the packing's sums
 * [state/wall_load.h]. Each small step counts as a step of its own, by its reactions and its mean velocities.
 */
#pragma once

#include "step/small_run.h"

/* r->sums, where the packing has sums. Returns 0 or EX_SOFTWARE. */
int small_sums_init(struct small_run *r, struct failure *failure);
/* Adds what touches do in a small step, after its sweeps and before reactions are settled; by one thread. */
void small_sums_step(struct small_run *r);
/* The packing's sums get those of the interval. */
void small_sums_give(const struct small_run *r);
