/* solve/subset.c: the choice of a subset, its problem and its solution [solve/subset.h]. */
#include "solve/subset.h"

#include "solve/ipm.h"
#include "solve/nlgs.h"
#include "solve/solver.h"

#include <stdlib.h>
#include <string.h>

#define LARGE 0.1   /* of the largest natural map of a contact: with more a contact is chosen */
#define EXACT 1e-13 /* natural map to which a subset is solved; 1e-11 is no faster */
#define GAP   1e-3  /* gap at which a subset's interior point method begins */
#define OMEGA 1.3   /* omega of a subset's sweeps */

enum {
    SWEEPS = 100, /* sweeps of a subset before the interior point; 30, 300: no faster */
    STEPS = 15    /* Newton steps that a subset takes, mostly: for its price */
};

/* map[] = the natural map of each contact at x, whose velocity is v; returns the largest. */
static double fill_maps(const struct scaled *a, const double *x, const double *v, double *map)
{
    double largest = 0;
    for (int64_t c = 0; c < a->W.n; c++) {
        map[c] = scaled_natural_of(a, c, x, v);
        largest = fmax(largest, map[c]);
    }
    return largest;
}

static int64_t count_large(const double *map, int64_t n, double large)
{
    int64_t k = 0;
    for (int64_t c = 0; c < n; c++) k += map[c] > large;
    return k;
}

/* Chooses the contacts with a large map and as many of their neighbours, or more of these up to
   `least` in all. False where they would be too many. */
static bool subset_choose(const struct scaled *a, const double *map, double largest, int64_t least,
                          bool anyhow, struct selection_contacts *p)
{
    const struct delassus *W = &a->W;
    double large = LARGE * largest;
    while (anyhow && large < largest / 2 && count_large(map, W->n, large) > W->n / 4) large *= 2;
    int64_t most = 2 * count_large(map, W->n, large);
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

/* The solver of a subset, with the budget that its run() needs */
struct inner {
    struct solver solver; /* first, so that run() gets from its solver to this struct */
    double budget;
};

/* Some sweeps and the first attempt of the interior point method. Where these fail a larger subset
   is more promising than further attempts. */
static int subset_run(struct solve *s)
{
    const struct inner *inner = (const struct inner *)s->o->global;
    struct newton w;
    if (nlgs_sweeps(s, SWEEPS, OMEGA)) return -1;
    if (solve_over(s)) return 0;
    int e = newton_init(&w, s);
    if (e) return e < 0 ? -1 : 0;
    if (STEPS * w.price <= inner->budget && !(e = solve_keep_best(s))) ipm_from(&w, s, GAP);
    newton_free(&w);
    return e;
}

/* A subset while it is solved */
struct subset {
    struct selection_contacts chosen;
    double *x, *v, *map; /* of all contacts: x and v [n d], the natural map [n] */
    struct delassus V;   /* of those chosen */
};

static void subset_free(struct subset *p)
{
    free(p->chosen.contact), free(p->chosen.of), free(p->x), free(p->v), free(p->map);
    delassus_free(&p->V);
}

/* Chooses the contacts and extracts their problem. Returns 1; 0 where there are too many, or the
   least that their Newton steps can cost is above the budget; -1 when memory is short. To be freed
   in any case. */
static int subset_init(struct subset *p, const struct scaled *a, const struct solve *s,
                       int64_t contacts, bool anyhow, double budget)
{
    size_t n = (size_t)a->W.n, size = (size_t)a->size + 4;
    struct failure failure = { 0 };
    *p = (struct subset){ 0 };
    p->x = calloc(size, sizeof *p->x), p->v = calloc(size, sizeof *p->v);
    p->map = calloc(n + 1, sizeof *p->map);
    p->chosen.contact = malloc((n + 1) * sizeof *p->chosen.contact);
    p->chosen.of = malloc((n + 1) * sizeof *p->chosen.of);
    if (!p->x || !p->v || !p->map || !p->chosen.contact || !p->chosen.of) return -1;
    scaled_get(a, s->p, p->x);
    scaled_velocity(a, p->x, p->v);
    double largest = fill_maps(a, p->x, p->v, p->map);
    if (!subset_choose(a, p->map, largest, contacts, anyhow, &p->chosen)) return 0;
    const struct selection_contacts chosen =
        p->chosen; /* clang-analyzer takes all of *p as const else */
    if (delassus_subset(&p->V, &a->W, &chosen, p->x, p->v, &failure)) return -1;
    double entries = delassus_entries(&p->V); // NOLINT(clang-analyzer-unix.Malloc): subset_free()
    return price_analysis(entries) + STEPS * price_newton_step(0, entries) <= budget;
}

/* Solves V, starting from its r; its reactions go into x of all contacts, its counts into the
   report. Returns 1; 0 where neither a Newton step was made nor the problem solved; -1 when memory
   is short. */
static int subset_solve_part(struct subset *p, struct solve *s, double budget)
{
    const struct inner inner = { { "subset", "", 0, subset_run }, budget };
    struct delassus *V = &p->V;
    struct problem q;
    struct failure failure = { 0 };
    struct report rep = { 0 };
    struct solve_opt o = *s->o;
    o.global = &inner.solver, o.criterion = CRITERION_NATURAL, o.eps = EXACT;
    o.max_sweeps = INT32_MAX, o.every_sweep = o.history = false, o.threads = 1, o.progress = NULL;
    o.device = NULL; // a subset is small
    if (o.max_seconds > 0) o.max_seconds = fmax(solve_seconds_left(s), 1e-9);
    if (problem_prepare_delassus(&q, V, &(struct prepare_opt){ .rho_factor = s->o->method->rho },
                                 &failure))
        return -1;
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
    int e = subset_init(&p, a, s, contacts, anyhow, budget);
    if (e > 0) e = subset_solve_part(&p, s, budget);
    if (e > 0) scaled_put(a, s, p.x);
    int64_t n = p.chosen.n;
    subset_free(&p);
    return e > 0 ? n : e;
}

int subset_fits(const struct scaled *a, const struct solve *s, int64_t contacts, bool anyhow,
                double budget)
{
    struct subset p;
    int e = subset_init(&p, a, s, contacts, anyhow, budget);
    subset_free(&p);
    return e;
}
