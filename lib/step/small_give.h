/* step/small_give.h: the contacts at the end of an interval of small steps. */
#pragma once

#include "step/small_run.h"

/* With the sums of their reactions over the interval; bare: only those that overlap, without bases, laws and reactions.
   Returns 0 or EX_SOFTWARE. */
int small_give_contacts(const struct small_run *r, struct contacts *out, bool bare,
                        struct failure *failure);
