/*
 * solve/schedule.h: the order of the sweep, and which of its contacts may be solved at once.
 *
 * A sequence is cut into groups of contacts that do not depend on each other: no movable body in
 * common, no block of W between them. Within a group any order, and any number of threads, gives
 * the same bits.
 *
 * natural, reverse, random: the given sequence, regrouped by levels: a contact goes one level after
 * the last one before it that it depends on. The result is the sequence's own, bit for bit. colour:
 * contacts coloured greedily in their natural order; another sequence, in fewer groups. halves: the
 * zones of solve/two_thread_split.h one after another, each coloured by itself. From 8192
 * contacts of a packing on, colour goes by halves too; halves is as colour for a problem given by W
 * or with fewer than 384 contacts. block: colours, and where several processes share the contacts each
 * sweeps its own by itself [mpi/blocks.h]; as colour in one.
 */
#ifndef NSD_SCHEDULE_H
#define NSD_SCHEDULE_H

#include "state/contact.h"
#include "state/packing.h"
#include "solve/delassus.h"
#include "solve/two_thread_split.h"

enum order {
    ORDER_NATURAL,
    ORDER_REVERSE,
    ORDER_RANDOM,
    ORDER_COLOUR,
    ORDER_HALVES,
    ORDER_BLOCK,
    ORDER_COUNT
};
extern const char *const order_name[ORDER_COUNT]; /* as command lines and documents have them */

struct schedule {
    int64_t *sequence; /* [n] contacts */
    int64_t groups;
    int64_t *group; /* [groups + 1] group g: sequence[group[g]] .. sequence[group[g+1]-1] */
    int64_t beyond, inside, rim, rest; /* by halves: as in struct two_thread_split; else 0 */
    /* What it follows from in addition to the order and the bodies of the contacts: where these are */
    uint32_t *key; /* [n] on the curve along which they are sorted; NULL: they are not */
    int8_t *zone;  /* [n] enum zone; NULL: no halves */
};

/* Of a packing's contacts; of a problem given by W. Return 0, or -1 when memory is short. */
int schedule_bodies(struct schedule *s, enum order order, const struct contacts *contacts,
                    const struct packing *packing);
int schedule_blocks(struct schedule *s, enum order order, const struct delassus *W);
void schedule_free(struct schedule *s);

/* Whether schedule_bodies() of contacts between the same bodies, of which the same move, in the same order
   would give s again. False also when memory is short. */
bool schedule_holds(const struct schedule *s, const struct contacts *contacts,
                    const struct packing *packing);

#endif
