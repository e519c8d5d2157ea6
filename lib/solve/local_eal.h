/*
 * solve/local_eal.h: the enhanced augmented Lagrangian, Newton on
 *
 *     Z = r - proj(tau, C(mu tau_n)),     tau = r - rho v     [predbipo],
 *
 * C = R+ x the disc of radius mu tau_n. With A = d(tau - proj(tau))/dtau and dtau = dr - rho dv
 *
 *     dZ = dr - (I - A) dtau = A dr + rho (I - A) dv.
 *
 * Two corrections to the paper: dZ/dv_tk of sliding has a plus sign, + rho mu tau_n
 * (t_k - tau_tk tau_t/|tau_t|^2)/|tau_t|, and B_c of the plane has the factor rho.
 */
#ifndef NSD_LOCAL_EAL_H
#define NSD_LOCAL_EAL_H

#include "solve/local_newton.h"

ALWAYS_INLINE void eal_residual(vd mu, vd rho, struct newton_point *x)
{
    disc_predict(rho, x->r, x->v, x->tau);
    x->t = norm2(x->tau + 1), x->vt = splat(0);
    x->free = le(x->tau[0], splat(0));
    x->stick = lt(x->t, mu * x->tau[0]) & ~x->free;
    disc_project(mu, x->tau, x->p);
    for (int i = 0; i < 3; i++) x->Z[i] = x->r[i] - x->p[i];
}

/*
 * Sliding, proj = tau_n (n + mu e) with e = tau_t/|tau_t|:
 *
 *     A = I_t - mu e n^T - mu tau_n/|tau_t| (I_t - e e^T).
 *
 * tau_t = 0 slides only when mu = 0; e := 0 there.
 */
ALWAYS_INLINE void eal_slide(vd mu, const struct newton_point *x, vd A[3][3])
{
    vd s = newton_inverse(x->t), e1 = s * x->tau[1], e2 = s * x->tau[2], k = mu * x->tau[0] * s;
    A[0][0] = A[0][1] = A[0][2] = splat(0);
    A[1][0] = -mu * e1;
    A[2][0] = -mu * e2;
    A[1][1] = 1.0 - k * (1.0 - e1 * e1);
    A[2][2] = 1.0 - k * (1.0 - e2 * e2);
    A[1][2] = A[2][1] = k * e1 * e2;
}

ALWAYS_INLINE void eal_chain(vd mu, vd rho, const struct newton_point *x, vd A[3][3], vd B[3][3])
{
    (void)mu, (void)x;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) B[i][j] = rho * ((double)(i == j) - A[i][j]);
}

/* Along n A is 0 and Z_n = rho v_n. */
ALWAYS_INLINE void eal_slip(const struct local *l, const struct newton_point *x, struct slip *s)
{
    s->dq = slip_across(l, s, 1.0 - l->mu * x->tau[0] * newton_inverse(x->t));
    s->dn = -x->v[0] * l->iw[0];
}

ALWAYS_INLINE void eal_solve(struct local *l, const struct local_opt *opt)
{
    newton_solve(l, opt, EAL);
}

#endif
