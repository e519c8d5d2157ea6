/* solve/best.c: one point and its value [solve/best.h]. */
#include "solve/best.h"

#include <math.h>
#include <stdlib.h>

int best_init(struct best *b, int64_t size)
{
    *b = (struct best){ INFINITY, size, malloc(((size_t)size + 1) * sizeof *b->x), -1 };
    return b->x ? 0 : -1;
}

void best_free(struct best *b)
{
    free(b->x);
    *b = (struct best){ .value = INFINITY };
}

double *best_offer(struct best *b, double value)
{
    if (!b->x || !(value < b->value)) return NULL;
    b->value = value;
    return b->x;
}

void best_forget(struct best *b)
{
    b->value = INFINITY;
}
