/*
 * base/sparse.h: sparse matrices as lists of entries (row, col, x), and their reading from the
 * three forms in which FCLIB stores them, with every number checked.
 */
#ifndef NSD_SPARSE_H
#define NSD_SPARSE_H

#include "base/failure.h"

#include <stdbool.h>
#include <stdint.h>

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

#endif
