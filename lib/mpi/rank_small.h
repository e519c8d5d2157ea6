/*
 * mpi/rank_small.h: small steps of all ranks [step/small_part.h]. Each has a copy of the first rank's packing, which it gets when a
 * small step is the first one, or follows something else that has changed the packing, and which it keeps up to date by itself.
 */
#pragma once

#include "mpi/comm.h"
#include "step/small_part.h"
#include "step/step.h"

enum { RANK_SMALL_FLIES = 64 }; /* messages on their way at the same time */

struct rank_small {
    struct small_ranks ranks; /* first: what small steps are given leads back here */
    struct small_part part;
    struct comm *comm;
    struct packing p; /* of other ranks than the first */
    struct contacts s;
    struct report report;
    struct step_memory memory;
    bool same; /* the first: others have its packing */
    struct {
        MPI_Request request;
        char *bytes;
        size_t room;
    } flies[RANK_SMALL_FLIES];
    int next;
    /* Of all: small steps; bytes and messages of this rank; s of processor time without waiting */
    int64_t steps, bytes, messages;
    double busy;
};

void rank_small_begin(struct rank_small *y, struct comm *t);
void rank_small_free(struct rank_small *y);
/* What a step is made of */
struct rank_small_step {
    struct packing *p;
    struct contacts *s;
    struct step_memory *memory;
    struct report *report;
};
/* Collective. As step_in_small(), of the first rank's step; in others it is not looked at. */
int rank_small_make(struct rank_small *y, const struct rank_small_step *first,
                    const struct step_opt *o, bool *made, int64_t *parts, struct failure *failure);
