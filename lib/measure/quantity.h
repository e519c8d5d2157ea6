/* measure/quantity.h: what a measure's numbers are called, and their units. */
#ifndef NSD_QUANTITY_H
#define NSD_QUANTITY_H

#include <stdbool.h>
#include <string.h>

struct quantity {
    const char *name; /* NULL ends a list */
    const char *
        unit; /* in space; "1" without any; "name": the number is a row of the packing's names, which is printed */
    int width;        /* numbers: 1, 3 a vector, 9 a tensor by rows */
    const char *help; /* a few words */
};

static inline bool quantity_is_name(const struct quantity *q)
{
    return !strcmp(q->unit, "name");
}

#endif
