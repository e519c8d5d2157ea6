/*
 * solve/coupling.h: what the freedoms of a step [state/freedom.h] are to its contacts.
 *
 *     u_c = ... + J_c s
 *
 * s: the freedoms' speeds. All contacts of one freedom depend on each other, so the sweep over
 * bodies does not do for them: there the speeds are prescribed, those before the step, and
 * solve/assembly.h makes a W of it in which they are unknowns.
 */
#pragma once

#include "state/freedom.h"

enum { COUPLINGS_MAX = 10 }; /* of a contact: a wall's, and nine components of the cell's edges */

struct coupling {
    int32_t freedom, contact;
    double J[3]; /* (n, t1, t2): the velocity at the contact per unit speed */
};

struct couplings {
    struct freedoms freedoms;
    int64_t n;           /* pairs of a freedom and a contact that it moves */
    int64_t *first;      /* [contacts + 1] those of contact c: first[c] .. first[c+1]-1 */
    struct coupling *of; /* [n] */
};

/* Returns 0, or EX_SOFTWARE with nothing to free. */
int couplings_init(struct couplings *c, const struct packing *p, const struct contacts *s,
                   struct failure *failure);
void couplings_free(struct couplings *c);

/* How many pairs of contacts share a wall's freedom, each contact with itself too; a pair counts for each
   freedom that it shares. */
double couplings_pairs(const struct couplings *c);
