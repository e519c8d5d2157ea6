/*
 * solve/prepare.h: the contact problem of a packing, whichever form it needs.
 *
 * Where loads push walls or the cell, and contacts touch these, the problem is given by the W
 * in which the freedoms' speeds are unknowns too [solve/assembly.h]:
 *
 *     D u~ = W r + q,   W = H^T M^-1 H with a row of H for each freedom.
 *
 * All k contacts of a freedom depend on each other: W has k^2 blocks, and the sweep solves them
 * one after the other. u in the slots is then D u~, (1 + e) times what the contacts are told, and
 * the errors are those of D u~; e = 0 makes no difference. Any other packing has the form of its
 * bodies.
 */
#pragma once

#include "solve/assembly.h"
#include "solve/condense.h"
#include "solve/problem.h"

/*
 * The Delassus operator of contacts that are bonded, for solvers that want a W.
 *
 * The bonds' p = - a - K u~ of all contacts, u~ = H^T v + w, in the motion M v = f + H (r* + p):
 *
 *     (M + H K H^T) v = f - H (a + K w) + H r*
 *
 * which solve/condense.h brings to u~ = W^ r* + q^. W^ couples all contacts of bodies that hang
 * together by bonds: it has the square of their number of blocks.
 */

/* W^ and q^[n d] of an assembly whose problem has bonds; W is to be freed in any case. Returns 0, EX_DATAERR
   or EX_SOFTWARE, also where the machine has no memory for W^. */
int bonded_local(const struct assembly *A, struct sparse *W, double *q, struct failure *failure);

/* M + H K H^T, H and f - H (a + K w) of an assembly whose problem has bonds; P is to be freed in any
   case. Returns 0, EX_SOFTWARE or EX_DATAERR. */
int bonded_global(const struct assembly *A, struct global *P, struct failure *failure);

/* As problem_prepare(). Where loads push contacts the problem is given by a W, which has the bonds [solve/extra.h] in it
   [solve/prepare.h]: the slots' r are then r*. EX_SOFTWARE also where W is larger than the memory of
   the machine. */
int prepare_packing(struct problem *p, const struct packing *pack, const struct contacts *s,
                    const struct prepare_opt *o, struct failure *failure);
