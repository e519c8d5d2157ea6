/* law/rolling.c: the five local methods with rolling friction [law/rolling.h]. */
#include "law/rolling.h"

#include <float.h>
#include <gsl/gsl_linalg.h>
#include <string.h>

/* The parts of x that have a limit: where each begins, and how many numbers it has */
static const int first_of[ROLLING_PARTS] = { 1, 3, 4 }, size_of[ROLLING_PARTS] = { 2, 1, 2 };

static double dot(const double *a, const double *b, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* |.| of part i */
static double part(const double x[ROLLING], int i)
{
    const double *y = x + first_of[i];
    return size_of[i] == 1 ? fabs(y[0]) : sqrt(dot(y, y, 2));
}

void rolling_velocity(const struct rolling *q, const double x[ROLLING], double u[ROLLING])
{
    if (q->full) {
        for (int i = 0; i < ROLLING; i++) u[i] = q->b[i] + dot(q->W + ROLLING * i, x, ROLLING);
        return;
    }
    u[0] = q->wn * x[0] + q->b[0], u[3] = q->wp * x[3] + q->b[3];
    for (int i = 1; i < 3; i++) {
        u[i] = q->wt * x[i] + q->k * x[3 + i] + q->b[i];
        u[3 + i] = q->k * x[i] + q->wr * x[3 + i] + q->b[3 + i];
    }
}

double rolling_lambda(const struct rolling *q)
{
    if (q->full) return q->lambda;
    double mean = 0.5 * (q->wt + q->wr), apart = 0.5 * (q->wt - q->wr);
    return fmax(fmax(q->wn, q->wp), mean + sqrt(apart * apart + q->k * q->k));
}

/* ---- projections ---- */

/*
 * r_n of the nearest point of K. With the parts A at their limits it is (tau_n + sum mu_i |tau_i|)/
 * (1 + sum mu_i^2), sums over A; it is the root of r_n - tau_n - sum over all mu_i max(0, |tau_i| -
 * mu_i r_n), which is the least of these over all A and rises: so its root is their largest.
 */
static double cone_top(const struct rolling *q, const double tau[ROLLING], bool at_limit[3])
{
    double t[ROLLING_PARTS], best = 0;
    for (int i = 0; i < ROLLING_PARTS; i++) t[i] = part(tau, i);
    for (int set = 0; set < 1 << ROLLING_PARTS; set++) {
        double top = tau[0], all = 1;
        for (int i = 0; i < ROLLING_PARTS; i++)
            if (set >> i & 1) top += q->mu[i] * t[i], all += q->mu[i] * q->mu[i];
        best = fmax(best, top / all);
    }
    for (int i = 0; i < ROLLING_PARTS; i++) at_limit[i] = t[i] > q->mu[i] * best;
    return best;
}

/* p: tau with the parts that are beyond it brought back to mu r_n */
static void limit(const struct rolling *q, const double tau[ROLLING], double rn, double p[ROLLING])
{
    p[0] = rn;
    for (int i = 0; i < ROLLING_PARTS; i++) {
        double t = part(tau, i), most = q->mu[i] * rn, s = t > most ? most / t : 1;
        for (int j = first_of[i]; j < first_of[i] + size_of[i]; j++) p[j] = s * tau[j];
    }
}

void rolling_project(const struct rolling *q, const double tau[ROLLING], double p[ROLLING])
{
    bool at_limit[ROLLING_PARTS];
    limit(q, tau, cone_top(q, tau, at_limit), p);
}

/* mu |u_t| + mu_p |omega_n| + mu_r |omega_t| */
static double slip_of(const struct rolling *q, const double u[ROLLING])
{
    double sum = 0;
    for (int i = 0; i < ROLLING_PARTS; i++) sum += q->mu[i] * part(u, i);
    return sum;
}

double rolling_bipotential(const struct rolling *q, const double x[ROLLING],
                           const double u[ROLLING])
{
    return dot(u, x, ROLLING) + slip_of(q, u) * x[0];
}

/* tau = x - rho u, or u^ */
static void predict(const struct rolling *q, double rho, const double x[ROLLING],
                    const double u[ROLLING], bool hat, double tau[ROLLING])
{
    for (int i = 0; i < ROLLING; i++) tau[i] = x[i] - rho * u[i];
    if (hat) tau[0] -= rho * slip_of(q, u);
}

double rolling_natural2(const struct rolling *q, double rho, const double x[ROLLING],
                        const double u[ROLLING])
{
    double tau[ROLLING], p[ROLLING], sum = 0;
    predict(q, rho, x, u, true, tau);
    rolling_project(q, tau, p);
    for (int i = 0; i < ROLLING; i++) sum += (x[i] - p[i]) * (x[i] - p[i]);
    return sum;
}

/* ---- exact ---- */

/* y of length R, along f; w y + stuff = f with a multiplier of y that is not negative? */
static bool slides(const double f[2], double w, double R, double y[2])
{
    double length = sqrt(dot(f, f, 2));
    for (int i = 0; i < 2; i++) y[i] = length > 0 ? R * f[i] / length : 0;
    return length >= w * R;
}

/* One part within its disc while the other cannot move: the nearest point to -b/w */
static void alone(double w, const double b[2], double R, double y[2])
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
        if (Rt > 0) alone(q->wt, bt, Rt, t);
        if (Rm > 0) alone(q->wr, bm, Rm, m);
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

static bool newton(struct rolling *q, bool hat, const struct local_opt *opt);

/* Nothing where the surfaces part, else by Newton's method, which mostly ends in three steps, and what
   it does not solve by the root above */
static void exact_full(struct rolling *q)
{
    const struct local_opt tight = { .newton_eps = 1e-15, .newton_max = 20 };
    int steps = q->steps;
    if (!(q->b[0] < 0)) {
        memset(q->x, 0, sizeof q->x);
        return;
    }
    q->gave_up = !newton(q, false, &tight) && !rolling_search(q);
    q->steps = steps;
}

static void exact(struct rolling *q)
{
    if (q->full) {
        exact_full(q);
        return;
    }
    double rn = q->b[0] < 0 && q->wn > 0 ? -q->b[0] / q->wn : 0, most = q->mu[1] * rn;
    q->x[0] = rn;
    q->x[3] = q->wp > 0 ? fmax(-most, fmin(most, -q->b[3] / q->wp)) : 0;
    exact_discs(q, q->mu[0] * rn, q->wr > 0 ? q->mu[2] * rn : 0, q->x + 1, q->x + 4);
}

/* ---- Newton ---- */

/* An iterate of ebp (hat) or eal: Z = x - proj(tau) */
struct point {
    double x[ROLLING], u[ROLLING], tau[ROLLING], p[ROLLING], Z[ROLLING], z2;
    bool at_limit[ROLLING_PARTS];
};

static void residual(const struct rolling *q, bool hat, struct point *y)
{
    rolling_velocity(q, y->x, y->u);
    predict(q, q->rho, y->x, y->u, hat, y->tau);
    double rn = hat ? cone_top(q, y->tau, y->at_limit) : fmax(y->tau[0], 0);
    for (int i = 0; i < ROLLING_PARTS; i++) y->at_limit[i] = part(y->tau, i) > q->mu[i] * rn;
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
        double length = part(y->u, i);
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
        double length = part(y->tau, i);
        all += q->mu[i] * q->mu[i];
        for (int j = first_of[i]; j < first_of[i] + size_of[i]; j++)
            top[j] = q->mu[i] * y->tau[j] / length;
    }
    for (int j = 0; j < ROLLING; j++) P[0][j] = top[j] / all;
    for (int i = 0; i < ROLLING_PARTS; i++) {
        double length = part(y->tau, i), s = q->mu[i] * y->p[0] / length;
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
static bool direction(const struct rolling *q, bool hat, const struct point *y, double dx[ROLLING])
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

/* As newton_run() [law/local_newton.h]; q->x where it converged. */
static bool newton(struct rolling *q, bool hat, const struct local_opt *opt)
{
    double b2 = q->rho * q->rho * dot(q->b, q->b, ROLLING),
           eps2 = opt->newton_eps * opt->newton_eps;
    struct point x = { .z2 = 0 }, y;
    memcpy(x.x, q->x, sizeof x.x);
    residual(q, hat, &x);
    for (int k = 0; k == 0 || k < opt->newton_max; k++) {
        double dx[ROLLING], s = 1;
        if (!direction(q, hat, &x, dx)) return false;
        q->steps++;
        for (;; s *= 0.5) {
            for (int i = 0; i < ROLLING; i++) y.x[i] = x.x[i] + s * dx[i];
            residual(q, hat, &y);
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

void rolling_solve(enum method_id method, struct rolling *q, const struct local_opt *opt)
{
    double u[ROLLING], tau[ROLLING];
    bool hat = method == METHOD_sbp || method == METHOD_ebp;
    q->steps = 0, q->safeguarded = q->gave_up = false;
    switch (method) {
    case METHOD_sbp:
    case METHOD_sal:
        rolling_velocity(q, q->x, u);
        predict(q, q->rho, q->x, u, hat, tau);
        if (hat)
            rolling_project(q, tau, q->x);
        else
            limit(q, tau, fmax(tau[0], 0), q->x);
        return;
    case METHOD_ebp:
    case METHOD_eal:
        if (newton(q, hat, opt)) return;
        q->safeguarded = true;
        exact(q);
        return;
    case METHOD_exact:
        exact(q);
        return;
    case METHOD_COUNT:
        return;
    }
}
