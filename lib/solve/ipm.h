/*
 * solve/ipm.h: a primal-dual interior point method for all contacts at once: it follows the central
 * path [solve/central_path.h] to its end by long steps, with Mehrotra's two directions and
 * Gondzio's correctors.
 *
 * t = 1 is Newton's method. The problem is not that of a minimum, so the path may fold, and steps
 * become very short there: then it is followed by its arc length [solve/arc.h]. At the start, and
 * from r = 0, smaller t are tried first.
 */
#pragma once

#include "solve/newton.h"

/*
 * Starts from the iterate and ends with newton_polish(); where that does not meet the criterion,
 * tries again from r = 0. w has the problem and its factors, and makes the last steps.
 */
void ipm_solve(struct newton *w, struct solve *s);

/* The first attempt of ipm_solve() only: from the iterate's reactions, moved into the cones to
   where x o z = gap (1, 0, 0). */
void ipm_from(struct newton *w, struct solve *s, double gap);
