/*
 * detect/crossing.h: pairs of bodies that both may move and go through one another in a step, without a contact
 * where contacts are sought.
 *
 * A body is fast if it goes farther in a step than it is thick [detect/swift.h]. Two bodies cross if their relative
 * way in the window, from the place where contacts were sought to where they will be sought next, is longer than both
 * are thick, begins and ends apart, and between meets the other: a ball its surface, a hull the way of the other's
 * centre. A capsule or a clump counts as the ball inside it. In a periodic cell images one edge away count, so a way
 * longer than an edge is not seen whole.
 *
 * They are counted, and get no contact: where contacts are sought no line joins the centres and the place at which
 * they would meet, so a reaction there would change the angular momentum.
 */
#ifndef NSD_CROSSING_H
#define NSD_CROSSING_H

#include "bodies/packing.h"
#include "detect/swift.h"

/* A fast body */
struct fast {
    int32_t id, shape; /* row of the packing's shapes */
    double radius, thick;
    double mass;
    vec3 x, v; /* m, m/s */
    quat q;
    double lo,
        hi; /* m: along x, of all that its way covers; hi of none before it is greater than `most` */
    double most;
};

struct fast_list {
    int64_t n;
    struct fast *of; /* [n] to be freed */
};

/* Those of the packing's first n bodies. Returns 0 or EX_SOFTWARE. */
int crossing_list(struct fast_list *list, const struct packing *p, int64_t n, struct why *why);
/* Adds to `s` the crossings of the packing's first n bodies with those of the list, which has all fast bodies of
   all ranks, in any order. A pair is one of the body with the lower number where both are fast, else of the other
   one. Returns 0 or EX_SOFTWARE. */
int crossing_count(struct passed *s, const struct packing *p, int64_t n,
                   const struct fast_list *list, struct window window, struct why *why);

#endif
