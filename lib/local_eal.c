/*
 * local_eal.c: the enhanced augmented Lagrangian, Newton on
 *
 *     Z = r - proj(tau, C(mu tau_n)),     tau = r - rho v     [predbipo],
 *
 * C = R+ x the disc of radius mu tau_n. With A = d(tau - proj(tau))/dtau and dtau = dr - rho dv
 *
 *     dZ = dr - (I - A) dtau = A dr + rho (I - A) dv.
 *
 * Against the paper: dZ/dv_tk of sliding has a plus, rho mu tau_n (t_k - tau_tk tau_t/|tau_t|^2)/
 * |tau_t|, and B_c of the plane wants the factor rho.
 */
#include "local_newton.h"

ALWAYS_INLINE void residual(double mu, double rho, struct iterate *x)
{
    disc_predict(rho, x->r, x->v, x->tau);
    x->t = norm2(x->tau + 1);
    x->status = x->tau[0] <= 0 ? LOCAL_FREE : x->t < mu * x->tau[0] ? LOCAL_STICK : LOCAL_SLIDE;
    disc_project(mu, x->tau, x->p);
    for (int i = 0; i < 3; i++) x->Z[i] = x->r[i] - x->p[i];
}

/*
 * Sliding, proj = tau_n (n + mu e) with e = tau_t/|tau_t|:
 *
 *     A = I_t - mu e n^T - mu tau_n/|tau_t| (I_t - e e^T);
 *
 * A = 0 sticking, A = I without contact. tau_t = 0 slides at mu = 0 only; e := 0 there.
 */
ALWAYS_INLINE void tangent(double mu, double rho, const struct iterate *x, double A[3][3],
                           double B[3][3])
{
    double s = x->t > 0 ? 1 / x->t : 0, e1 = s * x->tau[1], e2 = s * x->tau[2],
           k = mu * x->tau[0] * s;
    double same = x->status == LOCAL_FREE;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) A[i][j] = i == j ? same : 0;
    if (x->status == LOCAL_SLIDE) {
        A[1][0] = -mu * e1;
        A[2][0] = -mu * e2;
        A[1][1] = 1 - k * (1 - e1 * e1);
        A[2][2] = 1 - k * (1 - e2 * e2);
        A[1][2] = A[2][1] = k * e1 * e2;
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) B[i][j] = rho * ((i == j) - A[i][j]);
}

enum local_status eal_linearise(double mu, double rho, const double r[3], const double v[3],
                                double Z[3], double A[3][3], double B[3][3])
{
    return newton_linearise(mu, rho, r, v, residual, tangent, Z, A, B);
}

static void solve(struct local *l, const struct local_opt *opt)
{
    newton_solve(l, opt, residual, tangent);
}

const struct method local_eal = { "eal",
                                  "enhanced augmented Lagrangian: Newton on r = proj(tau, disc)", 1,
                                  true, solve };
