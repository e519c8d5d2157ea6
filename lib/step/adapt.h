/*
 * step/adapt.h: a time step that adapts, so that bodies do not come into one another by more than a share
 * of a radius in one step.
 *
 * At the beginning of a step bodies, walls and the cell are moved on by all of dt at their velocities. Where
 * two then overlap, what is new of it is
 *
 *     min(overlap, approach velocity dt) / the smaller radius,
 *
 * which is more than the step leaves, for its contacts act midway. The largest of these, x, decides:
 *
 *     x(dt) > TOL                          dt is halved, as often as it takes,
 *     x(2 dt) <= TOL/2                     dt is doubled, after an even number of steps from the origin of
 *                                          the time, and never beyond the document's.
 *
 * So times stay multiples of dt, and are exact [packing_set_dt()]. Nothing but the state at the beginning of
 * a step decides: a run that resumes from a frame makes the same steps.
 *
 * What a body gets from others within the step it does not know: where a heavy body strikes a row of light
 * ones, more may come.
 */
#pragma once

#include "contact/neighbours.h"
#include "state/packing.h"

/* So many times dt is halved at most, to 1.5e-5 of it: impacts that go by a radius in a step then stay below any
   TOL that makes sense, and what is jammed between walls does not stop a run for good. */
enum { ADAPT_MOST = 16 };

/* dt of the step to come, tol a share of a radius; near: neighbours that are kept from one call to the next.
   Returns 0, or EX_SOFTWARE. */
int adapt_step(struct packing *p, double tol, struct neighbours *near, struct failure *failure);
