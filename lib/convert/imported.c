#include "convert/imported.h"

#include <stdlib.h>

struct imported_ball imported_ball(void)
{
    return (struct imported_ball){ .q = { 1, 0, 0, 0 }, .type = 1, .id = -1 };
}

int imported_add(struct imported *t, const struct imported_ball *ball, struct failure *failure)
{
    if (t->head.n == IMPORTED_MOST)
        return failure_set(failure, EX_DATAERR, "more than %d balls", IMPORTED_MOST);
    if (t->head.n == t->room) {
        int64_t room = t->room ? t->room + t->room / 2 : 1024;
        struct imported_ball *more = realloc(t->ball, (size_t)room * sizeof *more);
        if (!more) return failure_set(failure, EX_SOFTWARE, "no memory for the balls of a file");
        t->ball = more, t->room = room;
    }
    t->ball[t->head.n++] = *ball;
    return 0;
}

void imported_free(struct imported *t)
{
    free(t->ball);
    *t = (struct imported){ 0 };
}
