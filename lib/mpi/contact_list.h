/*
 * mpi/contact_list.h: the contacts of all ranks in one list at the first, in the order in which one process would
 * have found them; and what the first says of each, on its way back to all who have it.
 */
#pragma once

#include "mpi/comm.h"
#include "mpi/subdomain.h"
#include "solve/exchange.h"
#include "solve/problem.h"

struct contact_list {
    int64_t n;      /* contacts of all */
    int32_t *whose; /* [n] the rank that counts it; only at the first */
};

/* What the first says of a contact */
struct verdict {
    int64_t slot;  /* in the order of all */
    int64_t group; /* of that order */
    int32_t keep;  /* 0: it is none */
    int32_t row;   /* of b, that ranks may see whether they speak of the same */
};

/* all = the contacts that the ranks count, bodies by their rows in the whole; only at the first.
   Collective, as all that follows. */
void contact_list_gather(struct contact_list *l, const struct subdomain *y,
                         const struct contacts *s, struct contacts *all);
void contact_list_free(struct contact_list *l);
/* verdict[s->n] = what the first has for each of all[l->n], in all ranks that have the contact. */
void contact_list_tell(const struct contact_list *l, const struct subdomain *y,
                       const struct contacts *s, const struct verdict *all, struct verdict *mine);
/* The same of laws, reactions to start from and ties: into the contacts */
void contact_list_tell_laws(const struct contact_list *l, const struct subdomain *y,
                            struct contacts *s, const struct contacts *all);
/* all->found (and moment) = what the ranks have found. */
void contact_list_found(const struct contact_list *l, const struct subdomain *y,
                        const struct contacts *s, struct contacts *all);

/*
 * Sums over the contacts of all ranks. In the order of all slots: each chunk of bundles is
 * added up by one rank, which has most of it, and the chunks by the first, as one process adds them.
 */

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
