/*
 * solve/scaled.h: all contacts at once: a contact problem as one scaled system, for the solvers that look at
 * the whole of it.
 *
 *     v = W x + q,   r_c = s_c x_c,   s_c = 1/sqrt(lambda_max(W_cc)),
 *
 * so that every W_cc is of order 1 whatever the masses, and x and v are in units of one size,
 * sqrt(J). (v, x) is on the law where (u, r) is. A packing's W is assembled [problem/assembly.h].
 */
#ifndef NSD_SCALED_H
#define NSD_SCALED_H

#include "problem/problem.h"

struct scaled {
    struct delassus W; /* scaled: blocks, diagonal, q */
    double *s;         /* [n] sqrt(kg) */
    double *zero;      /* [size] */
    double mean;       /* of the diagonal of W */
    int32_t size;      /* n d */
};

/* D u~ = W r + q of a packing, as an FCLIB file would have it, not scaled, r = 0. Returns 0, or
   EX_SOFTWARE or EX_DATAERR with nothing to free. */
int scaled_assemble(struct delassus *, const struct problem *, struct why *);

/* Returns 0 or EX_SOFTWARE; where it is too large for 32-bit indices, EX_DATAERR. */
int scaled_init(struct scaled *, const struct problem *, struct why *);
void scaled_free(struct scaled *);

void scaled_get(const struct scaled *, const struct problem *, double *x);
/* x into the rows, with the bodies and u that belong to it */
void scaled_put(const struct scaled *, struct problem *, const double *x);

/* v = W x + q, and v = W x */
void scaled_velocity(const struct scaled *, const double *x, double *v);
void scaled_product(const struct scaled *, const double *x, double *v);

/* |x - P(x - v^)| / |x|, v^ = v + mu |v_t| n, v = W x + q: the natural map's, scaled */
double scaled_natural(const struct scaled *, const double *x, const double *v);

/* Component-wise copies between d and 3 numbers */
static inline void scaled_load(int d, const double *x, double out[3])
{
    out[0] = x[0], out[1] = x[1], out[2] = d == 3 ? x[2] : 0;
}
static inline void scaled_store(int d, const double in[3], double *x)
{
    for (int k = 0; k < d; k++) x[k] = in[k];
}

#endif
