/*
 * solve/delassus.h: a contact problem given by its Delassus operator alone, as an FCLIB file
 * does:
 *
 *     u = W r + q,     (u, r) on the law with mu, contact by contact,
 *
 * W block-sparse, n x n blocks of d x d. The diagonal blocks are stored apart, since the sweep
 * needs u_c = W_cc r_c + b_c with b_c = q_c + the sum over the others.
 *
 * What all contacts have in common, such as an edge of a cell that yields to a stress, would fill W. It is
 * kept apart as well, a few columns J:
 *
 *     W = blocks + J J^T,     J J^T r by the sums J^T r.
 *
 * A sweep solves the contacts of a bundle at once, with the sums as they were before. This is sound if each
 * of the k contacts counts its own part k times, W^_cc = W_cc + (k - 1) J_c J_c^T, since
 * (sum of k numbers)^2 <= k times the sum of their squares.
 */
#pragma once

#include "base/failure.h"
#include "base/matrix.h"

#include <stdbool.h>
#include <stdint.h>

enum {
    COMMON_MAX = 10 /* columns of J: the components of a cell's edges, and the size of a room */
};

struct delassus {
    int d;          /* 2 or 3 */
    int64_t n;      /* contacts */
    int64_t *first; /* [n + 1] off-diagonal blocks of row c: first[c] .. first[c+1]-1 */
    int32_t *col;   /* [blocks] their columns, ascending */
    double *block;  /* [blocks][d*d] column-major, kg^-1; 4 more numbers may be read */
    double *
        diag; /* [n][9] W_cc without J, column-major, padded to 3 x 3 as solve/local.h has it for d = 2 */
    double *q;  /* [n*d] m/s */
    double *mu; /* [n] */
    double *r;  /* [n*d] N s: the reactions that the sweep reads */
    int common; /* columns of J */
    double *J;  /* [n*d][common] kg^(-1/2) */
    double sum[COMMON_MAX],
        next[COMMON_MAX]; /* kg^(1/2) m/s: J^T r before the group in hand, and by now */
};

/* Arrays for this many blocks, all zero. Returns 0, or EX_SOFTWARE with nothing to free. */
int delassus_alloc(struct delassus *W, int d, int64_t n, int64_t blocks, struct failure *failure);
/* J with so many columns, all zero. Returns 0, or EX_SOFTWARE with all of W freed. */
int delassus_alloc_common(struct delassus *W, int common, struct failure *failure);

/* W_cc = B, d x d by columns; in the plane with the third row and column of solve/local.h. */
void delassus_set_diag(struct delassus *W, int64_t c, const double *B);

/* Whether a block B[d*d] has an entry other than zero: only such blocks are stored. */
bool delassus_block_counts(int d, const double *B);

/*
 * The blocks of A, an (n d) x (n d) matrix; those of zeros are left out. q, mu and r are 0. Returns 0, or EX_SOFTWARE
 * with nothing to free. The caller has checked the indices.
 */
int delassus_init(struct delassus *W, int d, int64_t n, const struct sparse *A,
                  struct failure *failure);
void delassus_free(struct delassus *W);

/*
 * Copies block rows in the order in which they will be read: row i of `to` is row row[i] of W, or
 * empty where that is -1. Only q and the off-diagonal blocks are copied; columns are W's
 * contacts. Returns 0, or EX_SOFTWARE with nothing to free.
 */
int delassus_sort(struct delassus *to, const struct delassus *W, int64_t rows, const int32_t *row,
                  struct failure *);

/* Some of W's contacts */
struct selection_contacts {
    int64_t n;
    int32_t *contact; /* [n] ascending: contact i of them is contact[i] of W */
    int32_t *of;      /* [W->n] the inverse of contact[]; -1: not chosen */
};

/*
 * The problem of the chosen contacts by themselves, with the reactions of all others held.
 * r and v = W r + q are given for all contacts of W. to->r is taken from r. Returns 0, or EX_SOFTWARE with nothing to
 * free.
 */
int delassus_subset(struct delassus *to, const struct delassus *W,
                    const struct selection_contacts *chosen, const double *r, const double *v,
                    struct failure *failure);

/* The number of entries of W, in all of its blocks */
static inline double delassus_entries(const struct delassus *W)
{
    return (double)((W->first[W->n] + W->n) * W->d * W->d);
}

/* v = W x + q, of [n*d] numbers each; one more number behind x may be read. */
void delassus_apply(const struct delassus *W, const double *x, const double *q, double *v);

/* D[9] = diag of contact c with `times` its part J_c J_c^T */
void delassus_own(const struct delassus *W, int64_t c, double times, double D[9]);
/* sum[common] = J^T x */
void delassus_common(const struct delassus *W, const double *x, double *sum);
/* sum and next of W->r; and at the end of a group sum = next */
static inline void delassus_begin(struct delassus *W)
{
    delassus_common(W, W->r, W->sum);
    for (int k = 0; k < W->common; k++) W->next[k] = W->sum[k];
}
static inline void delassus_end_group(struct delassus *W)
{
    for (int k = 0; k < W->common; k++) W->sum[k] = W->next[k];
}
/* b[d] += J_c (sum - times J_c^T r_c): of a contact that counts its own part so often, what the rest is */
static inline void delassus_add_common(const struct delassus *W, int64_t c, double times, double *b)
{
    const int n = W->common, d = W->d;
    const double *J = W->J + d * n * c, *r = W->r + d * c;
    for (int k = 0; k < n; k++) {
        double own = 0;
        for (int i = 0; i < d; i++) own += J[n * i + k] * r[i];
        for (int i = 0; i < d; i++) b[i] += J[n * i + k] * (W->sum[k] - times * own);
    }
}
/* next += J_c^T (r - r_c), before r_c becomes r[d] */
static inline void delassus_change_common(struct delassus *W, int64_t c, const double *r)
{
    const int n = W->common, d = W->d;
    const double *J = W->J + d * n * c;
    for (int k = 0; k < n; k++)
        for (int i = 0; i < d; i++) W->next[k] += J[n * i + k] * (r[i] - W->r[d * c + i]);
}

/* Four numbers from a column of d: the surplus ends up in b[d..], which is never read. */
typedef double column __attribute__((vector_size(32), may_alias, aligned(8)));

/* b[d] = q_c + the sum of W_cb r_b over the off-diagonal blocks */
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
