/* solve/newton.c: the steps, and the strategy of steps and sweeps in turn [solve/newton.h]. */
#include "solve/newton.h"

#include "solve/method.h"
#include "solve/nlgs.h"
#include "solve/solver.h"

#include <stdlib.h>
#include <string.h>

enum {
    INNER = 8,        /* Newton steps of a careful proximal step, at most */
    SWEEPS_MIN = 200, /* sweeps between two steps, at least */
    SWEEPS_MAX = 2000 /* sweeps between two steps, at most */
};

#define RHO          50.0   /* of the projection: a large one finds the statuses, 1 does not */
#define ALPHA_MIN    1e-9   /* a in multiples of W's mean diagonal, at least */
#define ALPHA_END    1e-7   /* the same in newton_finish() */
#define MAP_END      1e-9   /* scaled natural map at which newton_finish() has succeeded */
#define FACTOR_BYTES 4e9    /* bytes of the factors, at most */
#define CONTACTS_MAX 100000 /* contacts: more are not even assembled */

void newton_free(struct newton *w)
{
    system_free(w->system);
    scaled_free(&w->a);
    free(w->room);
    *w = (struct newton){ 0 };
}

static int free_and_return(struct newton *w, int status)
{
    newton_free(w);
    return status;
}

int newton_assemble(struct newton *w, struct solve *s)
{
    struct failure failure = { 0 };
    *w = (struct newton){ .rho = RHO };
    if (s->p->n > CONTACTS_MAX) return 1;
    int e = scaled_init(&w->a, s->p, &failure);
    if (e) return free_and_return(w, e == EX_DATAERR ? 1 : -1);
    s->rep->work += price_assembly(delassus_entries(&w->a.W));
    size_t size = (size_t)w->a.size + 4, blocks = 9 * (size_t)s->p->n;
    if (!(w->room = calloc(7 * size + 2 * blocks, sizeof *w->room))) return free_and_return(w, -1);
    w->x = w->room, w->v = w->x + size, w->z = w->v + size, w->from = w->z + size;
    w->start = w->from + size, w->trial = w->start + size, w->dx = w->trial + size;
    w->L = w->dx + size, w->D = w->L + blocks;
    return 0;
}

int newton_factors(struct newton *w, struct solve *s)
{
    bool too_large;
    if (!solve_affords(s, system_price_new(&w->a))) return 1;
    s->rep->work += system_price_new(&w->a);
    w->system = system_new(&w->a, FACTOR_BYTES, &too_large);
    if (!w->system && !too_large) return -1;
    if (too_large) return 1;
    w->price = system_price(w->system);
    if (solve_affords(s, w->price)) return 0;
    system_free(w->system), w->system = NULL;
    return 1;
}

int newton_init(struct newton *w, struct solve *s)
{
    int e = newton_assemble(w, s);
    if (!e && (e = newton_factors(w, s))) newton_free(w);
    return e;
}

int32_t newton_sweeps_per_step(const struct newton *w, const struct problem *p)
{
    return (int32_t)fmin(fmax(w->price / price_sweep(p), SWEEPS_MIN), SWEEPS_MAX);
}

/* z = -Z at x, L and D of the matrix there, and v with its proximal term; returns |Z|. */
static double newton_residual(struct newton *w, const double *x)
{
    struct scaled *a = &w->a;
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

/* Moves x along dx (given in z), by the longest of 1, 1/2, 1/4 ... with which |Z| falls; false
   where there is none. *at: |Z| */
static bool line_search(struct newton *w, double *at)
{
    double before = *at, *dx = w->dx;
    memcpy(dx, w->z, (size_t)w->a.size * sizeof *dx);
    for (int halvings = 0; halvings < 9; halvings++) {
        double step = ldexp(1, -halvings);
        for (int32_t i = 0; i < w->a.size; i++) w->trial[i] = w->x[i] + step * dx[i];
        *at = newton_residual(w, w->trial);
        if (!(*at < (1 - 0.01 * step) * before)) continue;
        double *x = w->x;
        w->x = w->trial, w->trial = x;
        return true;
    }
    return false;
}

/*
 * From x, which is also x_0: one full step, or if `carefully` steps with a line search until the
 * proximal step is solved. Then x is projected onto its disc. False where a system cannot be solved
 * or time is short.
 */
static bool newton_step(struct newton *w, struct solve *s, bool carefully)
{
    struct scaled *a = &w->a;
    size_t size = (size_t)a->size * sizeof *w->x;
    memcpy(w->from, w->x, size);
    double z = newton_residual(w, w->x), start = z;
    for (int k = 0; k < (carefully ? INNER : 1); k++) {
        if (!solve_affords(s, w->price)) return false;
        double since = report_seconds(CLOCK_WALL);
        bool solved = system_solve(w->system, w->L, w->D, w->z);
        solve_count_newton(s, w->price, since);
        if (!solved) return false;
        if (!carefully) {
            for (int32_t i = 0; i < a->size; i++) w->x[i] += w->z[i];
            newton_residual(w, w->x);
        } else if (!line_search(w, &z)) {
            newton_residual(w, w->x);
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

/* The scaled natural map at x; leaves the velocity of x in v. */
static double map_at(struct newton *w)
{
    scaled_velocity(&w->a, w->x, w->v);
    return scaled_natural(&w->a, w->x, w->v);
}

bool newton_finish(struct newton *w, struct solve *s, const double *x, double rho)
{
    memcpy(w->x, x, (size_t)w->a.size * sizeof *x);
    double map = map_at(w), before;
    w->rho = rho, w->alpha = ALPHA_END;
    do {
        before = map;
        map = newton_step(w, s, false) ? map_at(w) : INFINITY;
    } while (map > MAP_END && map < before / 3);
    w->rho = RHO;
    if (!(map <= MAP_END)) return false;
    best_forget(&s->best); // this solution is the best, whatever the criterion says of others
    scaled_put(&w->a, s, w->x);
    return true;
}

/*
 * A step gets a few contacts very wrong, those whose status it misjudges, and sweeps mend just
 * these: hence the sweeps after a step that has not halved the criterion by itself.
 */
void newton_polish(struct newton *w, struct solve *s, double alpha, int patience)
{
    static const double omegas[] = { 1.5, 1, 0.7 };
    size_t size = (size_t)w->a.size * sizeof *w->x;
    double mark = s->value, least = s->value; // patience lasts while least falls to half of mark
    bool carefully = false;
    int32_t share = newton_sweeps_per_step(w, s->p);
    w->alpha = alpha;
    scaled_get(&w->a, s->p, w->x);
    for (int in_vain = 0, harmed = 0; in_vain < patience;) {
        if (solve_over(s) || !solve_affords(s, w->price)) break;
        double before = s->value;
        memcpy(w->start, w->x, size);
        if (!newton_step(w, s, carefully)) {
            w->alpha = fmax(10 * w->alpha, 1e-8);
            memcpy(w->x, w->start, size);
            in_vain++;
            continue;
        }
        scaled_put(&w->a, s, w->x);
        double after = s->value;
        bool good = after < 0.5 * before;
        if (!good && !solve_met(s)) {
            memcpy(w->trial, w->x, size);
            nlgs_sweeps(s, share, s->o->relax > 0 ? s->o->relax : omegas[w->omega]);
            scaled_get(&w->a, s->p, w->x);
            // sweeps that make it worse twice in a row may be over-relaxed: the next omega
            bool harm = !(s->value < 0.99 * before) || s->value > after;
            harmed = harm ? harmed + 1 : 0;
            if (harmed == 2) harmed = 0, w->omega = (w->omega + 1) % 3;
            if (s->value > after) memcpy(w->x, w->trial, size), scaled_put(&w->a, s, w->x);
        }
        carefully = !carefully && !(s->value < 0.9 * before);
        if (s->value < before)
            w->alpha = fmax(w->alpha * (good ? 0.2 : 0.5), ALPHA_MIN);
        else
            w->alpha = fmin(w->alpha * (after > 1e3 * before ? 10 : 3), 1);
        if (!(s->value < 2 * before)) memcpy(w->x, w->start, size), scaled_put(&w->a, s, w->x);
        least = fmin(least, s->value);
        in_vain = least < 0.5 * mark ? 0 : in_vain + 1;
        if (!in_vain) mark = least;
    }
    solve_restore_best(s);
}
