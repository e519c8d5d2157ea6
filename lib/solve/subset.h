/*
 * solve/subset.h: the contacts that hold the sweeps up, solved by themselves while the others' reactions stand.
 *
 * After some hundred sweeps the natural map is mostly large in some dozens of contacts only, whose
 * reactions hang on one another in a way that sweeps hardly see; all others follow them. Of these and
 * the nearest around them, p, and the others, o,
 *
 *     v_p = W_pp x_p + q_p + W_po x_o
 *
 * is a problem given by its W. To factorise it costs a hundredth of what all contacts do; what the
 * others make of it is then a matter of sweeps.
 */
#ifndef NSD_SUBSET_H
#define NSD_SUBSET_H

#include "solve/newton.h"

/*
 * Solves so many contacts, or more where the natural map is large in more, from the rows' reactions;
 * what came of it is in the rows, where the criterion may well be larger than before: the others were
 * not asked. Returns how many it were; 0 where it would have been more than a fifth of all (`anyhow`:
 * half, and fewer then count as large), or memory is short: the rows are as they were.
 */
int64_t subset_solve(struct newton *w, struct solve *, int64_t contacts, bool anyhow);

#endif
