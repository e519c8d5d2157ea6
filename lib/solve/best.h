/* solve/best.h: the best of all points that were judged, for a way that is not straight. */
#ifndef NSD_BEST_H
#define NSD_BEST_H

#include <stdint.h>

struct best {
    double value; /* what it was judged by, the less the better; INFINITY: nothing is kept */
    int64_t size;
    double *x; /* [size] */
};

/* Room for points of this size. Returns 0, or -1 when memory is short: then nothing is ever kept. */
int best_init(struct best *b, int64_t size);
void best_free(struct best *b);

/* Where a point of this value is to be written, if it is better than what is kept; else NULL */
double *best_offer(struct best *b, double value);
/* What is kept is wanted no more. */
void best_forget(struct best *b);

#endif
