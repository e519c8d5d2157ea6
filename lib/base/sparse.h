/*
 * base/sparse.h: sparse matrices as entries in any order, and their way out of the three forms in which
 * FCLIB stores them. Nothing of a stored one is believed before it is unpacked.
 */
#ifndef NSD_SPARSE_H
#define NSD_SPARSE_H

#include "base/why.h"

#include <stdbool.h>
#include <stdint.h>

/* m x n, entries in any order; those of one place add up. */
struct sparse {
    int64_t m, n, count, room;
    int32_t *row, *col; /* [count] */
    double *x;          /* [count] */
};

bool sparse_add(struct sparse *, int64_t row, int64_t col, double x); /* false: no memory */
void sparse_free(struct sparse *);

/*
 * A matrix with libfclib's fields. nz = -2: by rows (CSR), -1: by columns (CSC), else triplets, in
 * which real files have the columns in p and the rows in i (libfclib's header says the opposite).
 */
struct stored {
    int32_t m, n, nz, nzmax;
    int32_t *p, *i;
    double *x;
    uint64_t np, ni, nx; /* lengths of p, i, x */
};

/* By rows or columns (nz) with room for count entries, p zero; what is got is to be freed anyway. */
bool stored_init(struct stored *, int64_t m, int64_t n, int32_t nz, int64_t count);
void stored_free(struct stored *);

/* S, all of it checked, as entries; its arrays move into A. Trouble is named "name/p: ...". */
int sparse_unpack(struct sparse *A, struct stored *S, const char *name, struct why *);

/* Things that belong to n owners, listed by owner: those of o are item[first[o]] .. first[o+1]-1. */
struct lists {
    int64_t *first; /* [n + 1] */
    int64_t *item;
};

/* Things 0 .. count-1, owner[k] < n, or none if negative; each list ascends. false: no memory. */
bool lists_init(struct lists *, int64_t n, int64_t count, const int32_t *owner);
void lists_free(struct lists *);

#endif
