/* solve/even.c: steps of all contacts at once [solve/even.h]. */
#include "solve/even.h"

#include "solve/scaled.h"

#include <stdlib.h>
#include <string.h>

enum {
    CONTACTS = 32,   /* at most: more have their symmetry, if any, broken by where they lie */
    WORK = 4000000,  /* products of numbers in a start, at most: some ms */
    POWER_STEPS = 30 /* to find |W| */
};

/* Over |W| as the power method finds it, which is from below */
static const double SAFE = 1.05;
/* Of eps: less is not worth a step */
static const double ENOUGH = 0.1;

bool even_concerns(const struct problem *p)
{
    return p->packing && p->kind.full && !p->kind.extra && p->n > 1 && p->n <= CONTACTS;
}

static double norm(const double *x, int32_t n)
{
    double sum = 0;
    for (int32_t i = 0; i < n; i++) sum += x[i] * x[i];
    return sqrt(sum);
}

/* |W| of the scaled problem, by the power method */
static double auto_largest(const struct scaled *a, double *x, double *v)
{
    double lambda = 1;
    for (int32_t i = 0; i < a->size; i++) x[i] = 1 / (1.0 + i); // like nothing that is symmetric
    for (int k = 0; k < POWER_STEPS; k++) {
        double before = norm(x, a->size);
        scaled_product(a, x, v);
        double after = norm(v, a->size);
        if (!(before > 0 && after > 0)) break;
        lambda = fmax(lambda, after / before);
        for (int32_t i = 0; i < a->size; i++) x[i] = v[i] / after;
    }
    return SAFE * lambda;
}

/* z = P(y - v^/lambda) */
static void auto_advance(const struct scaled *a, double lambda, const double *y, const double *v,
                    double *z)
{
    const int d = a->W.d;
    for (int64_t c = 0; c < a->W.n; c++) {
        double r[3], u[3], tau[3], p[3];
        scaled_load(d, y + d * c, r), scaled_load(d, v + d * c, u);
        cone_predict(a->W.mu[c], 1 / lambda, r, u, tau);
        cone_project(a->W.mu[c], tau, p);
        scaled_store(d, p, z + d * c);
    }
}

/* x after such steps; w: room for 3 such vectors */
static void step_all(const struct scaled *a, double eps, double *x, double *w)
{
    const int32_t n = a->size;
    double *y = w, *v = w + n + 4, *z = w + 2 * (n + 4), lambda = auto_largest(a, y, v), t = 1;
    int64_t steps = WORK / ((int64_t)n * n);
    memcpy(y, x, (size_t)n * sizeof *y);
    for (int64_t k = 0; k < steps; k++) {
        double uphill = 0;
        scaled_velocity(a, y, v);
        auto_advance(a, lambda, y, v, z);
        for (int32_t i = 0; i < n; i++) uphill += (y[i] - z[i]) * (z[i] - x[i]);
        if (uphill > 0) t = 1; // the momentum leads astray
        double next = 0.5 + sqrt(0.25 + t * t), ahead = (t - 1) / next;
        t = next;
        for (int32_t i = 0; i < n; i++) y[i] = z[i] + ahead * (z[i] - x[i]), x[i] = z[i];
        if (k % 8) continue;
        scaled_velocity(a, x, v);
        if (scaled_natural(a, x, v) <= ENOUGH * eps) break;
    }
}

int even_start(struct solve *s)
{
    struct scaled a;
    struct failure failure = { 0 };
    int e = scaled_init(&a, s->p, &failure) ? -1 : 0;
    size_t size = (size_t)a.size + 4;
    double *x = e ? NULL : calloc(4 * size, sizeof *x);
    if (x) {
        scaled_get(&a, s->p, x);
        step_all(&a, s->o->eps, x, x + size);
        scaled_put(&a, s, x);
    } else {
        e = -1;
    }
    free(x);
    scaled_free(&a);
    return e;
}
