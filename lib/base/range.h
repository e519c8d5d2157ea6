/* base/range.h: ranges of steps, "A:B:K": every K-th step from A to B. Any may be left out. */
#ifndef NSD_RANGE_H
#define NSD_RANGE_H

#include <stdbool.h>
#include <stdint.h>

struct range {
    int64_t from, to, by; /* from, from + by ... up to and with to */
};

/* Parses "7", "100:", ":50", "0:1000:10", "::10" ...; false where text is no range. */
bool range_parse(struct range *r, const char *text);
static inline bool range_has(const struct range *r, int64_t step)
{
    return step >= r->from && step <= r->to && (step - r->from) % r->by == 0;
}

#endif
