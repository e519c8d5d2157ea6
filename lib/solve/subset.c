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
    if (STEPS * w.price <= inner->budget && !(e = solve_keep_best(s))) ipm_from(&w, s, GAP);
    newton_free(&w);
    return e;
}

/* A subset on its way */
struct subset {
    struct chosen chosen;
    double *x, *v, *map; /* of all contacts: x and v [n d], the natural map [n] */
    struct delassus V;   /* of those chosen */
};

static void leave(struct subset *p)
{
    free(p->chosen.contact), free(p->chosen.of), free(p->x), free(p->v), free(p->map);
    delassus_free(&p->V);
}

/* The contacts chosen and their problem. 1; 0 where they are too many, or the least that their Newton steps
   can cost is more than the budget; -1 when memory is short. */
static int prepare(struct subset *p, const struct scaled *a, const struct solve *s,
                   int64_t contacts, bool anyhow, double budget)
{
    size_t n = (size_t)a->W.n, size = (size_t)a->size + 4;
    struct why why = { 0 };
    *p = (struct subset){ .x = calloc(size, sizeof *p->x), .v = calloc(size, sizeof *p->v) };
    p->map = calloc(n + 1, sizeof *p->map);
    p->chosen.contact = malloc((n + 1) * sizeof *p->chosen.contact);
    p->chosen.of = malloc((n + 1) * sizeof *p->chosen.of);
    if (!p->x || !p->v || !p->map || !p->chosen.contact || !p->chosen.of) return -1;
    scaled_get(a, s->p, p->x);
    scaled_velocity(a, p->x, p->v);
    double largest = maps(a, p->x, p->v, p->map);
    if (!choose(a, p->map, largest, contacts, anyhow, &p->chosen)) return 0;
    if (delassus_subset(&p->V, &a->W, p->chosen.n, p->chosen.contact, p->chosen.of, p->x, p->v,
                        &why))
        return -1;
    double entries = delassus_entries(&p->V);
    return price_analysis(entries) + STEPS * price_newton_step(0, entries) <= budget;
}

/* The solution of V, from its r, into x of all contacts and the report. 1 where it is solved, 0 where not,
   -1 when memory is short. */
static int solve(struct subset *p, struct solve *s, double budget)
{
    const struct inner inner = { { "subset", "", 0, run }, budget };
    struct delassus *V = &p->V;
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
    s->rep->newton += rep.newton, s->rep->work += rep.work;
    s->rep->safeguarded += rep.safeguarded, s->rep->gave_up += rep.gave_up;
    if (e || (!rep.newton && !rep.converged)) return e ? -1 : 0;
    for (int64_t i = 0; i < p->chosen.n; i++)
        memcpy(p->x + V->d * p->chosen.contact[i], V->r + V->d * i, (size_t)V->d * sizeof *p->x);
    return 1;
}

int64_t subset_solve(struct scaled *a, struct solve *s, int64_t contacts, bool anyhow,
                     double budget)
{
    struct subset p;
    int e = prepare(&p, a, s, contacts, anyhow, budget);
    if (e > 0) e = solve(&p, s, budget);
    if (e > 0) scaled_put(a, s, p.x);
    int64_t n = p.chosen.n;
    leave(&p);
    return e > 0 ? n : e;
}

int subset_fits(const struct scaled *a, const struct solve *s, int64_t contacts, bool anyhow,
                double budget)
{
    struct subset p;
    int e = prepare(&p, a, s, contacts, anyhow, budget);
    leave(&p);
    return e;
}
