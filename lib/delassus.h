/*
 * delassus.h: a contact problem given by its Delassus operator alone, as an FCLIB file does:
 *
 *     u = W r + q,     (u, r) on the law with mu, contact by contact,
 *
 * W block-sparse, n x n blocks of d x d. The diagonal blocks stand apart, for the sweep wants
 * u_c = W_cc r_c + b_c with b_c the sum over the others.
 */
#ifndef NSD_DELASSUS_H
#define NSD_DELASSUS_H

#include "why.h"

#include <stdint.h>

struct delassus {
    int d;          /* 2 or 3 */
    int64_t n;      /* contacts */
    int64_t *first; /* [n + 1] off-diagonal blocks of row c: first[c] .. first[c+1]-1 */
    int32_t *col;   /* [blocks] their columns, ascending */
    double *block;  /* [blocks][d*d] row-major, kg^-1 */
    double *diag;   /* [n][9] W_cc, padded to 3 x 3 as local.h has it for d = 2 */
    double *q;      /* [n*d] m/s */
    double *mu;     /* [n] */
    double *r;      /* [n*d] N s: the reactions that the sweep reads */
};

/*
 * From the entries (row, col, x), [entries] of each, of an (n d) x (n d) matrix in any order; entries
 * of one place add up, blocks of nothing but zeros vanish. q[n d] and mu[n] are copied, r = 0.
 * Returns 0 or EX_SOFTWARE; indices have been checked by the caller.
 */
int delassus_init(struct delassus *, int d, int64_t n, int64_t entries, const int32_t *row,
                  const int32_t *col, const double *x, const double *q, const double *mu,
                  struct why *);
void delassus_free(struct delassus *);

/* b[3] = q_c + sum over the blocks beside the diagonal of W_cb r_b */
static inline void delassus_gather(const struct delassus *W, int64_t c, double b[3])
{
    int64_t k = W->first[c], end = W->first[c + 1];
    if (W->d == 2) {
        double b0 = W->q[2 * c], b1 = W->q[2 * c + 1];
        for (; k < end; k++) {
            const double *B = W->block + 4 * k, *r = W->r + 2 * (int64_t)W->col[k];
            b0 += B[0] * r[0] + B[1] * r[1];
            b1 += B[2] * r[0] + B[3] * r[1];
        }
        b[0] = b0, b[1] = b1, b[2] = 0;
        return;
    }
    double b0 = W->q[3 * c], b1 = W->q[3 * c + 1], b2 = W->q[3 * c + 2];
    for (; k < end; k++) {
        const double *B = W->block + 9 * k, *r = W->r + 3 * (int64_t)W->col[k];
        b0 += B[0] * r[0] + B[1] * r[1] + B[2] * r[2];
        b1 += B[3] * r[0] + B[4] * r[1] + B[5] * r[2];
        b2 += B[6] * r[0] + B[7] * r[1] + B[8] * r[2];
    }
    b[0] = b0, b[1] = b1, b[2] = b2;
}

#endif
