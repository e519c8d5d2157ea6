/*
 * problem/delassus.h: a contact problem given by its Delassus operator alone, as an FCLIB file does:
 *
 *     u = W r + q,     (u, r) on the law with mu, contact by contact,
 *
 * W block-sparse, n x n blocks of d x d. The diagonal blocks stand apart, for the sweep wants
 * u_c = W_cc r_c + b_c with b_c the sum over the others.
 */
#ifndef NSD_DELASSUS_H
#define NSD_DELASSUS_H

#include "base/why.h"

#include <stdbool.h>
#include <stdint.h>

struct delassus {
    int d;          /* 2 or 3 */
    int64_t n;      /* contacts */
    int64_t *first; /* [n + 1] off-diagonal blocks of row c: first[c] .. first[c+1]-1 */
    int32_t *col;   /* [blocks] their columns, ascending */
    double *block;  /* [blocks][d*d] column-major, kg^-1; four more may be read */
    double
        *diag;  /* [n][9] W_cc, column-major too, padded to 3 x 3 as law/local.h has it for d = 2 */
    double *q;  /* [n*d] m/s */
    double *mu; /* [n] */
    double *r;  /* [n*d] N s: the reactions that the sweep reads */
};

/* Room for the blocks, all of it zero; no rows begun. Returns 0 or EX_SOFTWARE with nothing to free. */
int delassus_alloc(struct delassus *W, int d, int64_t n, int64_t blocks, struct why *why);

/* W_cc := B, d x d by columns; in the plane with law/local.h's third row and column. */
void delassus_set_diag(struct delassus *W, int64_t c, const double *B);

/* Whether a block B[d*d] has anything but zeros in it: only such ones are kept. */
bool delassus_block_counts(int d, const double *B);

/*
 * From the entries (row, col, x), [entries] of each, of an (n d) x (n d) matrix in any order; entries
 * of one place add up, blocks of nothing but zeros vanish. q[n d] and mu[n] are copied, r = 0.
 * Returns 0 or EX_SOFTWARE; indices have been checked by the caller.
 */
int delassus_init(struct delassus *, int d, int64_t n, int64_t entries, const int32_t *row,
                  const int32_t *col, const double *x, const double *q, const double *mu,
                  struct why *);
void delassus_free(struct delassus *);

/*
 * Row i of `to` is W's row[i], without blocks where that is -1, so that rows which are read one after
 * another lie so, too: its blocks and q, and no more. The columns are W's contacts. 0 or EX_SOFTWARE.
 */
int delassus_sort(struct delassus *to, const struct delassus *W, int64_t rows, const int32_t *row,
                  struct why *);

/*
 * The contacts contact[n] of W by themselves, the others' reactions as r[n d of W] has them; v = W r + q.
 * contact[] ascends, of[] of W's contacts is where they are in it, else -1. to->r is of r. 0 or
 * EX_SOFTWARE.
 */
int delassus_subset(struct delassus *to, const struct delassus *W, int64_t n,
                    const int32_t *contact, const int32_t *of, const double *r, const double *v,
                    struct why *why);

/* How many numbers W's blocks have */
static inline double delassus_entries(const struct delassus *W)
{
    return (double)((W->first[W->n] + W->n) * W->d * W->d);
}

/* v = W x + q, of [n*d] numbers each; x is followed by one more number that may be read. */
void delassus_apply(const struct delassus *W, const double *x, const double *q, double *v);

/* Four of a column, though only d are meant: what is beyond them ends in b[d..], which nobody reads. */
typedef double column __attribute__((vector_size(32), may_alias, aligned(8)));

/* b[d] = q_c + sum over the blocks beside the diagonal of W_cb r_b */
static inline void delassus_gather(const struct delassus *W, int64_t c, const double *q,
                                   const double *r, double b[4])
{
    int d = W->d;
    const double *B = W->block + d * d * W->first[c], *qc = q + d * c;
    const int32_t *col = W->col + W->first[c], *end = W->col + W->first[c + 1];
    column sum = { qc[0], qc[1], d == 3 ? qc[2] : 0, 0 };
    if (d == 2)
        for (; col < end; col++, B += 4) {
            const double *x = r + 2 * (int64_t)*col;
            sum += *(const column *)B * x[0] + *(const column *)(B + 2) * x[1];
        }
    else
        for (; col < end; col++, B += 9) {
            const double *x = r + 3 * (int64_t)*col;
            sum += *(const column *)B * x[0] + *(const column *)(B + 3) * x[1] +
                   *(const column *)(B + 6) * x[2];
        }
    *(column *)b = sum;
}

#endif
