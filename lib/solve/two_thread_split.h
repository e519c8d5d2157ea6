/*
 * solve/two_thread_split.h: a packing's contacts in two halves that two threads sweep side by
 * side. It serves piles whose colours are too small to be shared, and large ones, where each thread
 * then keeps bodies of its own in its cache.
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
#ifndef NSD_TWO_THREAD_SPLIT_H
#define NSD_TWO_THREAD_SPLIT_H

#include "state/packing.h"

#include <stdalign.h>
#include <stdatomic.h>

enum zone { ZONE_BORDER, ZONE_BEYOND, ZONE_INSIDE, ZONE_RIM, ZONE_COUNT };

/* zone[n] = the enum zone of each contact, by its movable bodies: body[n][2], the second -1 where there is one
   only, both where there is none. Returns 0, or -1 when memory is short. */
int two_thread_split_divide(int64_t n, int32_t (*body)[2], const struct packing *p, int8_t *zone);

/* Where each zone begins, and how far the two threads have come */
struct two_thread_split {
    int64_t beyond, inside, rim, rest;   /* first groups; rest: inside's second part */
    alignas(64) _Atomic int64_t borders; /* how often the border has been swept */
    alignas(64) _Atomic int64_t rims;    /* how often the rim has */
};

#endif
