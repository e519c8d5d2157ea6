/*
 * solve/scaled.h: a contact problem as one scaled system, for the solvers that treat all contacts
 * at once.
 *
 *     v = W x + q,   r_c = s_c x_c,   s_c = 1/sqrt(lambda_max(W_cc)),
 *
 * so that every W_cc is of order 1 whatever the masses, and x and v have the same unit, sqrt(J).
 * (v, x) satisfies the law where (u, r) does. A packing's W is assembled [solve/assembly.h].
 */
#pragma once

#include "solve/solver.h"

struct scaled {
    struct delassus W; /* scaled: blocks, diagonal, q */
    double *s;         /* [n] kg^(1/2) */
    double *zero;      /* [size] zeros, in place of q */
    double *r;         /* [slots][3] work space of scaled_put() */
    double mean;       /* of the diagonal of W */
    int32_t size;      /* n d */
};

/* D u~ = W r + q of a packing, as an FCLIB file would have it, not scaled, r = 0. Returns 0, or
   EX_SOFTWARE with nothing to free. */
int scaled_assemble(struct delassus *W, const struct problem *p, struct failure *failure);

/* Returns 0, EX_SOFTWARE, or EX_DATAERR where the problem is too large for 32-bit indices. To be
   freed in any case. */
int scaled_init(struct scaled *a, const struct problem *p, struct failure *failure);
void scaled_free(struct scaled *a);

/* x[size] = the iterate's */
void scaled_get(const struct scaled *a, const struct problem *p, double *x);
/* x[size] becomes the iterate, and is judged; returns the criterion. */
double scaled_put(struct scaled *a, struct solve *s, const double *x);

/* v = W x + q; and v = W x. Four numbers behind x may be read. */
void scaled_velocity(const struct scaled *a, const double *x, double *v);
void scaled_product(const struct scaled *a, const double *x, double *v);

/* The scaled natural map: |x - P(x - v^)| / |x|, v^ = v + mu |v_t| n, v = W x + q */
double scaled_natural(const struct scaled *a, const double *x, const double *v);
/* |x_c - P(x_c - v^_c)| of contact c */
double scaled_natural_of(const struct scaled *a, int64_t c, const double *x, const double *v);

/* Copies of one contact's components, from d numbers to 3 and back */
static inline void scaled_load(int d, const double *x, double out[3])
{
    out[0] = x[0], out[1] = x[1], out[2] = d == 3 ? x[2] : 0;
}
static inline void scaled_store(int d, const double in[3], double *x)
{
    x[0] = in[0], x[1] = in[1];
    if (d == 3) x[2] = in[2];
}
