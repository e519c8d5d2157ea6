/* base/range.h: A:B:K, the steps from A to B of which every K-th counts; any of them may be left out. */
#ifndef NSD_RANGE_H
#define NSD_RANGE_H

#include <stdbool.h>
#include <stdint.h>

struct range {
    int64_t from, to, by;
};

/* "7", "100:", ":50", "0:1000:10", "::10"; false where it is none. */
bool range_parse(struct range *, const char *);
static inline bool range_has(const struct range *r, int64_t step)
{
    return step >= r->from && step <= r->to && (step - r->from) % r->by == 0;
}

#endif
