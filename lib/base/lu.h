/*
 * base/lu.h: sparse matrices of one pattern, one after another, factorised (SuiteSparse's KLU, in an order of its CHOLMOD). The order
 * of the unknowns is chosen once. Pivots are on the diagonal: what is lost thereby is the caller's to
 * win back, by refinement.
 */
#ifndef NSD_LU_H
#define NSD_LU_H

#include <stdbool.h>
#include <stdint.h>

struct lu;

/*
 * For n x n matrices by rows: entry k of row i is in column col[k], first[i] <= k < first[i+1], of
 * either array borrowed. NULL where memory is short or, *too_large, the factors would need more than
 * `bytes`.
 */
struct lu *lu_new(int32_t n, int32_t *first, int32_t *col, double bytes, bool *too_large);
void lu_free(struct lu *);

/* The rough price of a factorisation, in multiplications. */
double lu_cost(const struct lu *);

/* A, of entries a[], is factorised, or singular: false. */
bool lu_factorise(struct lu *, double *a);
/* The sign of det(A), +-1 */
int lu_sign(const struct lu *);
/* x[n] := A^-1 x */
bool lu_substitute(struct lu *, double *x);

#endif
