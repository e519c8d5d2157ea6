/*
 * bodies/cell.h: the box that repeats. A point x is the same as x + k_0 edge[0] + k_1 edge[1] +
 * k_2 edge[2], with whole k along the edges that repeat and 0 along the others.
 *
 * Velocities are absolute: the image of a body across edge k moves at v + rate[k]. Simple shear
 * (Lees and Edwards 1972) and compression of the whole cell differ in the rate alone.
 */
#ifndef NSD_CELL_H
#define NSD_CELL_H

#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

struct cell {
    bool repeats[3];
    vec3 origin;  /* m: the corner from which the edges start */
    vec3 edge[3]; /* m, at the packing's time */
    vec3 rate[3]; /* m/s: d edge / dt */
};

static inline bool cell_repeats(const struct cell *c)
{
    return c->repeats[0] || c->repeats[1] || c->repeats[2];
}

/* m, or m/s: shift[0] e[0] + shift[1] e[1] + shift[2] e[2], of the edges or of their rates */
static inline vec3 cell_shift(const vec3 e[3], const int8_t shift[3])
{
    vec3 s = v3(0, 0, 0);
    for (int k = 0; k < 3; k++)
        if (shift[k]) s = v3_axpy(s, shift[k], e[k]);
    return s;
}

#endif
