/*
 * base/lu.h: A = L U of sparse matrices that share one pattern, by SuiteSparse's KLU in an order of
 * the unknowns that its CHOLMOD chooses once. Pivots are taken on the diagonal; if that loses
 * accuracy, the caller has to refine the solution.
 */
#ifndef NSD_LU_H
#define NSD_LU_H

#include <stdbool.h>
#include <stdint.h>

struct lu;

/*
 * For n x n matrices by rows: entries first[i] .. first[i+1]-1 are row i, in columns col[]. Both
 * arrays are borrowed until lu_free. NULL if memory is short or, with *too_large set, if the factors
 * would need more than `bytes` bytes.
 */
struct lu *lu_new(int32_t n, int32_t *first, int32_t *col, double bytes, bool *too_large);
void lu_free(struct lu *lu);

/* Multiplications of a factorisation, roughly */
double lu_cost(const struct lu *lu);

/* Factorises A, entries a[] in the order of col[]; false if A is singular or memory is short. */
bool lu_factorise(struct lu *lu, double *a);
/* The sign of det(A), +-1, of the last factorisation */
int lu_sign(const struct lu *lu);
/* x[n] = A^-1 x; false if that fails */
bool lu_substitute(struct lu *lu, double *x);

#endif
