/* step/small_group.h: the groups of a list of small steps: pairs without a common body, in bundles. */
#pragma once

#include "step/small_list.h"

/* Of the smallest radius: how much farther than contacts pairs are listed */
#define SMALL_MARGIN 0.3

/* l->s.group and l->slot of all pairs, and what of them is this process's part. Returns 0 or EX_SOFTWARE. */
bool small_groups_lay(struct small_list *l, const struct packing *p, const vec3 *x,
                      const vec3 *edge);
