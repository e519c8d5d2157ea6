/*
 * solve/bonded.h: the Delassus operator of contacts that are bonded, for solvers that want a W.
 *
 * The bonds' p = - a - K u~ of all contacts, u~ = H^T v + w, in the motion M v = f + H (r* + p):
 *
 *     (M + H K H^T) v = f - H (a + K w) + H r*
 *
 * which solve/condense.h brings to u~ = W^ r* + q^. W^ couples all contacts of bodies that hang
 * together by bonds: it has the square of their number of blocks.
 */
#ifndef NSD_BONDED_H
#define NSD_BONDED_H

#include "solve/assembly.h"
#include "solve/condense.h"

/* W^ and q^[n d] of an assembly whose problem has bonds; W is to be freed in any case. Returns 0, EX_DATAERR
   or EX_SOFTWARE, also where the machine has no memory for W^. */
int bonded_local(const struct assembly *A, struct sparse *W, double *q, struct failure *failure);
/* W^, q^, mu, r = 0, of a packing's problem with its bodies. Returns 0, EX_SOFTWARE or EX_DATAERR, with
   nothing to free. */
int bonded_blocks(const struct problem *bodies, struct delassus *W, struct failure *failure);

/* M + H K H^T, H and f - H (a + K w) of an assembly whose problem has bonds; P is to be freed in any
   case. Returns 0, EX_SOFTWARE or EX_DATAERR. */
int bonded_global(const struct assembly *A, struct global *P, struct failure *failure);

#endif
