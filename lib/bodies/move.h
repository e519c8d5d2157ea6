/*
 * bodies/move.h: the second half of a step: what the reactions make of velocities and positions.
 *
 *     qdot_{k+1} = qdot_free + M^-1 P r,   q_{k+1} = q_{k+1/2} + theta dt qdot_{k+1}
 *
 * [uzawa3 and the line after it]; q_{k+1/2} is the predicted position, in which the contacts act.
 */
#ifndef NSD_MOVE_H
#define NSD_MOVE_H

#include "bodies/contact.h"
#include "bodies/packing.h"

/* The bodies move, by the contacts' reactions, and apart where the packing wants it
   [bodies/project.h]; step and t advance. Returns 0 or EX_SOFTWARE. */
int move_step(struct packing *p, const struct contacts *s, struct why *why);

/* Back to before move_step(), to rounding: what a solution in a trajectory is checked from. A
   projection is not undone: the errors depend on velocities, and where there is a projection the
   lever arms on radii. */
int move_back(struct packing *p, const struct contacts *s, struct why *why);

#endif
