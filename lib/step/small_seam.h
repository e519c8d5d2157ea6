/*
 * step/small_seam.h: balls at seams of flat walls [contact/internal_edge.h].
 */
#pragma once

#include "step/small_run.h"

/* Is touch i of the list with a rectangle or disc that continues the surface of another wall, which the ball is within reach (m) of, too?
   It then is none. Bodies are where the step finds them. */
bool small_at_seam(struct small_run *r, int64_t i, double reach);
