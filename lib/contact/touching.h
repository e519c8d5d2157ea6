/*
 * contact/touching.h: pairs that touch where a step begins. Contacts are sought half a step ahead, where a pair that
 * recedes or spins is apart: its bond or liquid bridge is made here, before. Not of pairs that touch there, too, which
 * the laws find themselves [contact/contact_law.h].
 */
#pragma once

#include "state/packing.h"

/* Adds to p->bonds those of such pairs, in the step that bonds are made in by their time, and in the first one of all.
   Bodies are where the step begins, in the cell. Returns 0 or EX_SOFTWARE. */
int touching_bond(struct packing *p, struct failure *failure);
