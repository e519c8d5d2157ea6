/* measure/counts.h: how many contacts each body has, and which bodies bear nothing. */
#ifndef NSD_COUNTS_H
#define NSD_COUNTS_H

#include "measure/snapshot.h"

#include <stdint.h>

/* [n] contacts that count [measure/branch.h] of each body; NULL when memory is short. To be freed. */
int32_t *counts_of(const struct snapshot *s);
/*
 * Takes contacts off count[n] until every body that moves has none or at least `least`: what is left
 * bears. Returns 0, or -1 when memory is short.
 */
int counts_without_rattlers(int32_t *count, const struct snapshot *s, int least);
/* A body that moves, to which measures keep, and whose centre is in the region? */
bool counts_body(const struct snapshot *s, int64_t i);

#endif
