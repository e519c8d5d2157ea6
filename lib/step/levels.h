/*
 * step/levels.h: contacts sorted into levels, so that threads can visit them in the order of one thread.
 *
 * The level of a contact is one above the highest level of the earlier contacts of its bodies. Contacts of one
 * level have no body in common. Visiting level after level changes every body by the same contacts in the same
 * order as visiting contact after contact, so results have the same bits.
 */
#ifndef NSD_LEVELS_H
#define NSD_LEVELS_H

#include "state/contact.h"

struct levels {
    int64_t n;        /* levels; 0: not made */
    int64_t *first;   /* [n + 1] level k has contact[first[k]] .. contact[first[k + 1] - 1] */
    int32_t *contact; /* [contacts] rows of the contacts, by level and in their order there */
};

/* The levels of s, whose rows are of `bodies` bodies; walls do not count. Returns 0, or -1 when memory is short.
   levels_free() is due in any case. */
int levels_init(struct levels *l, const struct contacts *s, int64_t bodies);
void levels_free(struct levels *l);

#endif
