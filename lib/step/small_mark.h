/*
 * step/small_mark.h: which bundles a repeated sweep looks at: those with a body that this sweep or the one before has changed by
 * more than is allowed.
 */
#pragma once

#include "solve/small.h"

/* By one thread, before the first repeated sweep of a list. Where memory is short repeated sweeps look at all bundles. */
void small_marks_make(struct small *s);
void small_marks_free(struct small *s);
/* Marks the bundles of bodies first .. end-1 that are hot where the sweep begins. */
void small_marks_begin(struct small *s, int64_t first, int64_t end);
