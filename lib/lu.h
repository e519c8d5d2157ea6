/*
 * lu.h: a sparse linear system solved by factorisation (SuiteSparse's KLU), for matrices of one
 * pattern one after another. The order of the unknowns is chosen once. Pivots are on the diagonal: what
 * is lost thereby is won back by refinement, or told by the residual.
 */
#ifndef NSD_LU_H
#define NSD_LU_H

#include <stdbool.h>
#include <stdint.h>

struct lu;

/*
 * For n x n matrices by rows: entry k of row i is in column col[k], first[i] <= k < first[i+1], of
 * either array borrowed. NULL where memory is short or the factors would need more than `bytes`.
 */
struct lu *lu_new(int32_t n, int32_t *first, int32_t *col, double bytes);
void lu_free(struct lu *);

/* The rough price of a factorisation, in multiplications. */
double lu_cost(const struct lu *);

/* x[n] := A^-1 x, A of entries a[]; false where that is not true to 1e-4. */
bool lu_solve(struct lu *, double *a, double *x);
/* The same with the A of the last lu_solve, factorised already. */
bool lu_again(struct lu *, double *x);

#endif
