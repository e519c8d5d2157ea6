/* solve/rolling.c: the five local methods with rolling friction [solve/rolling.h]. */
#include "solve/rolling.h"

#include "solve/rolling_parts.h"

#include <string.h>

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

void rolling_project(const struct rolling *q, const double tau[ROLLING], double p[ROLLING])
{
    bool at_limit[ROLLING_PARTS];
    limit(q, tau, cone_top(q, tau, at_limit), p);
}

double rolling_bipotential(const struct rolling *q, const double x[ROLLING],
                           const double u[ROLLING])
{
    return dot(u, x, ROLLING) + slip_of(q, u) * x[0];
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

/* Nothing where the surfaces part, else by Newton's method, which mostly ends in three steps, and what
   it does not solve by a search for r_n */
static void exact_full(struct rolling *q)
{
    const struct local_opt tight = { .newton_eps = 1e-15, .newton_max = 20 };
    int steps = q->steps;
    if (!(q->b[0] < 0)) {
        memset(q->x, 0, sizeof q->x);
        return;
    }
    q->gave_up = !rolling_newton(q, false, &tight) && !rolling_search(q);
    q->steps = steps;
}

static void exact(struct rolling *q)
{
    if (q->full)
        exact_full(q);
    else
        rolling_closed(q);
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
        if (rolling_newton(q, hat, opt)) return;
        q->safeguarded = true;
        exact(q);
        return;
    default: // exact, and methods that have no other way here
        exact(q);
    }
}
