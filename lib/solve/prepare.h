/*
 * solve/prepare.h: the contact problem of a packing, whichever form it needs.
 *
 * Where loads push boundaries or the cell, and contacts touch these, the problem is given by the W
 * in which the freedoms' speeds are unknowns too [solve/assembly.h]:
 *
 *     D u~ = W r + q,   W = H^T M^-1 H with a row of H for each freedom.
 *
 * All k contacts of a freedom depend on each other: W has k^2 blocks, and the sweep solves them
 * one after the other. u in the slots is then D u~, (1 + e) times what the contacts are told, and
 * the errors are those of D u~; e = 0 makes no difference. Any other packing has the form of its
 * bodies.
 */
#ifndef NSD_PREPARE_H
#define NSD_PREPARE_H

#include "solve/problem.h"

/* As problem_prepare(). Where it is not sweeps that solve, W has the bonds [solve/extra.h] in it
   [solve/bonded.h]: the slots' r are then r*. EX_SOFTWARE also where W is larger than the memory of
   the machine. */
int prepare_packing(struct problem *p, const struct packing *pack, const struct contacts *s,
                    bool sweeps, const struct prepare_opt *o, struct failure *failure);

#endif
