/*
 * mpi/blocks.h: the contacts of all ranks, each rank sweeping its own by itself, and an exchange a sweep: the
 * order `block` [Shojaaee et al. 2012; waLBerla's pe]. Other bits for another number of ranks, the same
 * solution to the criterion.
 *
 * A contact is solved by the owner of its second body, with a copy of the first one where that is another's.
 * After a sweep the changes of copies are sent to the owners, which add them up in the order of ranks, and
 * send back what the bodies then move with: v = v_free + M^-1 P r holds for all.
 *
 * A body that k ranks push at once would be pushed too far: its contacts are solved by steps that are k times
 * shorter [solve/mass_splitting.h].
 */
#pragma once

#include "mpi/halo.h"
#include "mpi/subdomain.h"
#include "solve/exchange.h"
#include "solve/problem.h"
#include "step/balance.h"
#include "step/project.h"

struct blocks {
    struct exchange exchange; /* first: what solvers are given leads back here */
    struct subdomain *part;
    struct border *touched; /* [ranks] copies here of bodies of rank q that contacts here push */
    struct border *pushed;  /* [ranks] own bodies that contacts of rank q push */
    /* [ranks][touched[q].n][6] m/s, rad/s: their velocities after the last exchange */
    double **since;
    double *slower; /* [contacts] how many ranks push one of their bodies at once */
    struct schedule plan;
};

/* s: the contacts that this rank counts, and no others. */
void blocks_begin(struct blocks *b, struct subdomain *y, const struct contacts *s,
                  enum order order);
/* After the solve. The sums of the contacts' reactions on bodies at borders become those of all ranks, added by
   the owners. */
void blocks_add_impulses(struct blocks *b, struct impulses *sum);
/* The balances of the step: of each rank's own bodies and contacts, added up in the order of ranks */
void blocks_balance(struct blocks *b, const struct contacts *s, const struct impulses *sum,
                    struct balance *told);
/* After the motion: copies become what the bodies are, and bodies that overlap are moved apart, where the packing
   needs it; did, or NULL: what that has done, in all ranks */
void blocks_move_apart(struct blocks *b, const struct contacts *s, struct projected *did);
void blocks_free(struct blocks *b);
