/*
 * state/memory.h: the reactions of the last step, from which the next solve starts. They belong to the packing
 * and travel with its frames, so that a run that is resumed, and nsd-detect | nsd-solve | nsd-move, start from what
 * the uninterrupted run does.
 *
 * A reaction is remembered in full only where the contact had it before: an impulse is not to be
 * repeated in the step after the impact. What is kept of it is at most twice what was kept before, or
 * an eighth of it, so that a load that lasts is known after four steps.
 */
#pragma once

#include "state/contact.h"

struct recall {
    int32_t a, b, feature; /* the key, as in struct contact */
    int8_t shift[3];
    vec3 r; /* N s: on b, in space, as all that follows */
    vec3 m; /* N m s; 0 without rolling friction */
};

static inline struct contact_key recall_key(const struct recall *x)
{
    return (
        struct contact_key){ x->a, x->b, x->feature, { x->shift[0], x->shift[1], x->shift[2] } };
}

/* Sorted as contacts are, each key once. */
struct memory {
    bool on; /* solves start from it; else it is empty */
    int64_t n, room;
    struct recall *recall; /* [n] */
};

void memory_free(struct memory *m);
/* Whether solves are to start from it; where not, what there is is forgotten. */
void memory_set(struct memory *m, bool on);
/* Remembers the reactions of solved contacts, in place of the older ones; nothing where it is not on. Returns 0
   or EX_SOFTWARE. */
int memory_keep(struct memory *m, const struct contacts *s, struct failure *failure);
/* s->found (and moment, where any is wanted) = what is remembered, in the bases of the contacts, and 0 for new
   ones. Returns 0 or EX_SOFTWARE. */
int memory_give(const struct memory *m, struct contacts *s, bool moments, struct failure *failure);
/* Impulses of steps that were `factor` times as long: forces go on where dt changes. */
void memory_scale(struct memory *m, double factor);
/* Back into order, after keys have changed */
void memory_sort(struct memory *m);
/* Bodies have new rows, in the same order; row[] < 0: gone */
void memory_follow(struct memory *m, const int32_t *row);
/* Do bodies and walls exist, are keys in order and numbers finite? Returns 0 or EX_DATAERR. */
int memory_check(const struct memory *m, int64_t bodies, int32_t walls, struct failure *failure);
