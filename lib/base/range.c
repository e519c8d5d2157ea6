/* base/range.c: reads a range of steps. */
#include "base/range.h"

#include <errno.h>
#include <stdlib.h>

/* Reads a number, or nothing, up to a colon or the end, and moves *s there. */
static bool parse_part(const char **s, int64_t *x)
{
    char *end;
    errno = 0;
    if (**s != ':' && **s) {
        *x = strtoll(*s, &end, 10);
        if (end == *s || errno || *x < 0) return false;
        *s = end;
    }
    return **s == ':' || !**s;
}

bool range_parse(struct range *r, const char *s)
{
    *r = (struct range){ 0, INT64_MAX, 1 };
    if (!*s || !parse_part(&s, &r->from)) return false;
    if (!*s) { // one step alone
        r->to = r->from;
        return true;
    }
    s++;
    if (!parse_part(&s, &r->to)) return false;
    if (!*s) return r->from <= r->to;
    s++;
    return parse_part(&s, &r->by) && !*s && r->by > 0 && r->from <= r->to;
}
