/*
 * problem/schedule.h: the order of the sweep, and which of its contacts may be done at once.
 *
 * A sequence is cut into groups of contacts that have nothing to do with each other: no movable body
 * in common, no block of W between them. Within a group any order, and any number of threads, gives
 * the same bits.
 *
 * natural, reverse, random: the given sequence, regrouped by levels: a contact goes one level after
 * the last one before it that it depends on. That is the sequence's own result, bit for bit.
 * colour: contacts coloured greedily in their natural order; another sequence, in fewer groups.
 * halves: the parts of two halves one after another [problem/two_thread_split.h], each coloured. So is colour of 8192
 * contacts and more, and halves of fewer than 384, or given by W, is as colour.
 */
#ifndef NSD_SCHEDULE_H
#define NSD_SCHEDULE_H

#include "bodies/contact.h"
#include "bodies/packing.h"
#include "problem/delassus.h"
#include "problem/two_thread_split.h"

enum order { ORDER_NATURAL, ORDER_REVERSE, ORDER_RANDOM, ORDER_COLOUR, ORDER_HALVES, ORDER_COUNT };
extern const char *const order_name[ORDER_COUNT]; /* as command lines and documents have them */

struct schedule {
    int64_t *sequence; /* [n] contacts */
    int64_t groups;
    int64_t *group;                    /* [groups + 1] */
    int64_t beyond, inside, rim, rest; /* the first groups of the parts, by halves; else 0 */
};

/* Return 0, or -1 when memory is short. */
int schedule_bodies(struct schedule *, enum order, const struct contacts *, const struct packing *);
int schedule_blocks(struct schedule *, enum order, const struct delassus *);
void schedule_free(struct schedule *);

#endif
