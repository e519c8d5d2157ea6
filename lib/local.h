/*
 * local.h: the seam between the sweep and the five local methods.
 *
 * One contact's problem, the others held still: find (u, r) with
 *
 *     u = W r + b,     (u, r) on Signorini's condition and Coulomb's law,
 *
 * components (n, t1, t2); u_n >= 0 separates, r_n >= 0 pushes. W, b and u already carry Newton's
 * impact law: they are the paper's W~_cc and u~ (newtonlaw). r is an impulse.
 *
 * In the plane (d = 2) component 2 of b, r and u is zero and W has a zero third row and column but
 * for a positive W[2][2]: the formulas of space then are those of the plane, and each method stands
 * once. Only the exact solution, which searches directions, looks at d.
 */
#ifndef NSD_LOCAL_H
#define NSD_LOCAL_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum local_status { LOCAL_FREE, LOCAL_STICK, LOCAL_SLIDE };

enum local_trouble {
    LOCAL_FINE,
    LOCAL_SAFEGUARDED, /* the Newton did not end; the exact solution stands in */
    LOCAL_GAVE_UP      /* (u, r) is not on the law; r is in the cone all the same */
};

struct local {
    int d;           /* 2 or 3 */
    const double *W; /* [9], row-major, kg^-1; NULL: diagonal, w[1] = w[2] */
    double w[3];     /* the diagonal of W, kg^-1 */
    double b[3];     /* m/s: velocity without this contact's own reaction */
    double mu;
    double rho;                 /* kg: step of the projection */
    double r[3];                /* N s; in: the last sweep's, out: this one's */
    double u[3];                /* m/s; out: W r + b, as the method believes it */
    int32_t steps;              /* out: Newton steps taken, 0 where there is none */
    enum local_trouble trouble; /* out */
};

struct local_opt {
    bool plain;        /* full Newton steps, no line search and no stand-in, as the paper has it */
    double newton_eps; /* stop at rho |f| + |Z| <= newton_eps (|r| + rho |b|) */
    double newton_abs; /* > 0: stop at |f| + |Z| <= newton_abs instead, in the problem's own units
                          [er_newt of the paper: an impulse of newton_eps dt there] */
    int newton_max;    /* steps */
};

struct method {
    const char *name, *help;
    double rho;    /* default rho = this / lambda_max(W_cc) */
    bool believes; /* u is the method's own; else the motion's (SBP, SAL), and it may stay unset */
    void (*solve)(struct local *, const struct local_opt *);
};

/* sbp, sal, ebp, eal, exact; NULL ends it. */
extern const struct method *const methods[];
extern const struct method local_sbp, local_sal, local_ebp, local_eal, local_exact;
const struct method *method_find(const char *name); /* NULL when there is none */

/* u = W r + b */
static inline void local_velocity(struct local *l)
{
    if (!l->W) {
        for (int i = 0; i < 3; i++) l->u[i] = l->w[i] * l->r[i] + l->b[i];
        return;
    }
    for (int i = 0; i < 3; i++) {
        const double *W = l->W + 3 * i;
        l->u[i] = W[0] * l->r[0] + W[1] * l->r[1] + W[2] * l->r[2] + l->b[i];
    }
}

/*
 * r = proj(tau, K_mu), orthogonal, K_mu = { |r_t| <= mu r_n } [paper, first and second case]. The
 * cases are told by squares: the root is slow, and wanted on the mantle only.
 */
static inline void cone_project(double mu, const double tau[3], double r[3])
{
    double t2 = tau[1] * tau[1] + tau[2] * tau[2], n = tau[0];
    if (n <= 0 && mu * mu * t2 <= n * n) { // in the polar cone: its tip
        r[0] = r[1] = r[2] = 0;
        return;
    }
    if (n >= 0 && t2 <= mu * mu * (n * n)) { // inside: itself
        r[0] = n, r[1] = tau[1], r[2] = tau[2];
        return;
    }
    double t = sqrt(t2), rn = (n + mu * t) / (1 + mu * mu), s = mu * rn / t;
    r[0] = rn, r[1] = s * tau[1], r[2] = s * tau[2];
}

/* Where r stands on its cone, for reports: FREE at r_n = 0, SLIDE on the mantle to 1e-9. */
static inline enum local_status local_status(double mu, const double r[3])
{
    if (r[0] <= 0) return LOCAL_FREE;
    double t = sqrt(r[1] * r[1] + r[2] * r[2]);
    return t < mu * r[0] * (1 - 1e-9) ? LOCAL_STICK : LOCAL_SLIDE;
}

/* The largest eigenvalue of the symmetric part of W[9]. */
double local_lambda_max(const double W[9]);

/*
 * Z and its derivatives A = dZ/dr, B = dZ/dv at (r, v), for the Newton of EBP and EAL [errorpred,
 * predbipo; corrected]; returns the branch taken. Public so that the tests can differentiate them.
 */
enum local_status ebp_linearise(double mu, double rho, const double r[3], const double v[3],
                                double Z[3], double A[3][3], double B[3][3]);
enum local_status eal_linearise(double mu, double rho, const double r[3], const double v[3],
                                double Z[3], double A[3][3], double B[3][3]);

#endif
