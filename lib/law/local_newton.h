/*
 * law/local_newton.h: the Newton of EBP and EAL. They solve
 *
 *     f = v - b - W r = 0,     Z = r - proj(tau(r, v)) = 0     [locprob2, errorpred, predbipo]
 *
 * condensed [eqnewt]: with A = dZ/dr and B = dZ/dv,
 *
 *     (A + B W) dr = -Z + B f,     dv = -f + W dr.
 *
 * The start is v = W r + b and f is linear, so f = 0 at every iterate, whatever the length of the
 * step: here v is W r + b from first to last, and the error rho |f| + |Z| is |Z|. It is compared by
 * squares: roots and quotients are what costs here.
 */
#ifndef NSD_LOCAL_NEWTON_H
#define NSD_LOCAL_NEWTON_H

#include "law/local_exact.h"

/* One iterate of the Newton, with what its derivatives will want again. */
struct iterate {
    vd r[3], v[3];   /* N s, m/s */
    vd tau[3], p[3]; /* p = proj(tau) */
    vd Z[3];         /* r - p */
    vd t, vt;        /* |tau_t|, |v_t| */
    vm free, stick;  /* else it slides */
};

/* Z of (r, v) and the branch; A where it slides; B, of any A. */
typedef void newton_residual(vd mu, vd rho, struct iterate *);
typedef void newton_slide(vd mu, const struct iterate *, vd A[3][3]);
typedef void newton_chain(vd mu, vd rho, const struct iterate *, vd A[3][3], vd B[3][3]);

/*
 * The step of balls where they slide, in closed form: along n, e = tau_t/|tau_t| and q = n x e the
 * system with W = diag(w_n, w_t, w_t) falls apart into
 *
 *     (k + rho (1 - k) w_t) dr_q = -Z_q, where A q = k q,
 *     dr_e = mu dr_n - lag,     lag = Z_e - mu Z_n,
 *
 * and an equation for dr_n, which differs between the formulations as k does.
 */
struct slip {
    vd e[2], Z[3]; /* Z along n, e, q */
    vd lag, dn, dq;
};

/* dq and dn */
typedef void newton_slip(const struct local *, const struct iterate *, struct slip *);

/* One of the two formulations */
struct newton_text {
    newton_residual *residual;
    newton_slide *slide;
    newton_chain *chain;
    newton_slip *slip;
};

/* 1/x, 0 at 0: the quotients are the tangent's alone, for most contacts stick or are free */
ALWAYS_INLINE vd newton_inverse(vd x)
{
    return pick(lt(splat(0), x), 1.0 / x, splat(0));
}

ALWAYS_INLINE vd slip_across(const struct local *l, const struct slip *s, vd k)
{
    return -s->Z[2] / (k + l->rho * (1.0 - k) * l->w[1]);
}

/* tau_t = 0 slides at mu = 0 only, when any e is as good. */
ALWAYS_INLINE vm slip_direction(const struct local *l, const struct iterate *x, newton_slip *slip,
                                vd dr[3])
{
    struct slip s;
    vd inverse = newton_inverse(x->t);
    s.e[0] = pick(lt(splat(0), x->t), inverse * x->tau[1], splat(1)), s.e[1] = inverse * x->tau[2];
    s.Z[0] = x->Z[0];
    s.Z[1] = s.e[0] * x->Z[1] + s.e[1] * x->Z[2], s.Z[2] = s.e[0] * x->Z[2] - s.e[1] * x->Z[1];
    s.lag = s.Z[1] - l->mu * s.Z[0];
    slip(l, x, &s);
    vd de = l->mu * s.dn - s.lag;
    dr[0] = s.dn, dr[1] = s.e[0] * de - s.e[1] * s.dq, dr[2] = s.e[1] * de + s.e[0] * s.dq;
    return is_finite(s.dn + s.dq);
}

/*
 * The Newton direction dr at x; false where the system is singular. Without contact A = I, B = 0, so
 * dr = -r (and v becomes b, not the paper's v^k); sticking A = 0 and Z = B v, B regular: W dr = -v.
 */
ALWAYS_INLINE vm newton_direction(const struct local *l, const struct iterate *x,
                                  struct newton_text text, vd dr[3])
{
    vd A[3][3], B[3][3], M[3][3], stick[3], slip[3] = { 0 };
    vm regular = x->free, slide = ~(x->free | x->stick);
    if (l->W) {
        for (int i = 0; i < 9; i++) M[i / 3][i % 3] = l->W[i];
        regular |= x->stick & solve3(M, x->v, stick);
    } else {
        for (int i = 0; i < 3; i++) stick[i] = -x->v[i] * l->iw[i];
        regular |= x->stick;
    }
    if (any(slide) && !l->W) {
        regular |= slide & slip_direction(l, x, text.slip, slip);
    } else if (any(slide)) {
        text.slide(l->mu, x, A), text.chain(l->mu, l->rho, x, A, B);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                M[i][j] =
                    A[i][j] + B[i][0] * l->W[j] + B[i][1] * l->W[3 + j] + B[i][2] * l->W[6 + j];
        regular |= slide & solve3(M, x->Z, slip);
    }
    for (int i = 0; i < 3; i++) dr[i] = pick(x->free, -x->r[i], pick(x->stick, stick[i], slip[i]));
    return regular;
}

/* y at x->r + s dr, and all that hangs on it */
ALWAYS_INLINE void newton_move(const struct local *l, const vd r[3], vd s, const vd dr[3],
                               newton_residual *residual, struct iterate *y)
{
    for (int i = 0; i < 3; i++) y->r[i] = r[i] + s * dr[i];
    local_velocity(l, y->r, y->v);
    residual(l->mu, l->rho, y);
}

ALWAYS_INLINE void newton_take(struct iterate *x, const struct iterate *y, vm m)
{
    for (int i = 0; i < 3; i++) {
        x->r[i] = pick(m, y->r[i], x->r[i]), x->v[i] = pick(m, y->v[i], x->v[i]);
        x->tau[i] = pick(m, y->tau[i], x->tau[i]), x->Z[i] = pick(m, y->Z[i], x->Z[i]);
    }
    x->t = pick(m, y->t, x->t), x->vt = pick(m, y->vt, x->vt);
    x->free = (m & y->free) | (~m & x->free), x->stick = (m & y->stick) | (~m & x->stick);
}

/*
 * The Newton itself, at least one step; true where it ended. x is the last iterate, finite.
 *
 * The error is f's own [er_newt prints r - proj(r), which any r in the cone passes], and relative:
 * 1e-5 in the problem's own units, tested before the first step, freezes wrong contacts.
 *
 * Full steps, as the paper has it, cycle between stick and slide for some contacts and spoil the
 * sweep. Unless opt->plain the step is halved until |Z| shrinks; where it cannot, the Newton has
 * not ended. A lane that has ended, or cannot, keeps its x while the others go on.
 */
ALWAYS_INLINE vm newton_run(struct local *l, const struct local_opt *opt, struct newton_text text,
                            struct iterate *x)
{
    const vd rho_b2 = l->rho * l->rho * dot3(l->b, l->b);
    const double eps2 = opt->newton_eps * opt->newton_eps;
    struct iterate y = { 0 };
    vm ended = NONE, run = ~ended;
    for (int i = 0; i < 3; i++) x->r[i] = l->r[i], x->v[i] = l->v[i];
    text.residual(l->mu, l->rho, x);
    vd z2 = dot3(x->Z, x->Z);
    for (int k = 0; any(run) && (k == 0 || k < opt->newton_max); k++) {
        vd dr[3], s = splat(1);
        run &= newton_direction(l, x, text, dr);
        l->steps += pick(run, splat(1), splat(0));
        for (vm search = run; any(search); s *= 0.5) {
            newton_move(l, x->r, s, dr, text.residual, &y);
            vd y2 = dot3(y.Z, y.Z), end2 = eps2 * (dot3(y.r, y.r) + rho_b2), least = 1.0 - 1e-4 * s;
            if (opt->newton_abs > 0) end2 = splat(opt->newton_abs * opt->newton_abs);
            vm there = search & le(y2, end2);
            vm better = search & ~there & (opt->plain ? is_finite(y2) : lt(y2, z2 * least * least));
            for (int i = 0; i < 3; i++)
                x->p[i] = pick(there, y.p[i], x->p[i]); // all that is wanted
            if (any(better)) newton_take(x, &y, better);
            z2 = pick(better, y2, z2);
            search &= ~(there | better);
            vm lost = opt->plain ? search : search & lt(s, splat(1e-3));
            ended |= there, run &= ~(there | lost), search &= ~lost;
        }
    }
    return ended;
}

/* Where it ended proj(tau) is r to within the tolerance, and it is in the cone. */
ALWAYS_INLINE void newton_solve(struct local *l, const struct local_opt *opt,
                                struct newton_text text)
{
    struct iterate x = { 0 };
    local_begin(l);
    vm ended = newton_run(l, opt, text, &x);
    if (any(~ended)) {
        struct local stand_in =
            *l; // from the r we were given: the answer hangs not on how we failed
        if (opt->plain) {
            cone_project(l->mu, x.r, stand_in.r);
            l->gave_up = ~ended;
        } else {
            exact_solve(&stand_in, opt);
            l->gave_up = ~ended & stand_in.gave_up, l->safeguarded = ~ended & ~stand_in.gave_up;
        }
        for (int i = 0; i < 3; i++) x.p[i] = pick(ended, x.p[i], stand_in.r[i]);
    }
    for (int i = 0; i < 3; i++) l->r[i] = x.p[i];
}

/* Z, A, B and the branch at (r, v) [ebp_linearise, eal_linearise]: without contact A = I, sticking 0 */
ALWAYS_INLINE enum local_status newton_linearise(vd mu, vd rho, const vd r[3], const vd v[3],
                                                 struct newton_text text, vd Z[3], vd A[3][3],
                                                 vd B[3][3])
{
    struct iterate x = { .r = { r[0], r[1], r[2] }, .v = { v[0], v[1], v[2] } };
    text.residual(mu, rho, &x);
    text.slide(mu, &x, A);
    for (int i = 0; i < 3; i++) Z[i] = x.Z[i];
    for (int i = 0; i < 9; i++)
        A[i / 3][i % 3] = pick(x.free, splat(i % 4 == 0), pick(x.stick, splat(0), A[i / 3][i % 3]));
    text.chain(mu, rho, &x, A, B);
    return any(x.free) ? LOCAL_FREE : any(x.stick) ? LOCAL_STICK : LOCAL_SLIDE;
}

#endif
