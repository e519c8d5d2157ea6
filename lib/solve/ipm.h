/*
 * solve/ipm.h: a primal-dual interior point method for all contacts at once: the central path [solve/central_path.h] to
 * its end by long steps, Mehrotra's two directions and Gondzio's correctors.
 *
 * t = 1 is Newton's method on the problem, which is nobody's minimum, so that the path may fold and the
 * step leads nowhere: then it is followed by its arc length [solve/arc.h]. At the start, and from r = 0,
 * smaller t are tried.
 */
#ifndef NSD_IPM_H
#define NSD_IPM_H

#include "solve/newton.h"

/*
 * From the iterate on to where newton_polish() ends; where that does not, from r = 0. w has the problem and
 * its factors, and makes the last steps.
 */
void ipm_solve(struct newton *w, struct solve *s);

/* The first of that alone: from the iterate's reactions, moved into the cones as far as this gap */
void ipm_from(struct newton *w, struct solve *s, double gap);

#endif
