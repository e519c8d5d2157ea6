/* measure/quantity.h: what a measure's numbers are called, and their units. */
#ifndef NSD_QUANTITY_H
#define NSD_QUANTITY_H

struct quantity {
    const char *name; /* NULL ends a list */
    const char *unit; /* in space; "1" without any */
    int width;        /* numbers: 1, 3 a vector, 9 a tensor by rows */
    const char *help; /* a few words */
};

#endif
