/* shape/surface_tree.h: the tree of boxes over the elements of a surface [shape/mesh.h], and a walk
   to those near a place. */
#ifndef NSD_SURFACE_TREE_H
#define NSD_SURFACE_TREE_H

#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

enum {
    SURFACE_LEAF = 4, /* elements that are looked at one by one */
    SURFACE_FEATURES =
        7 /* of a triangle: edges 0 to 2 (from corner k), corners 3 to 5, its inside */
};

/* Of order[lo .. hi-1]; its halves are in the boxes that follow, the second from `next` on. */
struct surface_box {
    vec3 lo, hi;  /* m */
    int32_t next; /* the index of the second half's box */
};

/* A box of the tree, over order[lo .. hi-1] */
struct surface_branch {
    int32_t box, lo, hi;
};

struct surface_walk {
    struct surface_branch stack[64];
    int depth;
};

static inline double surface_beyond(double x, double lo, double hi)
{
    return x < lo ? lo - x : x > hi ? x - hi : 0;
}

static inline bool surface_is_near(const struct surface_box *b, vec3 c, double most)
{
    double x = surface_beyond(c.x, b->lo.x, b->hi.x), y = surface_beyond(c.y, b->lo.y, b->hi.y);
    double z = surface_beyond(c.z, b->lo.z, b->hi.z);
    return x * x + y * y + z * z <= most * most * (1 + 1e-12);
}

/* Of n elements; what is above the stack's depth is not set. */
static inline void surface_walk_begin(struct surface_walk *w, int32_t n)
{
    w->stack[0] = (struct surface_branch){ 0, 0, n }, w->depth = 1;
}

/* The next few elements, order[leaf->lo .. leaf->hi - 1], of which some are at most `most` (m) from c;
   false: no more. */
static inline bool surface_walk_next(struct surface_walk *w, const struct surface_box *box, vec3 c,
                                     double most, struct surface_branch *leaf)
{
    while (w->depth) {
        const struct surface_branch b = w->stack[--w->depth];
        if (!surface_is_near(&box[b.box], c, most)) continue;
        *leaf = b;
        if (b.hi - b.lo <= SURFACE_LEAF) return true;
        int32_t middle = b.lo + (b.hi - b.lo) / 2;
        w->stack[w->depth++] = (struct surface_branch){ box[b.box].next, middle, b.hi };
        w->stack[w->depth++] = (struct surface_branch){ b.box + 1, b.lo, middle };
    }
    return false;
}

#endif
