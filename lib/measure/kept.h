/* measure/kept.h: what is remembered of a frame, for measures of what happens between frames. */
#ifndef NSD_KEPT_H
#define NSD_KEPT_H

#include "measure/deformed.h"

struct frame_memory {
    int64_t step;
    double t;             /* s */
    struct deformed form; /* since the first frame that was kept here */
    int64_t n;
    struct frame_memory_body {
        int32_t id;
        double mass; /* kg */
        vec3 x;      /* m: unwrapped, where the cell repeats: the way since it was built */
        double
            entered; /* s: when it came into the region [measure/follow.h]; NaN: it is not there */
        bool whole;  /* it was seen to come, else it was there in the first frame */
        bool chosen; /* measures keep to it [measure/follow.h] */
    } * body;        /* [n] sorted by id */
    int64_t pairs;
    struct frame_memory_pair {
        int32_t a, b;      /* ids, a < b; of boundary w a = -1-w */
        double began;      /* s */
        bool whole;        /* as above */
    } * pair;              /* [pairs] that touch, sorted; NULL: not looked at */
    struct wall_sums sums; /* over steps, of boundaries */
};

/* k = the packing now, in place of what was kept; all zero to begin with. Returns 0 or EX_SOFTWARE. */
int frame_memory_set(struct frame_memory *k, const struct packing *p, struct failure *failure);
void frame_memory_free(struct frame_memory *k);
/* The body with this id; NULL: it was not there. */
const struct frame_memory_body *frame_memory_find(const struct frame_memory *k, int32_t id);
/* For qsort: of kept pairs; and the pair of the same bodies, NULL: it did not touch, or k is NULL. */
int frame_memory_pair_order(const void *a, const void *b);
const struct frame_memory_pair *frame_memory_pair_find(const struct frame_memory *k, const struct frame_memory_pair *pair);

/* m: where body i is, with the edges added that were taken off it */
vec3 frame_memory_place(const struct packing *p, int64_t i);
/* m: from the kept place to the present one, the shortest among images where the cell repeats */
vec3 frame_memory_way(const struct packing *p, vec3 from, vec3 to);

#endif
