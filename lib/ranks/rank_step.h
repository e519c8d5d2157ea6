/*
 * ranks/rank_step.h: one time step of all ranks. Each finds the contacts of its own bodies; they are solved by
 * all, in the order of all (ranks/colours.h) or each rank's own (ranks/blocks.h). The first rank has the
 * whole packing: it says what order that is, what laws make of the contacts, sums the balances and moves the
 * bodies.
 *
 * What only a process that has all contacts can solve the first one solves alone: loads, whose contacts all
 * depend on each other by a W of their own; other solvers than auto, nlgs and anderson; and where auto goes on
 * with Newton's method.
 *
 * In blocks, where bodies neither come nor go and pairs have no law beyond friction and restitution, each rank moves
 * its own and sums its balances, and nobody has the whole.
 */
#ifndef NSD_RANK_STEP_H
#define NSD_RANK_STEP_H

#include "detect/neighbours.h"
#include "ranks/rows.h"
#include "solve/step.h"

struct rank_step {
    struct part part;
    struct neighbours near;
    bool varies;          /* bodies come and go, at the first */
    bool scattered;       /* nobody has the whole packing */
    double mean_mass;     /* kg: then */
    bool contacts;        /* the first rank wants those of steps that are kept */
    int64_t steps, since; /* steps made; since the last cut */
    int64_t alone;        /* steps whose contacts the first rank has solved alone */
    /* Contacts of the rank that has most over the mean: the most of all steps, and the sum over them */
    double worst, uneven;
    double fresh,
        lost; /* the same right after the last cut, and what it was more since then, added up */
    int64_t sweeps; /* of the shared solves */
    /* s of this processor's time in these, and in all steps, without waiting for others */
    double busy[2];
    int64_t solved[2]; /* bytes and messages of the shared solves, sent by this rank */
};

/* Collective. The first rank's packing; in others it is not looked at. space is taken over. rows: those of all
   ranks, where the packing has everything but bodies, and nobody has the whole; NULL: the first rank has it. */
void rank_step_begin(struct rank_step *y, struct comm *t, struct territory *space,
                     const struct packing *whole, struct rows *rows);
/* Can the steps be made so that nobody has the whole? settings: a packing, its bodies are not looked at */
bool rank_step_scatters(const struct packing *settings, const struct step_opt *o);
/* After the first rank's packing has got other bodies */
void rank_step_begin_again(struct rank_step *y, const struct packing *whole);
/* As step_advance(): whole, s, rep are those of the first rank. Returns 0, or a status at the first, which
   then has to end the run: the others wait. */
int rank_step_make(struct rank_step *y, struct packing *whole, struct contacts *s,
                   const struct step_opt *o, struct report *rep, struct why *why);
void rank_step_free(struct rank_step *y);

#endif
