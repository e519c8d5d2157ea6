/*
 * solve/condense.h: a global contact problem brought to its local form.
 *
 *     M v = H r + G lambda + f,  G^T v + b = 0,  u = H^T v + w
 *
 * With K = [ M -G ; G^T 0 ] the motion is linear in the reactions,
 *
 *     (v, lambda) = K^-1 ((f, -b) + (H, 0) r) = v0 + V r,
 *     u = W r + q,  W = H^T V,  q = H^T v0 + w  (the upper rows of V and v0).
 *
 * K may be unsymmetric but not singular; KLU factorises it.
 */
#pragma once

#include "base/matrix.h"

struct global {
    int64_t nv, nl;        /* unknowns v, multipliers lambda */
    struct sparse M, H, G; /* nv x nv, nv x (n d), nv x nl */
    double *f, *b;         /* [nv], [nl] */
};

void global_free(struct global *P);

/* (v, lambda) = v0 + V r: kept of the condensation, to compute v and lambda from a solution r. */
struct motion {
    int64_t nv, nl;
    double *v0;      /* [nv + nl] */
    struct sparse V; /* (nv + nl) x (n d) */
};

/*
 * Fills W, and adds H^T v0 to q[n d], which holds w. Returns 0, EX_DATAERR where K is singular,
 * or EX_SOFTWARE; motion and W are to be freed in any case.
 */
int condense(const struct global *P, struct motion *U, struct sparse *W, double *q,
             struct failure *failure);

/* v[nv + nl] = v0 + V r */
void motion_of(const struct motion *U, const double *r, double *v);
void motion_free(struct motion *U);
