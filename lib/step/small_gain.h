/*
 * step/small_gain.h: sweeps that end early give no energy. The work of all reactions of a small step,
 *
 *     sum over bodies of m (v - v_free) . (v_free + v)/2, and the same of w,
 *
 * less the work of walls that move is at most 0 where they are on their law, but for overlaps that are pushed apart. Bodies of other
 * shapes than balls have several points, whose reactions one sweep leaves so far from their law that collisions gain
 * energy. Such a small step is swept again.
 */
#pragma once

#include "step/small_run.h"

/* An interval begins: are the gains of its small steps bounded? Not where something attracts, springs push, or loads or a cell move: these
   exchange energy that is not that of bodies. */
bool small_gain_is_bounded(const struct small_run *r);
/* By one thread, between sweeps: has the small step gained energy, and, when it has been swept before for that, less than 0.9 of *last
   (J)? *last gets the gain. */
bool small_gain_exceeds(const struct small_run *r, double *last);
