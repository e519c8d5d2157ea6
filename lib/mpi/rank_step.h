/*
 * mpi/rank_step.h: one time step of all ranks, step/step.h's with other hooks. Each rank finds the contacts of its
 * own bodies. All ranks solve them together, either in the order of one process (mpi/colours.h) or each rank in an
 * order of its own (mpi/blocks.h).
 *
 * The first rank has the whole packing. It chooses the order, applies the laws of pairs, sums the balances and moves
 * the bodies. It also solves alone what needs all contacts in one process:
 *   - load-controlled walls, whose contacts all depend on each other by a W of their own;
 *   - solvers other than auto, nlgs and anderson;
 *   - Newton's method, where auto continues with it.
 *
 * With the order `block`, no rank has the whole packing, and each moves its own bodies and sums its own balances. That
 * needs a packing without inlets, outlets and laws of pairs beyond friction and restitution.
 */
#pragma once

#include "contact/neighbours.h"
#include "mpi/rows.h"
#include "step/step.h"

struct rank_step {
    struct subdomain part;
    struct neighbours near;
    bool varies;      /* the packing has inlets or outlets; known to all ranks */
    bool scattered;   /* no rank has the whole packing */
    double mean_mass; /* kg: of its bodies, where it is scattered */
    bool contacts;    /* the first rank writes the contacts of the frames that it keeps */
    bool may_end;     /* with a step that fails its account the run ends */
    int64_t parts;    /* of the step to come, as of step_in_small(). The first rank's */
    int64_t steps;    /* steps made */
    int64_t since;    /* the step of the last cut */
    int64_t alone;    /* steps whose contacts the first rank has solved alone */
    /* The imbalance of a step is the contacts of the rank that has most, over the mean. */
    double worst;   /* the largest of all steps */
    double uneven;  /* the sum over all steps */
    double fresh;   /* of the first step after the last cut */
    double lost;    /* how much larger than that it was since, summed over the steps */
    int64_t sweeps; /* of the solves by all ranks */
    double busy
        [2]; /* s of processor time, without waiting: of the solves by all ranks, of all steps */
    int64_t solved[2]; /* bytes and messages that this rank has sent in solves by all ranks */
};

/* Collective. The first rank's packing; in others it is not looked at. space is taken over. rows: those of all
   ranks, where the packing has everything but bodies, and nobody has the whole; NULL: the first rank has it. */
void rank_step_begin(struct rank_step *y, struct comm *t, struct decomposition *space,
                     const struct packing *whole, struct rows *rows);
/* Can the steps be made so that nobody has the whole? settings: a packing, its bodies are not looked at */
bool rank_step_scatters(const struct packing *settings, const struct step_opt *o);
/* After the first rank's packing has got other bodies */
void rank_step_begin_again(struct rank_step *y, const struct packing *whole);
/* After a program has changed the first rank's packing, or put forces on it, for the step to come */
void rank_step_act(struct rank_step *y, const struct packing *whole);
/* As step_advance(): whole, s, rep are those of the first rank. Returns 0, or a status at the first, which
   then has to end the run: the others wait. */
int rank_step_make(struct rank_step *y, struct packing *whole, struct contacts *s,
                   const struct step_opt *o, struct report *rep, struct failure *failure);
void rank_step_free(struct rank_step *y);
