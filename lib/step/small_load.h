/*
 * step/small_load.h: walls that loads push, and rooms under a pressure, in small steps. Each is one speed s with a mass m
 * [state/freedom.h], solved with all its touches at once: with D the velocity of the wall's material at a touch per unit of
 * s, and f_i(s) the reaction that the law makes of touch i alone,
 *
 *     m (s - s^-) = h F - sum of D_i . f_i(s),
 *
 * whose right side falls with s: one Newton step after the other within a bracket ends at its root, whatever the mass. So a
 * lid that is light pushes as exactly as a heavy one, and sweeps have no part in it. Of the reactions in s rate.warm persists,
 * as in bodies. Loads in the packing move with each small step.
 */
#pragma once

#include "step/small_run.h"

/* r->loads, where the packing has loads on walls. Returns 0 or EX_SOFTWARE. */
int small_loads_init(struct small_run *r, struct failure *failure);
/* failed: the loads of the packing are what they were. */
void small_loads_free(struct small_run *r, bool failed);
/* A small step begins: its loads, and their free motion; by one thread, as all that follow */
void small_loads_begin(struct small_run *r);
/* Points of meetings with their walls start; by one thread */
void small_loads_start(struct small_run *r);
void small_loads_sweep(struct small_run *r, bool again);
/* What persists, and the motion */
void small_loads_end(struct small_run *r);
/* Has a wall so large a mass, or one that turns so large an inertia, that small steps would make it rebound from grains? */
bool small_loads_heavy(const struct packing *p);
/* J: of what the loads of a packing move */
double small_loads_energy(const struct packing *p);
