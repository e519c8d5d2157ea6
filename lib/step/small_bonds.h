/*
 * step/small_bonds.h: what lasts of pairs in small steps, liquid bridges and springs [step/small_springs.h], and the energy that
 * attraction stores.
 */
#pragma once

#include "step/small_run.h"

struct small_bonds {
    double stored; /* J */
    double joined; /* J: minus what liquid that has joined in the interval has given up */
};

/* The list, just made, gets the bridges of the packing and, if warm, what persists of the pulls that its gaps have */
void small_bonds_recall(struct small_run *r, bool warm);
/* Where the bodies are, at the beginning and the end of the interval */
struct small_bonds small_bonds_account(struct small_run *r);
/* p->bonds: the bridges and the springs of the list. Returns 0 or EX_SOFTWARE. */
int small_bonds_keep(struct small_run *r, struct failure *failure);
/* s->law of contacts at the end of the interval, whose bonds the packing has kept. Returns 0 or EX_SOFTWARE. */
int small_bonds_laws(struct contacts *s, const struct packing *p, struct failure *failure);
