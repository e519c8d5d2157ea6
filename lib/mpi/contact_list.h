/*
 * mpi/contact_list.h: the contacts of all ranks in one list at the first, in the order in which one process would
 * have found them; and what the first says of each, on its way back to all who have it.
 */
#ifndef NSD_CONTACT_LIST_H
#define NSD_CONTACT_LIST_H

#include "mpi/subdomain.h"

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

#endif
