/* solve/subset.c: see solve/subset.h. */
#include "solve/subset.h"

#include "solve/ipm.h"

#include <stdlib.h>
#include <string.h>

#define LARGE 0.1   /* of the largest natural map of a contact */
#define EXACT 1e-13 /* the natural map of a part's solution */

enum { SWEEPS = 100 }; /* of a part, before its interior point */

struct chosen {
    int64_t n;
    int32_t *contact; /* [n] ascending: contact i of the part is contact[i] of all, */
    int32_t *of;      /* [all] and of[] tells which it is; -1: none */
};

/* |x_c - P(x_c - v^_c)| of each contact, of the rows' reactions; the largest */
static double maps(struct newton *w, double *map)
{
    const struct delassus *W = &w->whole.W;
    double largest = 0;
    scaled_velocity(&w->whole, w->x, w->v);
    for (int64_t c = 0; c < W->n; c++) {
        double r[3], u[3], tau[3], p[3], off = 0;
        scaled_load(W->d, w->x + W->d * c, r), scaled_load(W->d, w->v + W->d * c, u);
        cone_predict(W->mu[c], 1, r, u, tau);
        cone_project(W->mu[c], tau, p);
        for (int k = 0; k < 3; k++) off += (r[k] - p[k]) * (r[k] - p[k]);
        map[c] = sqrt(off);
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

/* At least so many contacts: those where the map is large, as many around them, or more. */
static bool choose(struct newton *w, int64_t least, bool anyhow, struct chosen *p)
{
    const struct delassus *W = &w->whole.W;
    double *map = w->z, largest = maps(w, map), large = LARGE * largest;
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

/* A few sweeps and the first way of the interior point: what they do not solve is better asked of a
   larger part than of more ways. */
static int run(struct solve *s)
{
    struct newton w;
    if (nlgs_sweeps(s, SWEEPS, 1.3)) return -1;
    if (solve_met(s) || solve_spent(s) || newton_init(&w, s->p)) return 0;
    ipm_from(&w, s, 1e-3);
    newton_back(&w, s);
    newton_free(&w);
    return 0;
}

/* V's solution, from its r, into w's x and the report. False when memory is short. */
static bool solve(struct newton *w, const struct solve *s, const struct chosen *p,
                  struct delassus *V)
{
    static const struct solver inner = { "part", 0, run };
    struct problem q;
    struct why why = { 0 };
    struct report rep = { 0 };
    struct solve_opt o = *s->o;
    o.global = &inner, o.criterion = CRITERION_NATURAL, o.eps = EXACT, o.max_sweeps = INT32_MAX;
    o.every_sweep = o.history = false, o.threads = 1, o.progress = NULL;
    if (o.max_seconds > 0)
        o.max_seconds = fmax(o.max_seconds - (report_seconds(CLOCK_WALL) - s->start), 1e-9);
    if (problem_prepare_delassus(&q, V, 0, s->o->method->rho, ORDER_NATURAL, &why)) return false;
    bool good = !solve_problem(&q, &o, &rep);
    problem_free(&q);
    for (int64_t i = 0; good && i < p->n; i++)
        memcpy(w->x + V->d * p->contact[i], V->r + V->d * i, (size_t)V->d * sizeof *w->x);
    s->rep->newton += rep.newton, w->aside += rep.newton;
    s->rep->safeguarded += rep.safeguarded, s->rep->gave_up += rep.gave_up;
    return good;
}

int64_t subset_solve(struct newton *w, struct solve *s, int64_t contacts, bool anyhow)
{
    const struct delassus *W = &w->whole.W;
    struct chosen p = { 0 };
    struct delassus V = { 0 };
    struct why why = { 0 };
    size_t bytes = ((size_t)W->n + 1) * sizeof(int32_t);
    p.contact = malloc(bytes), p.of = malloc(bytes);
    newton_get(w, s);
    bool good = p.contact && p.of && choose(w, contacts, anyhow, &p) &&
                !delassus_part(&V, W, p.n, p.contact, p.of, w->x, w->v, &why);
    good = good && solve(w, s, &p, &V);
    if (good) newton_put(w, s);
    delassus_free(&V), free(p.contact), free(p.of);
    return good ? p.n : 0;
}
