/*
 * mpi/settings.h: all that a packing has besides its bodies, what they are made of and bounded by, on its
 * way from the first rank to the others: whole, and what of it changes from step to step.
 */
#pragma once

#include "mpi/comm.h"
#include "state/packing.h"

/* Collective. Of the first rank's packing; in the others *p is made, with no bodies: freed before. */
void settings_spread(struct comm *t, struct packing *p);
/* The first rank's packing becomes that of all, with its bodies, but for its scene. */
void settings_spread_all(struct comm *t, struct packing *p);
/* Time, walls and edges of the first rank's packing become those of the others', which are otherwise
   the same. */
void settings_follow(struct comm *t, struct packing *p);
/* Gravity, friction, the motion of walls and the forces on their loads, which a program has changed, of the first
   rank's `whole` become those of every p; and p has the arrays of forces and torques that whole has, for its bodies. */
void settings_act(struct comm *t, struct packing *p, const struct packing *whole);
/* The same of two packings of one rank */
void settings_copy_motion(struct packing *to, const struct packing *from);
