/*
 * mpi/tally.h: sums over the contacts of all ranks. In the order of all slots: each chunk of bundles is
 * added up by one rank, which has most of it, and the chunks by the first, as one process adds them.
 */
#ifndef NSD_TALLY_H
#define NSD_TALLY_H

#include "solve/exchange.h"
#include "solve/problem.h"
#include "mpi/comm.h"

struct tally_order {
    int64_t n;
    /* [n] slots here that are counted, by the rank that adds them up, then along the order of all */
    int64_t *mine;
    int *out, *in; /* [ranks] how many go there and come from there */
    int64_t got;
    int64_t *at,
        *where; /* [got] along the order of all: where they stand in what comes; their slots */
};

/* slot[contacts of this rank]: in the order of all and its `bundles`; -1: another counts it.
   Collective, as all that follows. */
void tally_begin(struct tally_order *o, struct comm *t, const struct problem *p,
                 const int64_t *slot, int64_t bundles);
void tally_free(struct tally_order *o);
/* As in struct exchange */
void tally_sum(const struct tally_order *o, struct comm *t, int64_t bundles,
               const struct summands *of, double *out);
double tally_along(const struct tally_order *o, struct comm *t, int64_t bundles,
                   const double *term);

#endif
