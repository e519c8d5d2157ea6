/* base/matrix.h: eigenvalues of small matrices, the same bits on every machine. */
#pragma once

#include "base/failure.h"

#include <stdbool.h>
#include <stdint.h>

enum { EIGEN_MOST = 6 };

/* The largest eigenvalue of the symmetric part of A[n n], n at most EIGEN_MOST, to a few roundings of the
   largest of all in magnitude. It has the unit of A's entries. */
double eigen_largest(int n, const double *A);

/*
 * Sparse matrices as lists of entries (row, col, x), and their reading from the
 * three forms in which FCLIB stores them, with every number checked.
 */

/* m x n, entries in any order; entries at the same place add up. */
struct sparse {
    int64_t m, n, count, room; /* rows, columns; entries, how many there is memory for */
    int32_t *row, *col;        /* [count] */
    double *x;                 /* [count] */
};

bool sparse_add(struct sparse *A, int64_t row, int64_t col, double x); /* false: no memory */
void sparse_free(struct sparse *A);

/*
 * An m x n matrix in libfclib's fields. nz = -2: by rows (CSR), -1: by columns (CSC), else nz
 * triplets, where real files have the columns in p and the rows in i (libfclib's header says the
 * opposite).
 */
struct stored {
    int32_t m, n, nz, nzmax;
    int32_t *p, *i;
    double *x;
    uint64_t np, ni, nx; /* lengths of p, i, x */
};

/* By rows (nz = -2) or columns (-1), with memory for count entries; p is zero. False: no memory; S
   must be freed then, too. */
bool stored_init(struct stored *S, int64_t m, int64_t n, int32_t nz, int64_t count);
void stored_free(struct stored *S);

/* S = A by columns, rows ascending, the entries at the same place added; false when memory is short or
   there are more entries than 32 bits count. S must be freed in any case. */
bool stored_columns(struct stored *S, const struct sparse *A);

/* A = S, all of it checked; moves the arrays of S into A. Returns 0, EX_SOFTWARE or EX_DATAERR with
   a reason "name/p: ...". */
int sparse_unpack(struct sparse *A, struct stored *S, const char *name, struct failure *failure);

/* Items that belong to n owners, listed by owner: those of o are item[first[o]] ..
   item[first[o+1]-1]. */
struct lists {
    int64_t *first; /* [n + 1] */
    int64_t *item;
};

/* Lists the items 0 .. count-1, each list ascending; owner[k] < n, negative: none. False when
   memory is short; nothing needs freeing then. */
bool lists_init(struct lists *L, int64_t n, int64_t count, const int32_t *owner);
void lists_free(struct lists *L);

/*
 * A = L U of sparse matrices that share one pattern, by SuiteSparse's KLU in an order of
 * the unknowns that its CHOLMOD chooses once. Pivots are taken on the diagonal; if that loses
 * accuracy, the caller has to refine the solution.
 */

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
