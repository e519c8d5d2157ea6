/*
 * local_exact.h: the one-contact problem solved outright, case by case of the law.
 *
 *     take-off  b_n >= 0:                         r = 0
 *     stick     W r = -b with r in the cone:      u = 0
 *     slide     r = r_n (n + mu d), |d| = 1:      u_n = 0, u_t = -lambda d, lambda >= 0
 *
 * For balls W = diag(w_n, w_t, w_t) and the three are one closed form: r_n = max(0, -b_n/w_n) and
 * r_t = -b_t/w_t clipped to mu r_n. The paper has no such method; it is also what stands in for a
 * Newton that does not end.
 */
#ifndef NSD_LOCAL_EXACT_H
#define NSD_LOCAL_EXACT_H

#include "local_sbp.h"

/* Stick or slide with a general W, from the last r; false where neither is on the law. */
bool exact_search(int d, const double W[9], const double b[3], double mu, double r[3]);

/* r_n = -b_n/w_n, and the stick reaction clipped to mu r_n */
ALWAYS_INLINE vm exact_balls(const struct local *l, vd r[3])
{
    vd rn = -l->b[0] * l->iw[0], rt[2] = { -l->b[1] * l->iw[1], -l->b[2] * l->iw[1] };
    vd most = l->mu * rn, t2 = dot2(rt, rt);
    vd s = pick(lt(most * most, t2), most / root(t2), splat(1));
    r[0] = rn, r[1] = s * rt[0], r[2] = s * rt[1];
    return lt(splat(0), l->w[0]) & is_finite(rn + r[1] + r[2]);
}

/* The lanes in m one after another */
ALWAYS_INLINE vm exact_general(const struct local *l, vm m, vd r[3])
{
    double W[9][LANES], b[3][LANES], mu[LANES], x[3][LANES], good[LANES], todo[LANES];
    for (int k = 0; k < 9; k++) vstore(W[k], l->W[k]);
    for (int k = 0; k < 3; k++) vstore(b[k], l->b[k]), vstore(x[k], l->r[k]);
    vstore(mu, l->mu), vstore(todo, pick(m, splat(1), splat(0)));
    for (int i = 0; i < LANES; i++) {
        double Wi[9], bi[3] = { b[0][i], b[1][i], b[2][i] }, ri[3] = { x[0][i], x[1][i], x[2][i] };
        for (int k = 0; k < 9; k++) Wi[k] = W[k][i];
        good[i] = todo[i] != 0 && exact_search(l->d, Wi, bi, mu[i], ri);
        for (int k = 0; k < 3; k++) x[k][i] = ri[k];
    }
    for (int k = 0; k < 3; k++) r[k] = vload(x[k]);
    return lt(splat(0), vload(good));
}

/* Where nothing is on the law (W indefinite or singular), one projected step from the last r. */
ALWAYS_INLINE void exact_solve(struct local *l, const struct local_opt *opt)
{
    vd r[3];
    vm open = ~lt(l->b[0], splat(0)), found = l->W ? exact_general(l, ~open, r) : exact_balls(l, r);
    for (int k = 0; k < 3; k++) r[k] = pick(open, splat(0), r[k]);
    found |= open;
    if (any(~found)) {
        struct local step = *l;
        sbp_solve(&step, opt);
        vm sound = is_finite(step.r[0] + step.r[1] + step.r[2]);
        for (int k = 0; k < 3; k++) r[k] = pick(found, r[k], pick(sound, step.r[k], splat(0)));
    }
    local_begin(l);
    l->gave_up = ~found;
    for (int k = 0; k < 3; k++) l->r[k] = r[k];
    local_velocity(l, l->r, l->u);
}

#endif
