/*
 * problem/condense.h: a global contact problem brought to its local form.
 *
 *     M v = H r + G lambda + f,  G^T v + b = 0,  u = H^T v + w
 *
 * With K = [ M -G ; G^T 0 ] the motion is linear in the reactions,
 *
 *     (v, lambda) = K^-1 ((f, -b) + (H, 0) r) = v0 + V r,
 *     u = W r + q,  W = H^T V,  q = H^T v0 + w  (the upper rows of V and v0).
 *
 * K may be unsymmetric, not singular; KLU factorises it.
 */
#ifndef NSD_CONDENSE_H
#define NSD_CONDENSE_H

#include "base/sparse.h"

struct global {
    int64_t nv, nl;        /* unknowns v, multipliers lambda */
    struct sparse M, H, G; /* nv x nv, nv x (n d), nv x nl */
    double *f, *b;         /* [nv], [nl] */
};

void global_free(struct global *);

/* v0 + V r: what the condensation keeps, so that r gives v and lambda back. */
struct motion {
    int64_t nv, nl;
    double *v0;      /* [nv + nl] */
    struct sparse V; /* (nv + nl) x (n d) */
};

/*
 * W, and what q is more than w: H^T v0 is added to q[n d]. Returns 0, EX_DATAERR where K is singular,
 * or EX_SOFTWARE; motion and W are to be freed in any case.
 */
int condense(const struct global *, struct motion *, struct sparse *W, double *q, struct why *);

void motion_of(const struct motion *, const double *r, double *v); /* v[nv + nl] */
void motion_free(struct motion *);

#endif
