/* solve/rolling_exact.c: exact with rolling friction: balls in closed form, a full W by a search for r_n. */
#include "solve/rolling.h"
#include "solve/rolling_parts.h"

#include <float.h>
#include <string.h>

/* y of length R, along f; w y + stuff = f with a multiplier of y that is not negative? */
static bool slides(const double f[2], double w, double R, double y[2])
{
    double length = sqrt(dot(f, f, 2));
    for (int i = 0; i < 2; i++) y[i] = length > 0 ? R * f[i] / length : 0;
    return length >= w * R;
}

/* One part within its disc while the other cannot move: the nearest point to -b/w */
static void rolling_exact_alone(double w, const double b[2], double R, double y[2])
{
    double f[2] = { -b[0], -b[1] };
    if (slides(f, w, R, y)) return;
    for (int i = 0; i < 2; i++) y[i] = f[i] / w;
}

/*
 * The first of two coupled parts slides, |t| = Rt, and the second sticks: eliminated, it leaves
 * (w_t - k^2/w_m + lambda) t = -(b_t - k b_m/w_m).
 */
static bool first_slides(double wt, double wm, double k, const double bt[2], const double bm[2],
                         double Rt, double Rm, double t[2], double m[2])
{
    double f[2];
    for (int i = 0; i < 2; i++) f[i] = -(bt[i] - k * bm[i] / wm);
    if (!slides(f, wt - k * k / wm, Rt, t)) return false;
    for (int i = 0; i < 2; i++) m[i] = -(bm[i] + k * t[i]) / wm;
    return dot(m, m, 2) <= Rm * Rm;
}

/*
 * Both slide. For a multiplier lambda of t, m has the length Rm along -(b_m - k b_t/(w_t + lambda)),
 * and |b_t + k m| - Rt (w_t + lambda), which falls, is 0.
 */
static double both_at(double lambda, double wt, double k, const double bt[2], const double bm[2],
                      double Rt, double Rm, double t[2], double m[2])
{
    double w = wt + lambda, f[2], g[2];
    for (int i = 0; i < 2; i++) f[i] = -(bm[i] - k * bt[i] / w);
    slides(f, 0, Rm, m);
    for (int i = 0; i < 2; i++) g[i] = -(bt[i] + k * m[i]), t[i] = g[i] / w;
    return sqrt(dot(g, g, 2)) - Rt * w;
}

/*
 * The root by secants, from 0 and from what m at 0 would make of it: m changes little with lambda.
 * The bracket keeps it safe.
 */
static void both_slide(double wt, double k, const double bt[2], const double bm[2], double Rt,
                       double Rm, double t[2], double m[2])
{
    double most = sqrt(dot(bt, bt, 2)) + fabs(k) * Rm, low = 0, high = most / Rt, was = 0;
    double at_was = both_at(was, wt, k, bt, bm, Rt, Rm, t, m), lambda = at_was / Rt;
    for (int step = 0; step < 100; step++) {
        if (!(lambda >= low && lambda <= high)) lambda = 0.5 * (low + high);
        double at = both_at(lambda, wt, k, bt, bm, Rt, Rm, t, m), next;
        double size = most + Rt * (wt + lambda); // of its rounding
        if (fabs(at) <= 4 * DBL_EPSILON * size || !(low < high)) return;
        *(at > 0 ? &low : &high) = lambda;
        next = lambda - at * (lambda - was) / (at - at_was);
        was = lambda, at_was = at, lambda = next;
    }
}

/* r_t and m_t within their discs, where u_n = 0 has given r_n: a convex problem of two discs */
static void exact_discs(const struct rolling *q, double Rt, double Rm, double t[2], double m[2])
{
    const double *bt = q->b + 1, *bm = q->b + 4, k = q->k, det = q->wt * q->wr - k * k;
    t[0] = t[1] = m[0] = m[1] = 0;
    if (Rt <= 0 || Rm <= 0 || k == 0) {
        if (Rt > 0) rolling_exact_alone(q->wt, bt, Rt, t);
        if (Rm > 0) rolling_exact_alone(q->wr, bm, Rm, m);
        return;
    }
    for (int i = 0; i < 2; i++) {
        t[i] = (k * bm[i] - q->wr * bt[i]) / det;
        m[i] = (k * bt[i] - q->wt * bm[i]) / det;
    }
    if (det > 0 && dot(t, t, 2) <= Rt * Rt && dot(m, m, 2) <= Rm * Rm) return;
    if (first_slides(q->wt, q->wr, k, bt, bm, Rt, Rm, t, m)) return;
    if (first_slides(q->wr, q->wt, k, bm, bt, Rm, Rt, m, t)) return;
    both_slide(q->wt, k, bt, bm, Rt, Rm, t, m);
    for (int i = 0; i < 2; i++) { // onto the circles, to the last bit
        double lt = sqrt(dot(t, t, 2)), lm = sqrt(dot(m, m, 2));
        if (lt > Rt) t[0] *= Rt / lt, t[1] *= Rt / lt;
        if (lm > Rm) m[0] *= Rm / lm, m[1] *= Rm / lm;
    }
}

/*
 * y of A y + f = g within the disc |y| <= R, f along -y: A symmetric, positive definite, 2 x 2. In
 * its axes y_i = g_i/(lambda_i + m), and m is the root of 1/|y| - 1/R, to which Newton's method rises
 * from 0.
 */
static void in_disc(const double A[3], const double g[2], double R, double y[2])
{
    double mean = 0.5 * (A[0] + A[2]), half = 0.5 * (A[0] - A[2]);
    double apart = sqrt(half * half + A[1] * A[1]), high = mean + apart, low = mean - apart;
    // the axis of `high`, of two ways the one without cancellation
    double e[2] = { half > 0 ? half + apart : A[1], half > 0 ? A[1] : apart - half };
    double length = sqrt(dot(e, e, 2));
    if (length > 0)
        e[0] /= length, e[1] /= length;
    else
        e[0] = 1, e[1] = 0;
    double p = e[0] * g[0] + e[1] * g[1], q = e[0] * g[1] - e[1] * g[0], m = 0;
    for (int step = 0; step < 50; step++) {
        double a = p / (high + m), b = q / (low + m), y2 = a * a + b * b;
        if (y2 <= R * R) break;
        double fall = (a * a / (high + m) + b * b / (low + m)) / y2, was = m;
        m += (sqrt(y2) / R - 1) / fall;
        if (!(m > was * (1 + 4 * DBL_EPSILON))) break;
    }
    double a = p / (high + m), b = q / (low + m), over = sqrt(a * a + b * b) / R;
    if (over > 1) a /= over, b /= over;
    y[0] = e[0] * a - e[1] * b, y[1] = e[1] * a + e[0] * b;
}

/* One part of x within its limit, the others held; returns |its change|. */
static double part_alone(const struct rolling *q, int part, double R, double x[ROLLING])
{
    int f = first_of[part], n = size_of[part];
    double g[2] = { 0 }, y[2] = { 0 };
    for (int i = 0; i < n; i++) {
        const double *row = q->W + ROLLING * (f + i);
        g[i] = -q->b[f + i] - dot(row, x, ROLLING) + dot(row + f, x + f, n);
    }
    const double *D = q->W + ROLLING * f + f;
    if (n == 1)
        y[0] = fmax(-R, fmin(R, g[0] / D[0]));
    else if (R > 0)
        in_disc((double[]){ D[0], D[1], D[ROLLING + 1] }, g, R, y);
    double change = 0;
    for (int i = 0; i < n; i++) change = fmax(change, fabs(y[i] - x[f + i])), x[f + i] = y[i];
    return change;
}

/* x of this r_n: a convex problem, by turns of its parts; returns u_n. */
static double at_push(const struct rolling *q, double rn, double x[ROLLING])
{
    x[0] = rn;
    for (int turn = 0; turn < 500; turn++) {
        double change = 0;
        for (int i = 0; i < ROLLING_PARTS; i++)
            change = fmax(change, part_alone(q, i, q->mu[i] * rn, x));
        if (change <= DBL_EPSILON * rn) break;
    }
    return q->b[0] + dot(q->W, x, ROLLING);
}

/*
 * Where W is full the law is no convex problem, but for a given r_n the rest is one, and u_n a
 * continuous function of r_n that begins at b_n < 0: its root is a solution. false: none is found.
 */
bool rolling_search(struct rolling *q)
{
    double low = 0, at_low = q->b[0], high = -q->b[0] / q->W[0], at_high, x[ROLLING] = { 0 };
    for (int k = 0; (at_high = at_push(q, high, x)) < 0; k++) {
        if (k == 60) return false;
        low = high, at_low = at_high, high *= 2;
    }
    double best = high, off = at_high;
    if (-at_low < off) best = low, off = -at_low;
    for (int step = 0, side = 0; step < 200 && off > 0; step++) { // regula falsi, Illinois
        double rn = (low * at_high - high * at_low) / (at_high - at_low);
        if (!(rn > low && rn < high)) break;
        double at = at_push(q, rn, x);
        if (fabs(at) < off) best = rn, off = fabs(at);
        if (off <= 4 * DBL_EPSILON * fabs(q->b[0])) break;
        if (at > 0) {
            high = rn, at_high = at;
            if (side > 0) at_low *= 0.5;
            side = 1;
        } else {
            low = rn, at_low = at;
            if (side < 0) at_high *= 0.5;
            side = -1;
        }
    }
    at_push(q, best, x);
    memcpy(q->x, x, sizeof x);
    return true;
}

void rolling_closed(struct rolling *q)
{
    double rn = q->b[0] < 0 && q->wn > 0 ? -q->b[0] / q->wn : 0, most = q->mu[1] * rn;
    q->x[0] = rn;
    q->x[3] = q->wp > 0 ? fmax(-most, fmin(most, -q->b[3] / q->wp)) : 0;
    exact_discs(q, q->mu[0] * rn, q->wr > 0 ? q->mu[2] * rn : 0, q->x + 1, q->x + 4);
}
