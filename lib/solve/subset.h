/*
 * solve/subset.h: the contacts that hold the sweeps up, solved by themselves while the others' reactions
 * stand.
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

#include "solve/scaled.h"

/*
 * Solves `contacts` of them, or more where the natural map is large in more, from the iterate, which has
 * their new reactions afterwards, judged: the criterion may well be larger than before, for the others were
 * not asked. Not tried: more than a fifth of all contacts (`anyhow`: half, and fewer count as large), and
 * factors whose fill makes a solution dearer than `budget` [solve/prices.h]: then the iterate is as it was.
 *
 * Returns the number of contacts that were solved; 0 for none, -1 when memory is short.
 */
int64_t subset_solve(struct scaled *a, struct solve *s, int64_t contacts, bool anyhow,
                     double budget);

/* Whether subset_solve() would try, as the iterate is: 1, 0, or -1 when memory is short */
int subset_fits(const struct scaled *a, const struct solve *s, int64_t contacts, bool anyhow,
                double budget);

#endif
