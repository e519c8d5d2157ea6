/*
 * solve/even.h: where a few contacts of faces begin. Their reactions, and with friction the motion too, are often not
 * unique; a sweep, which begins somewhere, then prefers one corner to another, and a box between two plates turns
 * as it slides. Steps in which all contacts move at once,
 *
 *     x <- P(y - v^(y)/lambda),   v = W y + q,   lambda = |W|,
 *
 * with y ahead of x by Nesterov's momentum, prefer none: a symmetric problem keeps its symmetry to rounding, in
 * whatever order its contacts are. What sweeps find from there lies next to it.
 */
#ifndef NSD_EVEN_H
#define NSD_EVEN_H

#include "solve/solver.h"

/* Is the problem one of few contacts with faces? The same in every process that has a part of it. */
bool even_concerns(const struct problem *p);
/* Makes such steps from the iterate, a bounded number, and judges. Returns 0, or -1 when memory is short. */
int even_start(struct solve *s);

#endif
