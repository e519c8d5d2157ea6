/* solve/rolling_newton.c: Newton's method for ebp and eal with rolling friction [solve/rolling_parts.h]. */
#include "solve/rolling.h"
#include "solve/rolling_parts.h"

#include <gsl/gsl_linalg.h>
#include <string.h>

/* An iterate of ebp (hat) or eal: Z = x - proj(tau) */
struct point {
    double x[ROLLING], u[ROLLING], tau[ROLLING], p[ROLLING], Z[ROLLING], z2;
    bool at_limit[ROLLING_PARTS];
};

static void rolling_newton_residual(const struct rolling *q, bool hat, struct point *y)
{
    rolling_velocity(q, y->x, y->u);
    predict(q, q->rho, y->x, y->u, hat, y->tau);
    double rn = hat ? cone_top(q, y->tau, y->at_limit) : fmax(y->tau[0], 0);
    for (int i = 0; i < ROLLING_PARTS; i++)
        y->at_limit[i] = rolling_part(y->tau, i) > q->mu[i] * rn;
    limit(q, y->tau, rn, y->p);
    for (int i = 0; i < ROLLING; i++) y->Z[i] = y->x[i] - y->p[i];
    y->z2 = dot(y->Z, y->Z, ROLLING);
}

/* T = d tau/dx = I - rho (W + n (grad of the slip) W) */
static void slope_of_prediction(const struct rolling *q, bool hat, const struct point *y,
                                double T[ROLLING][ROLLING])
{
    double W[ROLLING][ROLLING] = { { 0 } };
    W[0][0] = q->wn, W[3][3] = q->wp;
    for (int i = 1; i < 3; i++)
        W[i][i] = q->wt, W[3 + i][3 + i] = q->wr, W[i][3 + i] = W[3 + i][i] = q->k;
    if (q->full) memcpy(W, q->W, sizeof W);
    for (int i = 0; i < ROLLING; i++)
        for (int j = 0; j < ROLLING; j++) T[i][j] = (i == j) - q->rho * W[i][j];
    for (int i = 0; hat && i < ROLLING_PARTS; i++) {
        double length = rolling_part(y->u, i);
        for (int l = first_of[i]; length > 0 && l < first_of[i] + size_of[i]; l++)
            for (int j = 0; j < ROLLING; j++)
                T[0][j] -= q->rho * q->mu[i] * y->u[l] / length * W[l][j];
    }
}

/* P = d proj/d tau */
static void slope_of_projection(const struct rolling *q, bool hat, const struct point *y,
                                double P[ROLLING][ROLLING])
{
    double all = 1, top[ROLLING] = { 1 };
    memset(P, 0, ROLLING * sizeof *P);
    if (!(y->p[0] > 0)) return;
    for (int i = 0; i < ROLLING_PARTS && hat; i++) {
        if (!y->at_limit[i]) continue;
        double length = rolling_part(y->tau, i);
        all += q->mu[i] * q->mu[i];
        for (int j = first_of[i]; j < first_of[i] + size_of[i]; j++)
            top[j] = q->mu[i] * y->tau[j] / length;
    }
    for (int j = 0; j < ROLLING; j++) P[0][j] = top[j] / all;
    for (int i = 0; i < ROLLING_PARTS; i++) {
        double length = rolling_part(y->tau, i), s = q->mu[i] * y->p[0] / length;
        for (int l = first_of[i]; l < first_of[i] + size_of[i]; l++) {
            if (!y->at_limit[i]) {
                P[l][l] = 1;
                continue;
            }
            double e = y->tau[l] / length;
            for (int j = 0; j < ROLLING; j++) P[l][j] = q->mu[i] * e * P[0][j];
            for (int j = first_of[i]; j < first_of[i] + size_of[i]; j++)
                P[l][j] += s * ((l == j) - e * y->tau[j] / length);
        }
    }
}

/* dx of (I - P T) dx = -Z; false where the matrix is singular */
static bool rolling_newton_direction(const struct rolling *q, bool hat, const struct point *y,
                                     double dx[ROLLING])
{
    double T[ROLLING][ROLLING], P[ROLLING][ROLLING], M[ROLLING * ROLLING];
    slope_of_prediction(q, hat, y, T), slope_of_projection(q, hat, y, P);
    for (int i = 0; i < ROLLING; i++)
        for (int j = 0; j < ROLLING; j++) {
            double sum = i == j;
            for (int l = 0; l < ROLLING; l++) sum -= P[i][l] * T[l][j];
            M[ROLLING * i + j] = sum;
        }
    size_t order[ROLLING];
    int sign;
    gsl_permutation p = { ROLLING, order };
    gsl_matrix_view A = gsl_matrix_view_array(M, ROLLING, ROLLING);
    for (int i = 0; i < ROLLING; i++) dx[i] = -y->Z[i];
    gsl_vector_view b = gsl_vector_view_array(dx, ROLLING);
    gsl_permutation_init(&p);
    if (gsl_linalg_LU_decomp(&A.matrix, &p, &sign)) return false;
    for (int i = 0; i < ROLLING; i++)
        if (!(fabs(M[ROLLING * i + i]) > 0)) return false;
    gsl_linalg_LU_svx(&A.matrix, &p, &b.vector);
    return isfinite(dot(dx, dx, ROLLING));
}

bool rolling_newton(struct rolling *q, bool hat, const struct local_opt *opt)
{
    double b2 = q->rho * q->rho * dot(q->b, q->b, ROLLING),
           eps2 = opt->newton_eps * opt->newton_eps;
    struct point x = { .z2 = 0 }, y;
    memcpy(x.x, q->x, sizeof x.x);
    rolling_newton_residual(q, hat, &x);
    for (int k = 0; k == 0 || k < opt->newton_max; k++) {
        double dx[ROLLING], s = 1;
        if (!rolling_newton_direction(q, hat, &x, dx)) return false;
        q->steps++;
        for (;; s *= 0.5) {
            for (int i = 0; i < ROLLING; i++) y.x[i] = x.x[i] + s * dx[i];
            rolling_newton_residual(q, hat, &y);
            double end2 = eps2 * (dot(y.x, y.x, ROLLING) + b2), least = 1 - 1e-4 * s;
            if (opt->newton_abs > 0) end2 = opt->newton_abs * opt->newton_abs;
            if (y.z2 <= end2) {
                memcpy(q->x, y.p, sizeof y.p);
                return true;
            }
            if (opt->plain ? isfinite(y.z2) : y.z2 < x.z2 * least * least) break;
            if (opt->plain || s < 1e-3) return false;
        }
        x = y;
    }
    return false;
}
