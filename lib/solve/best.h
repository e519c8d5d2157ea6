/* solve/best.h: the best of all points judged, for methods that do not improve at every step. */
#ifndef NSD_BEST_H
#define NSD_BEST_H

#include <stdint.h>

struct best {
    double value; /* of the point kept, smaller is better; INFINITY: none is kept */
    int64_t size; /* numbers of a point */
    double *x;    /* [size] the point kept */
    int place;    /* of it on a device [solve/device.h] */
};

/* Allocates room for a point. Returns 0, or -1 when memory is short: then nothing is ever kept. */
int best_init(struct best *b, int64_t size);
void best_free(struct best *b);

/* Where to write a point of this value, if it is better than the one kept; else NULL */
double *best_offer(struct best *b, double value);
/* Forgets the point kept; the next one offered with a finite value is kept. */
void best_forget(struct best *b);

#endif
