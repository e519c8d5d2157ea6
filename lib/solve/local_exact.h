/*
 * solve/local_exact.h: the one-contact problem solved directly, case by case of the law.
 *
 *     take-off  b_n >= 0:                         r = 0
 *     stick     W r = -b with r in the cone:      u = 0
 *     slide     r = r_n (n + mu d), |d| = 1:      u_n = 0, u_t = -lambda d, lambda >= 0
 *
 * For balls W = diag(w_n, w_t, w_t) and the three are one closed form: the projection on the disc
 * of tau = -W^-1 b = r - W^-1 v.
 *
 * With a general W the sliding direction d is searched for. With a = W_nn + mu W_nt.d, u_n = 0
 * gives r_n = -b_n/a, and the tangential velocity times a is
 *
 *     h = a u_t = p + Q d,     p = W_nn b_t - b_n W_tn,     Q = mu (b_t W_nt - b_n W_tt).
 *
 * The solutions are the d with g(d) = d x h = 0, h.d <= 0 and a > 0.
 *
 * The paper has no such method. It also replaces a Newton that does not converge [local_newton.h].
 */
#ifndef NSD_LOCAL_EXACT_H
#define NSD_LOCAL_EXACT_H

#include "solve/local_sbp.h"

/*
 * One lane for which exact_stick() and exact_slide() give no solution: W is singular, or there are
 * several directions to slide in. r[3] in: of the last sweep; out: the solution. False where there
 * is none.
 */
bool exact_search(int d, const double W[9], const double b[3], double mu, bool singular,
                  double r[3]);

/* M x = -y by cofactors; false where M is singular. */
ALWAYS_INLINE vm solve3(vd M[3][3], const vd y[3], vd x[3])
{
    vd c0 = M[1][1] * M[2][2] - M[1][2] * M[2][1];
    vd c1 = M[1][2] * M[2][0] - M[1][0] * M[2][2];
    vd c2 = M[1][0] * M[2][1] - M[1][1] * M[2][0];
    vd det = M[0][0] * c0 + M[0][1] * c1 + M[0][2] * c2, s = -1.0 / det;
    x[0] = s * (y[0] * c0 + y[1] * (M[0][2] * M[2][1] - M[0][1] * M[2][2]) +
                y[2] * (M[0][1] * M[1][2] - M[0][2] * M[1][1]));
    x[1] = s * (y[0] * c1 + y[1] * (M[0][0] * M[2][2] - M[0][2] * M[2][0]) +
                y[2] * (M[0][2] * M[1][0] - M[0][0] * M[1][2]));
    x[2] = s * (y[0] * c2 + y[1] * (M[0][1] * M[2][0] - M[0][0] * M[2][1]) +
                y[2] * (M[0][0] * M[1][1] - M[0][1] * M[1][0]));
    return lt(splat(0), absolute(det));
}

/* The projection of r - omega W^-1 v, which stops the contact when omega = 1; where it is finite */
ALWAYS_INLINE vm exact_balls(const struct local *l, vd r[3])
{
    vd tau[3];
    for (int i = 0; i < 3; i++) tau[i] = l->r[i] - l->v[i] * (l->relax * l->iw[i]);
    disc_project(l->mu, tau, r);
    return lt(splat(0), l->w[0]) & is_finite(tau[0] + tau[1] + tau[2]);
}

/* ---- a general W ---- */

/* u = W r + b; where it is zero to rounding */
ALWAYS_INLINE vm exact_stopped(const struct local *l, const vd r[3], vd u[3])
{
    local_velocity(l, r, u);
    return le(dot3(u, u), 1e-20 * dot3(l->b, l->b));
}

/* Solves W r = -b and refines r once, as cofactors leave an error; where W is regular */
ALWAYS_INLINE vm exact_stick(const struct local *l, vd r[3])
{
    vd M[3][3], u[3], dr[3];
    for (int i = 0; i < 9; i++) M[i / 3][i % 3] = l->W[i];
    vm regular = solve3(M, l->b, r);
    exact_stopped(l, r, u);
    solve3(M, u, dr);
    for (int i = 0; i < 3; i++) r[i] += dr[i];
    regular &= exact_stopped(l, r, u);
    if (l->d == 2) r[2] = splat(0);
    return regular;
}

/* Sliding along d: h = a u_t = p + Q d */
struct slide {
    vd Wnn, mWnt[2]; /* a = Wnn + mWnt.d */
    vd p[2], Q[2][2];
    vd scale; /* of h, for tolerances */
};

ALWAYS_INLINE void slide_init(struct slide *k, const struct local *l)
{
    const vd *W = l->W, *b = l->b, mu = l->mu;
    k->Wnn = W[0], k->scale = splat(0);
    for (int i = 0; i < 2; i++) {
        k->mWnt[i] = mu * W[1 + i];
        k->p[i] = W[0] * b[1 + i] - b[0] * W[3 + 3 * i];
        k->scale += absolute(W[0] * b[1 + i]) + absolute(b[0] * W[3 + 3 * i]);
        for (int j = 0; j < 2; j++) {
            k->Q[i][j] = mu * (b[1 + i] * W[1 + j] - b[0] * W[4 + 3 * i + j]);
            k->scale += mu * (absolute(b[1 + i] * W[1 + j]) + absolute(b[0] * W[4 + 3 * i + j]));
        }
    }
}

/* g(d) = d x h; also h.d and the derivative of g by the angle of d */
ALWAYS_INLINE vd slide_g(const struct slide *k, const vd d[2], vd *hd, vd *dg)
{
    vd h1 = k->p[0] + k->Q[0][0] * d[0] + k->Q[0][1] * d[1];
    vd h2 = k->p[1] + k->Q[1][0] * d[0] + k->Q[1][1] * d[1];
    *hd = d[0] * h1 + d[1] * h2;
    *dg = d[0] * (k->Q[1][1] * d[0] - k->Q[1][0] * d[1]) -
          d[1] * (k->Q[0][1] * d[0] - k->Q[0][0] * d[1]) - *hd;
    return d[0] * h2 - d[1] * h1;
}

ALWAYS_INLINE void slide_turn(vd d[2], vd tangent)
{
    vd x = d[0] - tangent * d[1], y = d[1] + tangent * d[0], s = 1.0 / root(x * x + y * y);
    d[0] = s * x, d[1] = s * y;
}

/* Newton on the angle of d for g = 0, at most `steps` steps, in the lanes m. */
ALWAYS_INLINE void slide_polish(const struct slide *k, vd d[2], int steps, vm m)
{
    for (; steps > 0 && any(m); steps--) {
        vd hd, dg, g = slide_g(k, d, &hd, &dg), e[2] = { d[0], d[1] };
        m &= lt(splat(0), absolute(g)) & lt(splat(0), absolute(dg));
        vd change = -larger(-larger(-g / dg, splat(-1)), splat(-1));
        slide_turn(e, change);
        for (int i = 0; i < 2; i++) d[i] = pick(m, e[i], d[i]);
        m &= lt(splat(1e-9), absolute(change));
    }
}

/* Where d is a solution to rounding; r = its reaction */
ALWAYS_INLINE vm slide_accept(const struct local *l, const struct slide *k, const vd d[2], vd r[3])
{
    vd hd, dg, g = slide_g(k, d, &hd, &dg), a = k->Wnn + k->mWnt[0] * d[0] + k->mWnt[1] * d[1];
    r[0] = -l->b[0] / a, r[1] = l->mu * r[0] * d[0], r[2] = l->mu * r[0] * d[1];
    return le(absolute(g), 1e-12 * k->scale) & le(hd, 1e-12 * k->scale) & lt(splat(0), a) &
           is_finite(r[0]) & is_finite(r[1] + r[2]);
}

/* In the plane d is t1 or -t1; of two solutions the one nearer to the last sweep's r. */
ALWAYS_INLINE vm exact_slide_plane(const struct local *l, const struct slide *k, vd r[3])
{
    const vd t1[2] = { splat(1), splat(0) }, back[2] = { splat(-1), splat(0) };
    vd s[3], far[2] = { splat(0), splat(0) };
    vm one = slide_accept(l, k, t1, r), other = slide_accept(l, k, back, s);
    for (int j = 0; j < 3; j++) {
        far[0] += (r[j] - l->r[j]) * (r[j] - l->r[j]);
        far[1] += (s[j] - l->r[j]) * (s[j] - l->r[j]);
    }
    vm second = other & (~one | lt(far[1], far[0]));
    for (int j = 0; j < 3; j++) r[j] = pick(second, s[j], r[j]);
    return one | other;
}

/* The root that Newton finds from the last sweep's direction, in the lanes m. */
ALWAYS_INLINE vm exact_slide(const struct local *l, vm m, vd r[3])
{
    struct slide k;
    vd t = norm2(l->r + 1), tb = norm2(l->b + 1), d[2];
    slide_init(&k, l);
    if (l->d == 2) return m & exact_slide_plane(l, &k, r);
    for (int i = 0; i < 2; i++)
        d[i] = pick(lt(splat(0), t), l->r[1 + i] / t,
                    pick(lt(splat(0), tb), -l->b[1 + i] / tb, splat(1 - i)));
    slide_polish(&k, d, 8, m);
    return m & slide_accept(l, &k, d, r);
}

/* Lane i of x */
ALWAYS_INLINE double lane(vd x, int i)
{
    double all[LANES];
    vstore(all, x);
    return all[i];
}

/* exact_search() lane by lane, in the lanes m; where it finds a solution */
#ifdef ON_DEVICE
ALWAYS_INLINE vm exact_search_lanes(const struct local *l, vm m, vm singular, vd r[3]);
#else
ALWAYS_INLINE vm exact_search_lanes(const struct local *l, vm m, vm singular, vd r[3])
{
    double found[LANES], x[3][LANES];
    for (int j = 0; j < 3; j++) vstore(x[j], r[j]);
    for (int i = 0; i < LANES; i++) {
        found[i] = 0;
        if (lane(pick(m, splat(1), splat(0)), i) == 0) continue;
        double W[9], b[3], s[3];
        for (int j = 0; j < 9; j++) W[j] = lane(l->W[j], i);
        for (int j = 0; j < 3; j++) b[j] = lane(l->b[j], i), s[j] = lane(l->r[j], i);
        bool is_singular = lane(pick(singular, splat(1), splat(0)), i) != 0;
        found[i] = exact_search(l->d, W, b, lane(l->mu, i), is_singular, s);
        for (int j = 0; j < 3; j++) x[j][i] = s[j];
    }
    for (int j = 0; j < 3; j++) r[j] = vload(x[j]);
    return lt(splat(0), vload(found));
}
#endif

/* Take-off, no friction, stick, slide, else the search; where there is a solution */
ALWAYS_INLINE vm exact_general(const struct local *l, vd r[3])
{
    vd rn = -l->b[0] / l->W[0], slid[3] = { 0 };
    vm open = ~lt(l->b[0], splat(0)), m = ~open;
    vm smooth = le(l->mu, splat(0)), regular = exact_stick(l, r);
    vm stuck = regular & le(norm2(r + 1), l->mu * r[0]) & ~smooth;
    vm slides = m & ~smooth & ~stuck & regular;
    if (any(slides)) slides = exact_slide(l, slides, slid);
    for (int j = 0; j < 3; j++) {
        r[j] = pick(slides, slid[j], r[j]);
        r[j] = pick(smooth, j == 0 ? rn : splat(0), r[j]);
    }
    vm found = stuck | slides | (smooth & lt(splat(0), l->W[0]) & is_finite(rn));
    vm rest = m & ~found & ~smooth;
    if (any(rest)) found |= exact_search_lanes(l, rest, ~regular, r);
    for (int j = 0; j < 3; j++) r[j] = pick(open, splat(0), r[j]);
    return found | open;
}

/* Where there is no solution (W indefinite or singular): one SBP step from the last sweep's r. */
ALWAYS_INLINE void exact_solve(struct local *l, const struct local_opt *opt)
{
    vd r[3];
    vm found = l->W ? exact_general(l, r) : exact_balls(l, r);
    local_clear_report(l);
    if (!all(found)) {
        struct local step = *l;
        sbp_solve(&step, opt);
        vm open = ~lt(l->b[0], splat(0)), sound = is_finite(step.r[0] + step.r[1] + step.r[2]);
        for (int k = 0; k < 3; k++)
            r[k] = pick(found, r[k], pick(sound & ~open, step.r[k], splat(0)));
        l->gave_up = ~(found | open);
    }
    for (int k = 0; k < 3; k++) l->r[k] = r[k];
}

#endif
