/*
 * solve/local_newton.h: the Newton of EBP and EAL. They solve
 *
 *     f = v - b - W r = 0,     Z = r - proj(tau(r, v)) = 0     [locprob2, errorpred, predbipo]
 *
 * condensed [eqnewt]: with A = dZ/dr and B = dZ/dv,
 *
 *     (A + B W) dr = -Z + B f,     dv = -f + W dr.
 *
 * It starts at v = W r + b and f is linear, so f = 0 at every iterate whatever the length of the
 * step: v is W r + b throughout, and the error rho |f| + |Z| is |Z|. Squares of it are compared,
 * because roots and divisions are what takes time here.
 */
#ifndef NSD_LOCAL_NEWTON_H
#define NSD_LOCAL_NEWTON_H

#include "solve/local_exact.h"

/* One iterate of the Newton, with what its derivatives use again */
struct newton_point {
    vd r[3], v[3];   /* N s, m/s */
    vd tau[3], p[3]; /* p = proj(tau) */
    vd Z[3];         /* r - p */
    vd t, vt;        /* |tau_t|, |v_t| */
    vm free, stick;  /* else it slides */
};

/*
 * The step of balls where they slide, in closed form: along n, e = tau_t/|tau_t| and q = n x e the
 * system with W = diag(w_n, w_t, w_t) decouples into
 *
 *     (k + rho (1 - k) w_t) dr_q = -Z_q, where A q = k q,
 *     dr_e = mu dr_n - lag,     lag = Z_e - mu Z_n,
 *
 * and an equation for dr_n. That and k differ between the two formulations.
 */
struct slip {
    vd e[2], Z[3];  /* Z along n, e, q */
    vd lag, dn, dq; /* as above; dr_n, dr_q */
};

/* The two formulations, a constant of every call: no pointers to functions, which OpenCL C does not have */
enum newton_formulation { EBP, EAL };

/* What they differ in is in local_ebp.h and local_eal.h: */
/* tau, p, Z and the branch of x->r, x->v; */
ALWAYS_INLINE void ebp_residual(vd mu, vd rho, struct newton_point *x);
ALWAYS_INLINE void eal_residual(vd mu, vd rho, struct newton_point *x);
/* A where it slides; */
ALWAYS_INLINE void ebp_slide(vd mu, const struct newton_point *x, vd A[3][3]);
ALWAYS_INLINE void eal_slide(vd mu, const struct newton_point *x, vd A[3][3]);
/* B for any A; */
ALWAYS_INLINE void ebp_chain(vd mu, vd rho, const struct newton_point *x, vd A[3][3], vd B[3][3]);
ALWAYS_INLINE void eal_chain(vd mu, vd rho, const struct newton_point *x, vd A[3][3], vd B[3][3]);
/* s->dq and s->dn */
ALWAYS_INLINE void ebp_slip(const struct local *l, const struct newton_point *x, struct slip *s);
ALWAYS_INLINE void eal_slip(const struct local *l, const struct newton_point *x, struct slip *s);

/* form's own function of that name */
#define BY_FORMULATION(form, what, ...)                                                            \
    ((form) == EBP ? ebp_##what(__VA_ARGS__) : eal_##what(__VA_ARGS__))

/* 1/x, and 0 at x = 0 */
ALWAYS_INLINE vd newton_inverse(vd x)
{
    return pick(lt(splat(0), x), 1.0 / x, splat(0));
}

/* dr_q */
ALWAYS_INLINE vd slip_across(const struct local *l, const struct slip *s, vd k)
{
    return -s->Z[2] / (k + l->rho * (1.0 - k) * l->w[1]);
}

/* dr = the step of a sliding ball. tau_t = 0 slides only when mu = 0; any e will do there. */
ALWAYS_INLINE vm slip_direction(const struct local *l, const struct newton_point *x,
                                enum newton_formulation form, vd dr[3])
{
    struct slip s = { .Z = { x->Z[0] } };
    vd inverse = newton_inverse(x->t);
    s.e[0] = pick(lt(splat(0), x->t), inverse * x->tau[1], splat(1)), s.e[1] = inverse * x->tau[2];
    s.Z[1] = s.e[0] * x->Z[1] + s.e[1] * x->Z[2], s.Z[2] = s.e[0] * x->Z[2] - s.e[1] * x->Z[1];
    s.lag = s.Z[1] - l->mu * s.Z[0];
    BY_FORMULATION(form, slip, l, x, &s);
    vd de = l->mu * s.dn - s.lag;
    dr[0] = s.dn, dr[1] = s.e[0] * de - s.e[1] * s.dq, dr[2] = s.e[1] * de + s.e[0] * s.dq;
    return is_finite(s.dn + s.dq);
}

/*
 * The Newton direction dr at x; false where the system is singular. Free: A = I, B = 0, so dr = -r
 * (and v becomes b, not the paper's v^k). Sticking: A = 0 and Z = B v, B regular, so W dr = -v.
 */
ALWAYS_INLINE vm newton_direction(const struct local *l, const struct newton_point *x,
                                  enum newton_formulation form, vd dr[3])
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
        regular |= slide & slip_direction(l, x, form, slip);
    } else if (any(slide)) {
        BY_FORMULATION(form, slide, l->mu, x, A);
        BY_FORMULATION(form, chain, l->mu, l->rho, x, A, B);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                M[i][j] =
                    A[i][j] + B[i][0] * l->W[j] + B[i][1] * l->W[3 + j] + B[i][2] * l->W[6 + j];
        regular |= slide & solve3(M, x->Z, slip);
    }
    for (int i = 0; i < 3; i++) dr[i] = pick(x->free, -x->r[i], pick(x->stick, stick[i], slip[i]));
    return regular;
}

/* y = the iterate at r + s dr */
ALWAYS_INLINE void newton_move(const struct local *l, const vd r[3], vd s, const vd dr[3],
                               enum newton_formulation form, struct newton_point *y)
{
    for (int i = 0; i < 3; i++) y->r[i] = r[i] + s * dr[i];
    local_velocity(l, y->r, y->v);
    BY_FORMULATION(form, residual, l->mu, l->rho, y);
}

/* x = y in the lanes m, but for p */
ALWAYS_INLINE void newton_accept(struct newton_point *x, const struct newton_point *y, vm m)
{
    for (int i = 0; i < 3; i++) {
        x->r[i] = pick(m, y->r[i], x->r[i]), x->v[i] = pick(m, y->v[i], x->v[i]);
        x->tau[i] = pick(m, y->tau[i], x->tau[i]), x->Z[i] = pick(m, y->Z[i], x->Z[i]);
    }
    x->t = pick(m, y->t, x->t), x->vt = pick(m, y->vt, x->vt);
    x->free = (m & y->free) | (~m & x->free), x->stick = (m & y->stick) | (~m & x->stick);
}

/*
 * The Newton itself, at least one step; true where it converged. x is the last iterate, finite.
 *
 * The error is |Z| [er_newt prints r - proj(r), which is 0 for any r in the cone], relative unless
 * opt->newton_abs, and not tested before the first step: an absolute 1e-5 tested there freezes
 * wrong contacts.
 *
 * Full steps, as in the paper, cycle between stick and slide at some contacts, and the sweep then
 * suffers. Unless opt->plain, a step is halved until |Z| shrinks; where it does not, the Newton has
 * failed. A lane that has converged or failed keeps its x while the others go on.
 */
ALWAYS_INLINE vm newton_run(struct local *l, const struct local_opt *opt,
                            enum newton_formulation form, struct newton_point *x)
{
    const vd rho_b2 = l->rho * l->rho * dot3(l->b, l->b);
    const double eps2 = opt->newton_eps * opt->newton_eps;
    struct newton_point y = { 0 };
    vm converged = NONE, run = ~converged;
    for (int i = 0; i < 3; i++) x->r[i] = l->r[i], x->v[i] = l->v[i];
    BY_FORMULATION(form, residual, l->mu, l->rho, x);
    vd z2 = dot3(x->Z, x->Z);
    for (int k = 0; any(run) && (k == 0 || k < opt->newton_max); k++) {
        vd dr[3], s = splat(1);
        run &= newton_direction(l, x, form, dr);
        l->steps += pick(run, splat(1), splat(0));
        for (vm search = run; any(search); s *= 0.5) {
            newton_move(l, x->r, s, dr, form, &y);
            vd y2 = dot3(y.Z, y.Z), end2 = eps2 * (dot3(y.r, y.r) + rho_b2), least = 1.0 - 1e-4 * s;
            if (opt->newton_abs > 0) end2 = splat(opt->newton_abs * opt->newton_abs);
            vm done = search & le(y2, end2);
            vm better = search & ~done & (opt->plain ? is_finite(y2) : lt(y2, z2 * least * least));
            for (int i = 0; i < 3; i++)
                x->p[i] = pick(done, y.p[i], x->p[i]); // the result; nothing else of y is used
            if (any(better)) newton_accept(x, &y, better);
            z2 = pick(better, y2, z2);
            search &= ~(done | better);
            vm lost = opt->plain ? search : search & lt(s, splat(1e-3));
            converged |= done, run &= ~(done | lost), search &= ~lost;
        }
    }
    return converged;
}

/* l->r = proj(tau): it is in the cone and, where Newton converged, equal to r to the tolerance. */
ALWAYS_INLINE void newton_solve(struct local *l, const struct local_opt *opt,
                                enum newton_formulation form)
{
    struct newton_point x = { 0 };
    local_clear_report(l);
    vm converged = newton_run(l, opt, form, &x);
    if (any(~converged)) {
        // from the given r, so that the answer does not depend on where Newton failed
        struct local exact = *l;
        if (opt->plain) {
            cone_project(l->mu, x.r, exact.r);
            l->gave_up = ~converged;
        } else {
            exact_solve(&exact, opt);
            l->gave_up = ~converged & exact.gave_up, l->safeguarded = ~converged & ~exact.gave_up;
        }
        for (int i = 0; i < 3; i++) x.p[i] = pick(converged, x.p[i], exact.r[i]);
    }
    for (int i = 0; i < 3; i++) l->r[i] = x.p[i];
}

/* Z, A, B and the branch at (r, v), as eal_linearise() has them: free A = I, sticking 0 */
ALWAYS_INLINE enum local_status newton_linearise(vd mu, vd rho, const vd r[3], const vd v[3],
                                                 enum newton_formulation form, vd Z[3], vd A[3][3],
                                                 vd B[3][3])
{
    struct newton_point x = { .r = { r[0], r[1], r[2] }, .v = { v[0], v[1], v[2] } };
    BY_FORMULATION(form, residual, mu, rho, &x);
    BY_FORMULATION(form, slide, mu, &x, A);
    for (int i = 0; i < 3; i++) Z[i] = x.Z[i];
    for (int i = 0; i < 9; i++)
        A[i / 3][i % 3] = pick(x.free, splat(i % 4 == 0), pick(x.stick, splat(0), A[i / 3][i % 3]));
    BY_FORMULATION(form, chain, mu, rho, &x, A, B);
    return any(x.free) ? LOCAL_FREE : any(x.stick) ? LOCAL_STICK : LOCAL_SLIDE;
}

#endif
