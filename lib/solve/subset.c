/* subset.c: see solve/subset.h. */
#include "solve/subset.h"

#include "solve/ipm.h"
#include "solve/nlgs.h"
#include "solve/prices.h"

#include <stdlib.h>
#include <string.h>

#define LARGE 0.1   /* of the largest natural map of a contact: such contacts are chosen */
#define EXACT 1e-13 /* the natural map of a subset's solution */
#define GAP   1e-3  /* at which its interior point method begins */
#define OMEGA 1.3   /* of its sweeps */

enum {
    SWEEPS = 100, /* of a subset, before its interior point method */
    STEPS = 15    /* Newton steps that its solution takes, mostly */
};

struct chosen {
    int64_t n;
    int32_t *contact; /* [n] ascending: contact i of the subset is contact[i] of all, */
    int32_t *of;      /* [all] and of[] tells which it is; -1: none */
};

/* The natural map of each contact at x, whose velocity is v; the largest */
static double maps(const struct scaled *a, const double *x, const double *v, double *map)
{
    double largest = 0;
    for (int64_t c = 0; c < a->W.n; c++) {
        map[c] = scaled_natural_of(a, c, x, v);
        largest = fmax(largest, map[c]);
    }
    return largest;
}

/* How many maps are large */
static int64_t count(const double *map, int64_t n, double large)
{
    int64_t k = 0;
    for (int64_t c = 0; c < n; c++) k += map[c] > large;
    return k;
}

/* At least `least` contacts: those where the map is large, as many around them, or more. False where they
   would be too many. */
static bool choose(const struct scaled *a, const double *map, double largest, int64_t least,
                   bool anyhow, struct chosen *p)
{
    const struct delassus *W = &a->W;
    double large = LARGE * largest;
    while (anyhow && large < largest / 2 && count(map, W->n, large) > W->n / 4) large *= 2;
    int64_t most = 2 * count(map, W->n, large);
    if (most < least) most = least;
    if (most > W->n / (anyhow ? 2 : 5)) return false;
    for (int64_t c = 0; c < W->n; c++) p->of[c] = -1;
    p->n = 0;
    for (int32_t c = 0; c < W->n; c++)
        if (map[c] > large) p->of[c] = 0, p->contact[p->n++] = c;
    for (int64_t i = 0; i < p->n && p->n < most; i++)
        for (int64_t e = W->first[p->contact[i]]; e < W->first[p->contact[i] + 1]; e++) {
            int32_t c = W->col[e];
            if (p->of[c] < 0 && p->n < most) p->of[c] = 0, p->contact[p->n++] = c;
        }
    p->n = 0;
    for (int32_t c = 0; c < W->n; c++)
        if (p->of[c] >= 0) p->of[c] = (int32_t)p->n, p->contact[p->n++] = c;
    return true;
}

/* The solver of a subset */
struct inner {
    struct solver solver; /* first: a solve knows its solver only */
    double budget;
};

/* A few sweeps and the first way of the interior point method: what they do not solve is better asked of a
   larger subset than of more ways. */
static int run(struct solve *s)
{
    const struct inner *inner = (const struct inner *)s->o->global;
    struct newton w;
    const char *reason;
    if (nlgs_sweeps(s, SWEEPS, OMEGA)) return -1;
    if (solve_over(s)) return 0;
    int e = newton_init(&w, s, &reason);
    if (e) return e < 0 ? -1 : 0;
    if (STEPS * w.price <= inner->budget && !(e = solve_keep(s))) ipm_from(&w, s, GAP);
    newton_free(&w);
    return e;
}

/* V's solution, from its r, into x of all contacts and the report. Returns 0 where it is solved, 1 where not,
   -1 when memory is short. */
static int solve(struct solve *s, const struct chosen *p, struct delassus *V, double budget,
                 double *x)
{
    // the least that its Newton steps can cost, before anything is spent on it
    double entries = delassus_entries(V);
    if (price_analysis(entries) + STEPS * price_newton_step(0, entries) > budget) return 1;
    const struct inner inner = { { "subset", "", 0, run }, budget };
    struct problem q;
    struct why why = { 0 };
    struct report rep = { 0 };
    struct solve_opt o = *s->o;
    o.global = &inner.solver, o.criterion = CRITERION_NATURAL, o.eps = EXACT;
    o.max_sweeps = INT32_MAX, o.every_sweep = o.history = false, o.threads = 1, o.progress = NULL;
    if (o.max_seconds > 0) o.max_seconds = fmax(solve_seconds_left(s), 1e-9);
    if (problem_prepare_delassus(&q, V, 0, s->o->method->rho, ORDER_NATURAL, &why)) return -1;
    int e = solve_problem(&q, &o, &rep);
    problem_free(&q);
    for (int64_t i = 0; !e && rep.newton && i < p->n; i++)
        memcpy(x + V->d * p->contact[i], V->r + V->d * i, (size_t)V->d * sizeof *x);
    s->rep->newton += rep.newton, s->rep->work += rep.work;
    s->rep->safeguarded += rep.safeguarded, s->rep->gave_up += rep.gave_up;
    return e ? -1 : !rep.newton && !rep.converged;
}

int64_t subset_solve(struct scaled *a, struct solve *s, int64_t contacts, bool anyhow,
                     double budget)
{
    size_t n = (size_t)a->W.n, size = (size_t)a->size + 4;
    struct chosen p = { 0, malloc((n + 1) * sizeof *p.contact), malloc((n + 1) * sizeof *p.of) };
    struct delassus V = { 0 };
    struct why why = { 0 };
    double *x = calloc(size, sizeof *x), *v = calloc(size, sizeof *v),
           *map = calloc(n + 1, sizeof *map);
    int64_t solved = -1;
    if (p.contact && p.of && x && v && map) {
        scaled_get(a, s->p, x);
        scaled_velocity(a, x, v);
        double largest = maps(a, x, v, map);
        bool chosen = choose(a, map, largest, contacts, anyhow, &p);
        if (!chosen) {
            solved = 0;
        } else if (!delassus_part(&V, &a->W, p.n, p.contact, p.of, x, v, &why)) {
            int e = solve(s, &p, &V, budget, x);
            solved = e < 0 ? -1 : e ? 0 : p.n;
        }
    }
    if (solved > 0) scaled_put(a, s, x);
    delassus_free(&V), free(p.contact), free(p.of);
    free(x), free(v), free(map);
    return solved;
}
