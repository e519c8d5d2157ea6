/*
 * local_newton.h: what the four methods of the paper share: prediction, correction, Newton.
 *
 * SBP and SAL take one step r = proj(tau(r, u)). EBP and EAL solve
 *
 *     f = v - b - W r = 0,     Z = r - proj(tau(r, v)) = 0     [locprob2, errorpred, predbipo]
 *
 * by Newton, condensed [eqnewt]: with A = dZ/dr and B = dZ/dv,
 *
 *     (A + B W) dr = -Z + B f,     dv = -f + W dr.
 *
 * The start is v = W r + b and f is linear, so f = 0 at every iterate, whatever the length of the
 * step: here v is W r + b from first to last, and the error rho |f| + |Z| is |Z|.
 */
#ifndef NSD_LOCAL_NEWTON_H
#define NSD_LOCAL_NEWTON_H

#include "local.h"

#define ALWAYS_INLINE __attribute__((always_inline)) static inline

static inline double norm2(const double a[2])
{
    return sqrt(a[0] * a[0] + a[1] * a[1]);
}
static inline double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static inline double norm3(const double a[3])
{
    return sqrt(dot3(a, a));
}

/* tau = r - rho (u + mu |u_t| n), of the bi-potential [uzawa1]; returns |u_t| */
static inline double cone_predict(double mu, double rho, const double r[3], const double u[3],
                                  double tau[3])
{
    double ut = norm2(u + 1);
    for (int i = 0; i < 3; i++) tau[i] = r[i] - rho * u[i];
    tau[0] -= rho * mu * ut;
    return ut;
}

/* tau = r - rho u, of the augmented Lagrangian [gradientAL] */
static inline void disc_predict(double rho, const double r[3], const double u[3], double tau[3])
{
    for (int i = 0; i < 3; i++) tau[i] = r[i] - rho * u[i];
}

/*
 * r = proj(tau, C), C = R+ x the disc of radius mu r_n. The paper prints r_t = mu r_n tau_t/|tau_t|
 * for every tau_t, with which no contact could stick; what is within the disc stays.
 */
static inline void disc_project(double mu, const double tau[3], double r[3])
{
    double t = norm2(tau + 1), rn = tau[0] > 0 ? tau[0] : 0;
    double s = t > mu * rn ? mu * rn / t : 1;
    r[0] = rn, r[1] = s * tau[1], r[2] = s * tau[2];
}

/* One iterate of the Newton, with what its derivatives will want again. */
struct iterate {
    double r[3], v[3];   /* N s, m/s */
    double tau[3], p[3]; /* p = proj(tau) */
    double Z[3];         /* r - p */
    double t, vt;        /* |tau_t|, |v_t| */
    enum local_status status;
};

typedef void newton_residual(double mu, double rho, struct iterate *);
typedef void newton_tangent(double mu, double rho, const struct iterate *, double A[3][3],
                            double B[3][3]);

/* Z, A, B and the branch at (r, v), for the tests [ebp_linearise, eal_linearise] */
ALWAYS_INLINE enum local_status newton_linearise(double mu, double rho, const double r[3],
                                                 const double v[3], newton_residual *residual,
                                                 newton_tangent *tangent, double Z[3],
                                                 double A[3][3], double B[3][3])
{
    struct iterate x = { .r = { r[0], r[1], r[2] }, .v = { v[0], v[1], v[2] } };
    residual(mu, rho, &x);
    tangent(mu, rho, &x, A, B);
    for (int i = 0; i < 3; i++) Z[i] = x.Z[i];
    return x.status;
}

/* M x = -y by cofactors; false when M is singular. */
static inline bool solve3(double M[3][3], const double y[3], double x[3])
{
    double c0 = M[1][1] * M[2][2] - M[1][2] * M[2][1];
    double c1 = M[1][2] * M[2][0] - M[1][0] * M[2][2];
    double c2 = M[1][0] * M[2][1] - M[1][1] * M[2][0];
    double det = M[0][0] * c0 + M[0][1] * c1 + M[0][2] * c2;
    if (!(fabs(det) > 0)) return false;
    double s = -1 / det;
    x[0] = s * (y[0] * c0 + y[1] * (M[0][2] * M[2][1] - M[0][1] * M[2][2]) +
                y[2] * (M[0][1] * M[1][2] - M[0][2] * M[1][1]));
    x[1] = s * (y[0] * c1 + y[1] * (M[0][0] * M[2][2] - M[0][2] * M[2][0]) +
                y[2] * (M[0][2] * M[1][0] - M[0][0] * M[1][2]));
    x[2] = s * (y[0] * c2 + y[1] * (M[0][1] * M[2][0] - M[0][0] * M[2][1]) +
                y[2] * (M[0][0] * M[1][1] - M[0][1] * M[1][0]));
    return true;
}

/* The Newton direction dr at x; false where the system is singular. */
ALWAYS_INLINE bool newton_direction(const struct local *l, const struct iterate *x,
                                    newton_tangent *tangent, bool diagonal, double dr[3])
{
    double A[3][3], B[3][3], M[3][3];
    if (x->status == LOCAL_FREE) { // A = I, B = 0; so v becomes b, not the paper's v^k
        for (int i = 0; i < 3; i++) dr[i] = -x->r[i];
        return true;
    }
    if (x->status == LOCAL_STICK) { // A = 0 and Z = B v, B regular: W dr = -v
        if (diagonal) {
            for (int i = 0; i < 3; i++) dr[i] = -x->v[i] / l->w[i];
            return true;
        }
        for (int i = 0; i < 9; i++) M[i / 3][i % 3] = l->W[i];
        return solve3(M, x->v, dr);
    }
    tangent(l->mu, l->rho, x, A, B);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            M[i][j] = diagonal ? A[i][j] + B[i][j] * l->w[j]
                               : A[i][j] + B[i][0] * l->W[j] + B[i][1] * l->W[3 + j] +
                                     B[i][2] * l->W[6 + j];
    return solve3(M, x->Z, dr);
}

/* r = x->r + s dr, and all that hangs on it */
ALWAYS_INLINE void newton_move(const struct local *l, const struct iterate *x, double s,
                               const double dr[3], newton_residual *residual, bool diagonal,
                               struct iterate *y)
{
    for (int i = 0; i < 3; i++) y->r[i] = x->r[i] + s * dr[i];
    for (int i = 0; i < 3; i++)
        y->v[i] = (diagonal ? l->w[i] * y->r[i] : dot3(l->W + 3 * i, y->r)) + l->b[i];
    residual(l->mu, l->rho, y);
}

/*
 * The Newton itself, at least one step; true when it ended. x is the last iterate, finite.
 *
 * The error is f's own [er_newt prints r - proj(r), which any r in the cone passes], and relative:
 * 1e-5 in the problem's own units, tested before the first step, freezes wrong contacts.
 *
 * Full steps, as the paper has it, cycle between stick and slide for some contacts and spoil the
 * sweep. Unless opt->plain the step is halved until |Z| shrinks; where it cannot, the Newton has
 * not ended.
 */
ALWAYS_INLINE bool newton_run(struct local *l, const struct local_opt *opt,
                              newton_residual *residual, newton_tangent *tangent, bool diagonal,
                              struct iterate *x)
{
    const double rho_b = l->rho * norm3(l->b);
    struct iterate y;
    for (int i = 0; i < 3; i++) x->r[i] = l->r[i];
    newton_move(l, x, 0, l->r, residual, diagonal, x);
    double z = norm3(x->Z);
    for (l->steps = 0; l->steps < opt->newton_max || l->steps == 0;) {
        double dr[3], s = 1;
        if (!newton_direction(l, x, tangent, diagonal, dr)) return false;
        l->steps++;
        for (;; s *= 0.5) {
            newton_move(l, x, s, dr, residual, diagonal, &y);
            double zy = norm3(y.Z);
            double end =
                opt->newton_abs > 0 ? opt->newton_abs : opt->newton_eps * (norm3(y.r) + rho_b);
            if (zy <= end) {
                *x = y;
                return true;
            }
            if (opt->plain ? isfinite(zy) : zy < z * (1 - 1e-4 * s)) {
                z = zy;
                break;
            }
            if (opt->plain || s < 1e-3) return false;
        }
        *x = y;
    }
    return false;
}

/* Solve with W diagonal or not, each its own code of this one text. */
ALWAYS_INLINE void newton_solve(struct local *l, const struct local_opt *opt,
                                newton_residual *residual, newton_tangent *tangent)
{
    struct iterate x;
    bool ended = l->W ? newton_run(l, opt, residual, tangent, false, &x)
                      : newton_run(l, opt, residual, tangent, true, &x);
    l->trouble = LOCAL_FINE;
    if (ended) { // proj(tau) is r to within the tolerance, and it is in the cone
        for (int i = 0; i < 3; i++) l->r[i] = x.p[i];
    } else if (opt->plain) {
        l->trouble = LOCAL_GAVE_UP;
        cone_project(l->mu, x.r, l->r);
    } else { // from the r we were given, so that the answer does not hang on how we failed
        int32_t steps = l->steps;
        local_exact.solve(l, opt);
        l->steps = steps;
        if (l->trouble == LOCAL_FINE) l->trouble = LOCAL_SAFEGUARDED;
        return;
    }
    local_velocity(l);
}

#endif
