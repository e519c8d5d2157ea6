#include "state/passage.h"

#include <stdlib.h>

int events_add(struct events *s, const struct event *e, struct failure *failure)
{
    if (s->n == s->room) {
        int64_t room = s->room ? 2 * s->room : 64;
        struct event *more = realloc(s->e, (size_t)room * sizeof *more);
        if (!more) return failure_set(failure, EX_SOFTWARE, "no memory for events");
        s->e = more, s->room = room;
    }
    s->e[s->n++] = *e;
    return 0;
}

void events_free(struct events *s)
{
    free(s->e);
    *s = (struct events){ 0 };
}
