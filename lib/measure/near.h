/* measure/near.h: points sorted into cells, so that those near a point are found at once. */
#ifndef NSD_NEAR_H
#define NSD_NEAR_H

#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

struct near_point {
    vec3 x;
    int32_t cell[3];
    int64_t of; /* its place in the x that were sorted */
};

/* Cells are hashed: a point far away costs nothing. */
struct near {
    double reach; /* m: the width of a cell */
    int64_t n, buckets;
    struct near_point *point; /* [n] by buckets */
    int64_t *first;           /* [buckets + 1] */
};

/* Sorts x[n] (m); reach > 0. False when memory is short. */
bool near_init(struct near *g, const vec3 *x, int64_t n, double reach);
void near_free(struct near *g);
/*
 * Adds to count[bins] the points at distances from x of 0 < d < reach, by bins of the same width; of
 * the same place none. Returns how many it has looked at.
 */
int64_t near_count(const struct near *g, vec3 x, int64_t *count, int64_t bins);

enum { NEAREST_MOST = 16 };
/*
 * The points nearest to x at 0 < d < reach, the nearest first, of two as near the first in x[]: of[found], their
 * places there; found <= most <= NEAREST_MOST. Adds to *looked how many it has looked at.
 */
int near_nearest(const struct near *g, vec3 x, int most, int64_t *of, int64_t *looked);

#endif
