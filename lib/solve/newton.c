/* solve/newton.c: see solve/newton.h. */
#include "solve/newton.h"

#include <stdlib.h>
#include <string.h>

enum { INNER = 8 }; /* Newton steps of a careful proximal step */

#define RHO          50.0 /* of the projection: large ones find the statuses, 1 does not */
#define ALPHA_MIN    1e-9
#define ALPHA_END    1e-7 /* of steps that are to end, at a map of */
#define END          1e-9
#define FACTOR_BYTES 4e9    /* bytes that the factors may have */
#define CONTACTS     100000 /* more are not even assembled */

static double *numbers(int64_t n)
{
    return calloc((size_t)n + 4, sizeof(double));
}

void newton_free(struct newton *w)
{
    system_free(w->system);
    scaled_free(&w->whole);
    free(w->x), free(w->v), free(w->z), free(w->L), free(w->D), free(w->best);
    free(w->from), free(w->start), free(w->trial), free(w->dx);
    *w = (struct newton){ 0 };
}

double newton_sweep_cost(const struct problem *p)
{
    double n = (double)p->n; // by bodies, or by blocks of W
    return p->W ? 30 * n + 2 * (double)p->W->first[p->n] : 10 * n;
}

int newton_assemble(struct newton *w, const struct problem *p)
{
    struct why why = { 0 };
    *w = (struct newton){ .value = INFINITY, .rho = RHO };
    bool good = p->n <= CONTACTS && !scaled_init(&w->whole, p, &why);
    int32_t size = w->whole.size;
    if (good) {
        w->x = numbers(size), w->v = numbers(size), w->z = numbers(size), w->best = numbers(size);
        w->from = numbers(size), w->start = numbers(size);
        w->trial = numbers(size), w->dx = numbers(size);
        w->L = numbers(9 * p->n), w->D = numbers(9 * p->n);
    }
    if (!good || !w->x || !w->v || !w->z || !w->best || !w->from || !w->start || !w->trial ||
        !w->dx || !w->L || !w->D) {
        newton_free(w);
        return -1;
    }
    w->sweep_cost = newton_sweep_cost(p);
    return 0;
}

int newton_factors(struct newton *w)
{
    w->system = system_new(&w->whole, FACTOR_BYTES);
    if (!w->system) return -1;
    // in ns: a multiplication of the factors, and half as much for all else in a step (with none or as
    // much again more of 54 problems end unsolved)
    w->cost = 1.5 * system_cost(w->system);
    return 0;
}

int newton_init(struct newton *w, const struct problem *p)
{
    if (newton_assemble(w, p)) return -1;
    if (!newton_factors(w)) return 0;
    newton_free(w);
    return -1;
}

int32_t newton_share(const struct newton *w)
{
    return (int32_t)fmin(fmax(w->cost / w->sweep_cost, 200), 2000);
}

void newton_get(struct newton *w, struct solve *s)
{
    scaled_get(&w->whole, s->p, w->x);
    if (s->value < w->value) {
        w->value = s->value;
        memcpy(w->best, w->x, (size_t)w->whole.size * sizeof *w->x);
    }
}

void newton_put(struct newton *w, struct solve *s)
{
    scaled_put(&w->whole, s->p, w->x);
    s->believes = false;
    if (!(solve_judge(s) < w->value)) return;
    w->value = s->value;
    memcpy(w->best, w->x, (size_t)w->whole.size * sizeof *w->x);
}

void newton_back(struct newton *w, struct solve *s)
{
    if (s->value <= w->value) return;
    memcpy(w->x, w->best, (size_t)w->whole.size * sizeof *w->x);
    newton_put(w, s);
}

/* Z at x, negated, into z, and the matrix' parts; v is the velocity with the proximal term. |Z| */
static double residual(struct newton *w, const double *x)
{
    struct scaled *a = &w->whole;
    int d = a->W.d;
    double prox = w->alpha * a->mean, sum = 0;
    scaled_velocity(a, x, w->v);
    for (int32_t i = 0; i < a->size; i++) w->v[i] += prox * (x[i] - w->from[i]);
    for (int64_t c = 0; c < a->W.n; c++) {
        double r[3], u[3], Z[3], A[3][3], B[3][3];
        scaled_load(d, x + d * c, r), scaled_load(d, w->v + d * c, u);
        eal_linearise(a->W.mu[c], w->rho, r, u, Z, A, B);
        for (int i = 0; i < d; i++) w->z[d * c + i] = -Z[i], sum += Z[i] * Z[i];
        for (int i = 0; i < 9; i++) {
            w->L[9 * c + i] = B[i / 3][i % 3];
            w->D[9 * c + i] = A[i / 3][i % 3] + prox * B[i / 3][i % 3];
        }
    }
    return sqrt(sum);
}

/* x moves along dx (in z) as far as |Z| falls; false where it does not. */
static bool search(struct newton *w, double *at, double *dx)
{
    double before = *at;
    memcpy(dx, w->z, (size_t)w->whole.size * sizeof *dx);
    for (int halvings = 0; halvings < 9; halvings++) {
        double step = ldexp(1, -halvings);
        for (int32_t i = 0; i < w->whole.size; i++) w->trial[i] = w->x[i] + step * dx[i];
        *at = residual(w, w->trial);
        if (!(*at < (1 - 0.01 * step) * before)) continue;
        double *x = w->x;
        w->x = w->trial, w->trial = x;
        return true;
    }
    return false;
}

/*
 * From x, which is x_0 too, one full step, or as many as the proximal step wants with a line search;
 * x becomes the projection at its end. False where it leads nowhere.
 */
static bool newton_step(struct newton *w, struct report *rep, bool carefully)
{
    struct scaled *a = &w->whole;
    size_t size = (size_t)a->size * sizeof *w->x;
    memcpy(w->from, w->x, size);
    double z = residual(w, w->x), start = z;
    for (int k = 0; k < (carefully ? INNER : 1); k++) {
        if (!system_solve(w->system, w->L, w->D, w->z)) return false;
        rep->newton++;
        if (!carefully) {
            for (int32_t i = 0; i < a->size; i++) w->x[i] += w->z[i];
            residual(w, w->x);
        } else if (!search(w, &z, w->dx)) {
            residual(w, w->x);
            break;
        } else if (z < 0.01 * start) {
            break;
        }
    }
    for (int64_t c = 0; c < a->W.n; c++) {
        int d = a->W.d;
        double r[3] = { 0 }, u[3], tau[3];
        scaled_load(d, w->x + d * c, r), scaled_load(d, w->v + d * c, u);
        disc_predict(w->rho, r, u, tau);
        disc_project(a->W.mu[c], tau, r);
        scaled_store(d, r, w->x + d * c);
    }
    return true;
}

double newton_map(struct newton *w)
{
    scaled_velocity(&w->whole, w->x, w->v);
    return scaled_natural(&w->whole, w->x, w->v);
}

bool newton_finish(struct newton *w, struct solve *s, double rho)
{
    size_t size = (size_t)w->whole.size * sizeof *w->x;
    double map = newton_map(w), before;
    memcpy(w->start, w->x, size);
    w->rho = rho, w->alpha = ALPHA_END;
    do {
        before = map;
        map = newton_step(w, s->rep, false) ? newton_map(w) : INFINITY;
    } while (map > END && map < before / 3);
    w->rho = RHO;
    if (!(map <= END)) return memcpy(w->x, w->start, size), false;
    w->value = INFINITY; // the best, whatever the criterion says of others
    newton_put(w, s);
    return true;
}

/*
 * A step alone makes the many contacts that it does not see rightly much worse, and a sweep mends
 * just those: hence the sweeps after a step that has not halved the error by itself.
 */
void newton_polish(struct newton *w, struct solve *s, double alpha, int patience)
{
    static const double omegas[] = { 1.5, 1, 0.7 };
    size_t size = (size_t)w->whole.size * sizeof *w->x;
    double mark = s->value, least = s->value; // what is to be halved
    bool carefully = false;
    int32_t share = newton_share(w);
    w->alpha = alpha;
    newton_get(w, s);
    for (int vain = 0, harms = 0; !solve_met(s) && !solve_spent(s) && vain < patience;) {
        double before = s->value;
        memcpy(w->start, w->x, size);
        if (!newton_step(w, s->rep, carefully)) {
            w->alpha = fmax(10 * w->alpha, 1e-8);
            memcpy(w->x, w->start, size);
            vain++;
            continue;
        }
        newton_put(w, s);
        double after = s->value;
        bool good = after < 0.5 * before;
        if (!good && !solve_met(s)) {
            memcpy(w->trial, w->x, size);
            nlgs_sweeps(s, share, s->o->relax > 0 ? s->o->relax : omegas[w->omega]);
            newton_get(w, s);
            // sweeps that do harm are over-relaxed
            bool harm = !(s->value < 0.99 * before) || s->value > after;
            harms = harm ? harms + 1 : 0;
            if (harms == 2) harms = 0, w->omega = (w->omega + 1) % 3;
            if (s->value > after) memcpy(w->x, w->trial, size), newton_put(w, s);
        }
        carefully = !carefully && !(s->value < 0.9 * before);
        if (s->value < before)
            w->alpha = fmax(w->alpha * (good ? 0.2 : 0.5), ALPHA_MIN);
        else
            w->alpha = fmin(w->alpha * (after > 1e3 * before ? 10 : 3), 1);
        if (!(s->value < 2 * before)) memcpy(w->x, w->start, size), newton_put(w, s);
        least = fmin(least, s->value);
        vain = least < 0.5 * mark ? 0 : vain + 1;
        if (!vain) mark = least;
    }
    newton_back(w, s);
}
