/* measure/kept.h: what is remembered of a frame, for measures of what happens between frames. */
#ifndef NSD_KEPT_H
#define NSD_KEPT_H

#include "measure/deformed.h"

struct kept {
    int64_t step;
    double t;             /* s */
    struct deformed form; /* since the first frame that was kept here */
    int64_t n;
    struct kept_body {
        int32_t id;
        double mass; /* kg */
        vec3 x;      /* m: unwrapped, where the cell repeats: the way since it was built */
        double
            entered; /* s: when it came into the region [measure/follow.h]; NaN: it is not there */
        bool whole;  /* it was seen to come, else it was there in the first frame */
        bool chosen; /* measures keep to it [measure/follow.h] */
    } * body;        /* [n] sorted by id */
    int64_t pairs;
    struct kept_pair {
        int32_t a, b;      /* ids, a < b; of boundary w a = -1-w */
        double began;      /* s */
        bool whole;        /* as above */
    } * pair;              /* [pairs] that touch, sorted; NULL: not looked at */
    struct wall_sums sums; /* over steps, of boundaries */
};

/* k = the packing now, in place of what was kept; all zero to begin with. Returns 0 or EX_SOFTWARE. */
int kept_set(struct kept *k, const struct packing *p, struct why *why);
void kept_free(struct kept *k);
/* The body with this id; NULL: it was not there. */
const struct kept_body *kept_find(const struct kept *k, int32_t id);
/* For qsort: of kept pairs; and the pair of the same bodies, NULL: it did not touch, or k is NULL. */
int kept_pair_order(const void *a, const void *b);
const struct kept_pair *kept_pair_find(const struct kept *k, const struct kept_pair *pair);

/* m: where body i is, with the edges added that were taken off it */
vec3 kept_place(const struct packing *p, int64_t i);
/* m: from the kept place to the present one, the shortest among images where the cell repeats */
vec3 kept_way(const struct packing *p, vec3 from, vec3 to);

#endif
