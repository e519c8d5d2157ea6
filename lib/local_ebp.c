/*
 * local_ebp.c: the enhanced bi-potential method, Newton on
 *
 *     Z = r - proj(tau, K_mu),     tau = r - rho (v + mu |v_t| n)     [errorpred].
 *
 * The chain rule, with A = d(tau - proj(tau))/dtau, dtau = dr - rho G dv, G = I + mu n g^T and
 * g = v_t/|v_t| (0 at v_t = 0, where the stick step is exact):
 *
 *     dZ = dr - (I - A) dtau = A dr + rho (I - A) G dv.
 *
 * Multiplied out these are the paper's columns; its 2D dZ/dv_t has a sign wrong, and is
 * rho mu/(1+mu^2) ((th_v + th_r) n + mu (1 + th_r th_v) t).
 */
#include "local_newton.h"

ALWAYS_INLINE void residual(double mu, double rho, struct iterate *x)
{
    x->vt = cone_predict(mu, rho, x->r, x->v, x->tau);
    x->t = norm2(x->tau + 1);
    x->status = x->t < mu * x->tau[0]     ? LOCAL_STICK
                : mu * x->t <= -x->tau[0] ? LOCAL_FREE
                                          : LOCAL_SLIDE;
    cone_project(mu, x->tau, x->p);
    for (int i = 0; i < 3; i++) x->Z[i] = x->r[i] - x->p[i];
}

/*
 * Sliding, tau - proj = k (e - mu n) with k = (|tau_t| - mu tau_n)/(1+mu^2), e = tau_t/|tau_t|:
 *
 *     A = (e - mu n)(e - mu n)^T/(1+mu^2) + k/|tau_t| (I_t - e e^T);
 *
 * A = 0 sticking, A = I without contact. tau_t = 0 slides at mu = 0 only; e := 0 there.
 */
ALWAYS_INLINE void tangent(double mu, double rho, const struct iterate *x, double A[3][3],
                           double B[3][3])
{
    double c = 1 / (1 + mu * mu), s = x->t > 0 ? 1 / x->t : 0, e1 = s * x->tau[1],
           e2 = s * x->tau[2], k = c * (1 - mu * x->tau[0] * s);
    double same = x->status == LOCAL_FREE;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) A[i][j] = i == j ? same : 0;
    if (x->status == LOCAL_SLIDE) {
        A[0][0] = c * mu * mu;
        A[0][1] = A[1][0] = -c * mu * e1;
        A[0][2] = A[2][0] = -c * mu * e2;
        A[1][1] = c * e1 * e1 + k * (1 - e1 * e1);
        A[2][2] = c * e2 * e2 + k * (1 - e2 * e2);
        A[1][2] = A[2][1] = (c - k) * e1 * e2;
    }
    double g = x->vt > 0 ? mu / x->vt : 0, g1 = g * x->v[1], g2 = g * x->v[2];
    for (int i = 0; i < 3; i++) {
        B[i][0] = rho * ((i == 0) - A[i][0]);
        B[i][1] = rho * ((i == 1) - A[i][1]) + g1 * B[i][0];
        B[i][2] = rho * ((i == 2) - A[i][2]) + g2 * B[i][0];
    }
}

enum local_status ebp_linearise(double mu, double rho, const double r[3], const double v[3],
                                double Z[3], double A[3][3], double B[3][3])
{
    return newton_linearise(mu, rho, r, v, residual, tangent, Z, A, B);
}

static void solve(struct local *l, const struct local_opt *opt)
{
    newton_solve(l, opt, residual, tangent);
}

const struct method local_ebp = { "ebp", "enhanced bi-potential: Newton on r = proj(tau, cone)", 1,
                                  true, solve };
