/* solve/rolling_parts.h: x of a rolling contact by its parts, and their limits; for law/rolling*.c alone. */
#pragma once

#include "solve/method.h"

#include <math.h>

/* One contact with rolling and pivoting friction, in the units of solve/rolling.h. */

enum {
    ROLLING = 6,
    ROLLING_PARTS = 3
}; /* numbers of x: n | t1 t2 | p | r1 r2; parts with a limit */

struct rolling {
    double wn, wt, wp, wr, k;    /* kg^-1: between balls */
    bool full;                   /* else W is, in their place */
    double W[ROLLING * ROLLING]; /* kg^-1, symmetric */
    double lambda;               /* kg^-1: its largest eigenvalue */
    double mu[ROLLING_PARTS];    /* mu, mu_p, mu_r, the latter two over the length */
    double rho;                  /* kg */
    double b[ROLLING];           /* m/s */
    double x[ROLLING];           /* N s; in: of the last sweep, out: of this one */
    int steps;                   /* out: of Newton */
    bool safeguarded, gave_up;
};

/* The parts of x that have a limit: where each begins, and how many numbers it has */
static const int first_of[ROLLING_PARTS] = { 1, 3, 4 }, size_of[ROLLING_PARTS] = { 2, 1, 2 };

static inline double dot(const double *a, const double *b, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* |.| of part i */
static inline double rolling_part(const double x[ROLLING], int i)
{
    const double *y = x + first_of[i];
    return size_of[i] == 1 ? fabs(y[0]) : sqrt(dot(y, y, 2));
}

/*
 * r_n of the nearest point of K. With the parts A at their limits it is (tau_n + sum mu_i |tau_i|)/
 * (1 + sum mu_i^2), sums over A; it is the root of r_n - tau_n - sum over all mu_i max(0, |tau_i| -
 * mu_i r_n), which is the least of these over all A and rises: so its root is their largest.
 */
static inline double cone_top(const struct rolling *q, const double tau[ROLLING], bool at_limit[3])
{
    double t[ROLLING_PARTS], best = 0;
    for (int i = 0; i < ROLLING_PARTS; i++) t[i] = rolling_part(tau, i);
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
static inline void limit(const struct rolling *q, const double tau[ROLLING], double rn,
                         double p[ROLLING])
{
    p[0] = rn;
    for (int i = 0; i < ROLLING_PARTS; i++) {
        double t = rolling_part(tau, i), most = q->mu[i] * rn, s = t > most ? most / t : 1;
        for (int j = first_of[i]; j < first_of[i] + size_of[i]; j++) p[j] = s * tau[j];
    }
}

/* mu |u_t| + mu_p |omega_n| + mu_r |omega_t| */
static inline double slip_of(const struct rolling *q, const double u[ROLLING])
{
    double sum = 0;
    for (int i = 0; i < ROLLING_PARTS; i++) sum += q->mu[i] * rolling_part(u, i);
    return sum;
}

/* tau = x - rho u, or u^ */
static inline void predict(const struct rolling *q, double rho, const double x[ROLLING],
                           const double u[ROLLING], bool hat, double tau[ROLLING])
{
    for (int i = 0; i < ROLLING; i++) tau[i] = x[i] - rho * u[i];
    if (hat) tau[0] -= rho * slip_of(q, u);
}

/* Newton's method for ebp (hat) or eal, as newton_run() [solve/local_newton.h]: q->x where it converged, else
   false */
bool rolling_newton(struct rolling *q, bool hat, const struct local_opt *opt);
/* q->x of two balls, in closed form */
void rolling_closed(struct rolling *q);
