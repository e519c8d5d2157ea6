/*
 * problem/laying.h: where contacts and bodies of a packing's problem lie in memory: contacts in the lanes of
 * bundles, bodies in seats, by colours in the order in which the sweep first meets them. lay.c lays them, for
 * problem.c.
 */
#ifndef NSD_LAYING_H
#define NSD_LAYING_H

#include "bodies/contact.h"
#include "problem/schedule.h"

struct problem;

/*
 * Zeroed memory of n things, aligned to cache lines, in huge pages where it is large: bodies read in any order
 * then do not wait for page tables. NULL only when memory is short, also for n = 0.
 */
void *lay_lines(int64_t n, size_t size);

/* Makes bundles of the plan's groups; each group begins a new one. False when memory is short. */
bool lay_bundles(struct problem *p, const struct schedule *plan);

/* The bodies of the slots, side by side: contacts are long, and lie in another order. */
struct laying {
    struct problem *p;
    const struct contacts *s;
    int32_t (*pair)[2]; /* [slots] a, b of the contact; of a lane without one b is -1 */
    int64_t *copies;    /* [bundles + 1] of bodies that do not move, in the bundles before */
};

/* After the bundles. False when memory is short; to be freed in any case. */
bool laying_init(struct laying *y, struct problem *p, const struct contacts *s);
void laying_free(struct laying *y);

/* seat[packing->n]: the place of each body in body[], in orders before colour as in the packing. NULL when
   memory is short; the caller frees it. */
int32_t *lay_seats(const struct laying *y, enum order order);

/* Tells the slots their bodies, and makes the copies of those that do not move, behind the packing's and
   `nobody` of each half. p->seat and the packing's in p->body are set. */
void lay_places(struct laying *y);

#endif
