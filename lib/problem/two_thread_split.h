/*
 * problem/two_thread_split.h: a packing's contacts in two halves that two threads sweep side by side: for piles whose
 * colours are too small to be shared, and so that of large ones each has bodies of its own at hand.
 *
 * A plane cuts the bodies in two. The contacts between the halves are the border, which belongs to
 * one thread together with the contacts beyond; the other has those that share a body with the
 * border, the rim, and those inside. In a sweep the rim comes after the border and before the next
 * sweep's border, and each thread has other work while it waits for that:
 *
 *     one       border      beyond
 *     the other inside, 1st half    rim    inside, 2nd half
 *
 * No other two contacts of both threads share a movable body: the bits are those of one thread that
 * sweeps border, beyond, inside, rim, inside.
 */
#ifndef NSD_TWO_THREAD_SPLIT_H
#define NSD_TWO_THREAD_SPLIT_H

#include "bodies/contact.h"
#include "bodies/packing.h"

#include <stdalign.h>
#include <stdatomic.h>

enum zone { ZONE_BORDER, ZONE_BEYOND, ZONE_INSIDE, ZONE_RIM, ZONE_COUNT };

/* zone[n] of each contact. Returns 0, or -1 when memory is short. */
int two_thread_split_divide(const struct contacts *, const struct packing *, int8_t *zone);

/* Where the two threads of a sweep are */
struct two_thread_split {
    int64_t beyond, inside, rim, rest;   /* the first groups of each; rest: inside's second half */
    alignas(64) _Atomic int64_t borders; /* that have been swept, */
    alignas(64) _Atomic int64_t rims;    /* and rims */
};

/* Until `done`, which the other thread counts up, is at least n. */
void two_thread_split_wait(const _Atomic int64_t *done, int64_t n);

#endif
