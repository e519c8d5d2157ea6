/*
 * step/move.h: the second half of a step: what the reactions make of velocities and positions.
 *
 *     qdot_{k+1} = qdot_free + M^-1 P r,   q_{k+1} = q_{k+1/2} + theta dt qdot_{k+1}
 *
 * and the cell's edges by their rates (shape/cell.h)
 *
 * [uzawa3 and the line after it]; q_{k+1/2} is the predicted position, in which the contacts act.
 */
#pragma once

#include "state/report.h"
#include "step/impulse.h"
#include "step/project.h"

/* The bodies and the freedoms move, by the contacts' reactions, and bodies apart where the packing
   needs it [step/project.h], did, or NULL: what that has done; step and t advance. Returns 0 or EX_SOFTWARE. */
int move_step(struct packing *p, const struct contacts *s, struct projected *did,
              struct failure *failure);

/* The same where the sums of the reactions are there already; bodies are not moved apart. */
int move_by(struct packing *p, const struct contacts *s, const struct impulses *sum,
            struct failure *failure);

/* After move_by() with these sums; what is reported of the step is not looked at. */
struct endless endless_after(const struct packing *p, const struct impulses *sum);

/* Back to before move_step(), to rounding: what a solution in a trajectory is checked from. A
   projection is not undone: the errors depend on velocities, and where there is a projection the
   lever arms on radii. */
int move_back(struct packing *p, const struct contacts *s, struct failure *failure);
