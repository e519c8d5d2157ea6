/*
 * step/work_bound.h: reactions that have not converged give no energy. The work of r on the motion without it,
 *
 *     sum r . (u_free + u+)/2 = r . u_free + r . W r/2,
 *
 * is at most 0 for every solution, but for what springs and drives supply and impacts may gain [step/balance.h]. An iterate that is kept
 * at a limit may do more, and run after run of steps then throws bodies out of the packing. It is reduced to
 * s r, 0 <= s < 1, whose work is 0.
 */
#pragma once

#include "step/impulse.h"

/* Of solved contacts; *again: their reactions and moments are reduced, and u is no longer theirs. Returns 0 or EX_SOFTWARE. */
int work_reduce(const struct packing *p, struct contacts *s, bool *again, struct failure *failure);
