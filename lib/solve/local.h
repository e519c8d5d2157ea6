/*
 * solve/local.h: the seam between the sweep and the five local methods.
 *
 * One contact's problem, the others held still: find (u, r) with
 *
 *     u = W r + b,     (u, r) on Signorini's condition and Coulomb's law,
 *
 * components (n, t1, t2); u_n >= 0 separates, r_n >= 0 pushes. W, b and u already contain Newton's
 * impact law: they are the paper's W~_cc and u~ [newtonlaw]. r is an impulse. A struct local is
 * LANES such problems side by side, plain numbers where LANES is 1; one text of a method serves
 * both.
 *
 * In the plane (d = 2) component 2 of b, r and u is zero, and the third row and column of W are
 * zero but for a positive W[2][2]. The formulas of space then give those of the plane, so each
 * method is written once. Only the exact solution, which searches directions, looks at d.
 */
#ifndef NSD_LOCAL_H
#define NSD_LOCAL_H

#include "base/lanes.h"

#include <stddef.h>

enum local_status { LOCAL_FREE, LOCAL_STICK, LOCAL_SLIDE };

struct local {
    int d;       /* 2 or 3 */
    const vd *W; /* [9], row-major, kg^-1; NULL: diagonal, w[1] = w[2] */
    vd w[3];     /* the diagonal of W, kg^-1 */
    vd iw[3];    /* kg: 1/w where W is NULL */
    vd b[3];     /* m/s: velocity without this contact's own reaction */
    vd v[3];     /* m/s: velocity with the reaction of the last sweep, W r + b */
    vd mu;
    vd rho;         /* kg: step of the projection */
    vd r[3];        /* N s; in: of the last sweep, out: of this one; u = W r + b follows */
    double relax;   /* in: omega of exact where W is NULL */
    vd steps;       /* out: Newton steps taken; 0 for methods without a Newton */
    vm safeguarded; /* out: Newton did not converge; r is the exact solution instead */
    vm gave_up;     /* out: (u, r) does not satisfy the law; r is in the cone all the same */
#ifdef ON_DEVICE
    struct search *search; /* exact_search() is not there: what it is asked, or its answer */
#endif
};

struct local_opt {
    bool plain; /* as the paper: full Newton steps, no line search, no exact solution instead */
    double newton_eps; /* stop at |Z|^2 <= newton_eps^2 (|r|^2 + rho^2 |b|^2) */
    double newton_abs; /* N s; > 0: stop at |Z| <= newton_abs instead [er_newt of the paper, which
                          is an impulse of newton_eps dt] */
    int newton_max;    /* steps at most */
};

/* Where r is in its cone, for reports: FREE at r_n <= 0, SLIDE on the mantle to 1e-9, relative. */
static inline enum local_status local_status(double mu, const double r[3])
{
    if (r[0] <= 0) return LOCAL_FREE;
    double t = sqrt(r[1] * r[1] + r[2] * r[2]);
    return t < mu * r[0] * (1 - 1e-9) ? LOCAL_STICK : LOCAL_SLIDE;
}

/* The largest eigenvalue of the symmetric part of W[9] (row-major; kg^-1). */
double local_lambda_max(const double W[9]);

/* ---- what the methods share ---- */

ALWAYS_INLINE vd dot2(const vd a[2], const vd b[2])
{
    return a[0] * b[0] + a[1] * b[1];
}
ALWAYS_INLINE vd norm2(const vd a[2])
{
    return root(dot2(a, a));
}
ALWAYS_INLINE vd dot3(const vd a[3], const vd b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
ALWAYS_INLINE vd norm3(const vd a[3])
{
    return root(dot3(a, a));
}

/* Nothing to report yet. */
ALWAYS_INLINE void local_clear_report(struct local *l)
{
    l->steps = splat(0), l->safeguarded = l->gave_up = NONE;
}

/* out = W r + b */
ALWAYS_INLINE void local_velocity(const struct local *l, const vd r[3], vd out[3])
{
    for (int i = 0; i < 3; i++) out[i] = (l->W ? dot3(l->W + 3 * i, r) : l->w[i] * r[i]) + l->b[i];
}

/*
 * r = the orthogonal projection of tau on K_mu = { |r_t| <= mu r_n } [paper, first and second
 * case]: the tip where tau is in the polar cone, tau where it is inside, else the nearest mantle
 * point.
 */
ALWAYS_INLINE void cone_project(vd mu, const vd tau[3], vd r[3])
{
    vd n = tau[0], t2 = dot2(tau + 1, tau + 1), t = root(t2);
    vm tip = le(n, splat(0)) & le(mu * mu * t2, n * n);
    vm in = le(splat(0), n) & le(t2, mu * mu * (n * n));
    vd rn = (n + mu * t) * (1.0 / (1.0 + mu * mu)), s = mu * rn * (1.0 / t);
    rn = pick(in, n, rn), s = pick(in, splat(1), s);
    r[0] = pick(tip, splat(0), rn);
    for (int k = 1; k < 3; k++) r[k] = pick(tip, splat(0), s * tau[k]);
}

/* tau = r - rho (u + mu |u_t| n), the prediction of the bi-potential [uzawa1]; returns |u_t|. */
ALWAYS_INLINE vd cone_predict(vd mu, vd rho, const vd r[3], const vd u[3], vd tau[3])
{
    vd ut = norm2(u + 1);
    for (int i = 0; i < 3; i++) tau[i] = r[i] - rho * u[i];
    tau[0] -= rho * mu * ut;
    return ut;
}

/* tau = r - rho u, the prediction of the augmented Lagrangian [gradientAL] */
ALWAYS_INLINE void disc_predict(vd rho, const vd r[3], const vd u[3], vd tau[3])
{
    for (int i = 0; i < 3; i++) tau[i] = r[i] - rho * u[i];
}

/*
 * r = proj(tau, C), C = R+ x the disc of radius mu r_n. Against the paper, which prints
 * r_t = mu r_n tau_t/|tau_t| for every tau_t: tau_t within the disc is kept, else nothing could
 * stick.
 */
ALWAYS_INLINE void disc_project(vd mu, const vd tau[3], vd r[3])
{
    vd rn = larger(tau[0], splat(0)), most = mu * rn, t2 = dot2(tau + 1, tau + 1);
    vd s = pick(lt(most * most, t2), most / root(t2), splat(1));
    r[0] = rn, r[1] = s * tau[1], r[2] = s * tau[2];
}

#endif
