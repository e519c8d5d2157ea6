/*
 * solve/subset.h: the contacts that hold up the sweeps, solved by themselves while the reactions of
 * all others are held.
 *
 * After some hundred sweeps the natural map is mostly large in a few dozen contacts only, whose
 * reactions depend on one another in a way that sweeps hardly change; all others follow them. With
 * p these contacts and their nearest neighbours, and o the others,
 *
 *     v_p = W_pp x_p + q_p + W_po x_o
 *
 * is a problem given by its W. Its factorisation costs about a hundredth of that of all contacts;
 * some sweeps then adapt the others.
 */
#pragma once

#include "solve/scaled.h"

/*
 * Solves a subset of at least `contacts` contacts, more where the natural map is large in more. The
 * iterate gets their new reactions and is judged; its criterion may well be larger than before,
 * since the others have not adapted yet. The subset is not tried, and the iterate stays as it was,
 * where it would have more than a fifth of all contacts (`anyhow`: half, and fewer count as large),
 * or where the fill of its factors makes a solution cost more than `budget` ns [solve/solver.h].
 *
 * Returns the number of contacts solved; 0 for none, -1 when memory is short.
 */
int64_t subset_solve(struct scaled *a, struct solve *s, int64_t contacts, bool anyhow,
                     double budget);

/* Whether subset_solve() would get as far as analysing factors: 1, 0; -1 when memory is short */
int subset_fits(const struct scaled *a, const struct solve *s, int64_t contacts, bool anyhow,
                double budget);
