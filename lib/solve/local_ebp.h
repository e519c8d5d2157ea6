/*
 * solve/local_ebp.h: the enhanced bi-potential method, Newton on
 *
 *     Z = r - proj(tau, K_mu),     tau = r - rho (v + mu |v_t| n)     [errorpred].
 *
 * The chain rule, with A = d(tau - proj(tau))/dtau, dtau = dr - rho G dv, G = I + mu n g^T and
 * g = v_t/|v_t| (0 at v_t = 0, where the stick step is exact):
 *
 *     dZ = dr - (I - A) dtau = A dr + rho (I - A) G dv.
 *
 * Multiplied out these are the paper's columns, but for a wrong sign in its dZ/dv_t of 2D, which is
 * rho mu/(1+mu^2) ((th_v + th_r) n + mu (1 + th_r th_v) t).
 */
#ifndef NSD_LOCAL_EBP_H
#define NSD_LOCAL_EBP_H

#include "solve/local_newton.h"

ALWAYS_INLINE void ebp_residual(vd mu, vd rho, struct newton_point *x)
{
    x->vt = cone_predict(mu, rho, x->r, x->v, x->tau), x->t = norm2(x->tau + 1);
    x->stick = lt(x->t, mu * x->tau[0]);
    x->free = le(mu * x->t, -x->tau[0]) & ~x->stick;
    cone_project(mu, x->tau, x->p);
    for (int i = 0; i < 3; i++) x->Z[i] = x->r[i] - x->p[i];
}

/*
 * Sliding, tau - proj = k (e - mu n) with k = (|tau_t| - mu tau_n)/(1+mu^2), e = tau_t/|tau_t|:
 *
 *     A = (e - mu n)(e - mu n)^T/(1+mu^2) + k/|tau_t| (I_t - e e^T).
 *
 * tau_t = 0 slides only when mu = 0; e := 0 there.
 */
ALWAYS_INLINE void ebp_slide(vd mu, const struct newton_point *x, vd A[3][3])
{
    vd c = 1.0 / (1.0 + mu * mu), s = newton_inverse(x->t);
    vd e1 = s * x->tau[1], e2 = s * x->tau[2], k = c * (1.0 - mu * x->tau[0] * s);
    A[0][0] = c * mu * mu;
    A[0][1] = A[1][0] = -c * mu * e1;
    A[0][2] = A[2][0] = -c * mu * e2;
    A[1][1] = c * e1 * e1 + k * (1.0 - e1 * e1);
    A[2][2] = c * e2 * e2 + k * (1.0 - e2 * e2);
    A[1][2] = A[2][1] = (c - k) * e1 * e2;
}

ALWAYS_INLINE void ebp_chain(vd mu, vd rho, const struct newton_point *x, vd A[3][3], vd B[3][3])
{
    vd g = mu * newton_inverse(x->vt), g1 = g * x->v[1], g2 = g * x->v[2];
    for (int i = 0; i < 3; i++) {
        B[i][0] = rho * ((double)(i == 0) - A[i][0]);
        B[i][1] = rho * ((double)(i == 1) - A[i][1]) + g1 * B[i][0];
        B[i][2] = rho * ((double)(i == 2) - A[i][2]) + g2 * B[i][0];
    }
}

/*
 * The equation along n + mu e, where A is 0, with h = mu g and dr_e substituted:
 *
 *     (w_n + mu p) dr_n = p lag - w_t h_q dr_q - (Z_n + mu Z_e)/rho,     p = w_t (mu + h_e).
 */
ALWAYS_INLINE void ebp_slip(const struct local *l, const struct newton_point *x, struct slip *s)
{
    vd k = (1.0 - l->mu * x->tau[0] * newton_inverse(x->t)) * (1.0 / (1.0 + l->mu * l->mu));
    vd wh = l->w[1] * (l->mu * newton_inverse(x->vt));
    vd whe = wh * (s->e[0] * x->v[1] + s->e[1] * x->v[2]);
    vd whq = wh * (s->e[0] * x->v[2] - s->e[1] * x->v[1]), p = l->w[1] * l->mu + whe;
    s->dq = slip_across(l, s, k);
    s->dn = (l->rho * (p * s->lag - whq * s->dq) - (s->Z[0] + l->mu * s->Z[1])) /
            (l->rho * (l->w[0] + l->mu * p));
}

ALWAYS_INLINE void ebp_solve(struct local *l, const struct local_opt *opt)
{
    newton_solve(l, opt, EBP);
}

#endif
