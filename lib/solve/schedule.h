/*
 * solve/schedule.h: the order of the sweep, and which of its contacts may be solved at once.
 *
 * A sequence is cut into groups of contacts that do not depend on each other: no movable body in
 * common, no block of W between them. Within a group any order, and any number of threads, gives
 * the same bits.
 *
 * natural, reverse, random: the given sequence, regrouped by levels: a contact goes one level after
 * the last one before it that it depends on. The result is the sequence's own, bit for bit. colour:
 * contacts coloured greedily in their natural order; another sequence, in fewer groups. From 8192
 * contacts of a packing on, colour goes by halves: the zones below one after another, each coloured by
 * itself. block: colours, and where several processes share the contacts each sweeps its own by itself
 * [mpi/blocks.h]; as colour in one.
 */
#pragma once

#include "solve/delassus.h"
#include "state/contact.h"
#include "state/packing.h"

#include <stdalign.h>
#include <stdatomic.h>

/*
 * A packing's contacts in two halves that two threads sweep side by side, so that each thread keeps
 * bodies of its own in its cache.
 *
 * A plane cuts the bodies in two. The contacts across it are the border zone, which belongs to one
 * thread together with the contacts beyond; the other thread has the rim, the contacts that share a
 * body with the border, and those inside. In a sweep the rim comes after the border and before the
 * next sweep's border; each thread has other zones to sweep in the meantime:
 *
 *     one thread  border              beyond
 *     the other   inside, 1st part    rim    inside, 2nd part
 *
 * Contacts of the two threads share a movable body only if one is in the border and the other in
 * the rim. So the bits are those of one thread that sweeps border, beyond, inside, rim, inside.
 */

enum zone { ZONE_BORDER, ZONE_BEYOND, ZONE_INSIDE, ZONE_RIM, ZONE_COUNT };

/* Where each zone begins, and how far the two threads have come */
struct two_thread_split {
    int64_t beyond, inside, rim, rest;   /* first groups; rest: inside's second part */
    alignas(64) _Atomic int64_t borders; /* how often the border has been swept */
    alignas(64) _Atomic int64_t rims;    /* how often the rim has */
};

enum order { ORDER_NATURAL, ORDER_REVERSE, ORDER_RANDOM, ORDER_COLOUR, ORDER_BLOCK, ORDER_COUNT };
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
