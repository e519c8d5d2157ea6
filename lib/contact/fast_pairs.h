/*
 * contact/fast_pairs.h: bodies that move in a step by more than they are thick [contact/tunnelling.h], and the bodies that are near
 * their paths. In a periodic cell images one edge away count.
 *
 * Several processes have a part of the bodies each, and all of them the list of all fast bodies: each looks at the
 * pairs of its own bodies with those of the list.
 */
#pragma once

#include "contact/tunnelling.h"
#include "state/packing.h"

/* A body, as a path is examined */
struct fast {
    int32_t id, material;
    int32_t shape; /* row of the packing's shapes */
    bool fast;
    double radius, thick;
    double mass;
    vec3 x, v; /* m, m/s */
    quat q;
};

struct fast_list {
    int64_t n;
    struct fast *of; /* [n] to be freed */
};

/* Those of the packing for which of[p->n] is true; NULL: all. Returns 0 or EX_SOFTWARE. */
int fast_find(struct fast_list *list, const struct packing *p, const bool *of,
              struct failure *failure);

/* m: where the window begins */
static inline vec3 fast_from(struct window window, const struct fast *b)
{
    return v3_axpy(b->x, -window.back, b->v);
}
/* The hull of a body; NULL: it has another shape */
const struct shape *fast_hull(const struct packing *p, const struct fast *b);
/* What is on its path where contacts are sought, or beyond, contact/tunnelling.h finds. */
bool fast_is_fixed_hull(const struct packing *p, const struct fast *b);

/* b: one of the packing's bodies; a: one of the list, or its image */
typedef void fast_visit(void *arg, const struct fast *a, const struct fast *b);
/* Visits each pair of a fast body and one of the packing, as above, whose paths in the window may meet, once: of two
   fast bodies b is the one with the lower number. Pairs that cannot move, or do not act on each other, are left out. Returns 0 or EX_SOFTWARE. */
int fast_pairs(const struct packing *p, const bool *of, const struct fast_list *list,
               struct window window, fast_visit *visit, void *arg, struct failure *failure);
