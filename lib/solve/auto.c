/*
 * solve/auto.c: the solver that chooses between the others. Sweeps are cheap and find which
 * contacts stick, slide and open. Where they will not end soon, mostly a few contacts hold them up,
 * and these are solved by themselves. Where that is not enough, Newton's method on all contacts
 * finishes if it starts near enough, and else the interior point method brings it near.
 *
 * The choice rests on how fast the criterion falls, and on prices that are counted
 * [solve/solver.h].
 */

#include "solve/anderson.h"
#include "solve/exchange.h"
#include "solve/ipm.h"
#include "solve/nlgs.h"
#include "solve/scaled.h"
#include "solve/solver.h"
#include "solve/subset.h"

#include <stdlib.h>
#include <string.h>

/*
 * Where a few contacts of faces begin. Their reactions, and with friction the motion too, are often not
 * unique; a sweep, which begins somewhere, then prefers one corner to another, and a box between two plates turns
 * as it slides. Steps in which all contacts move at once,
 *
 *     x <- P(y - v^(y)/lambda),   v = W y + q,   lambda = |W|,
 *
 * with y ahead of x by Nesterov's momentum, prefer none: a symmetric problem keeps its symmetry to rounding, in
 * whatever order its contacts are. What sweeps find from there lies next to it.
 */

/* Is the problem one of few contacts with faces? The same in every process that has a part of it. */
static bool even_concerns(const struct problem *p);
/* Makes such steps from the iterate, a bounded number, and judges. Returns 0, or -1 when memory is short. */
static int even_start(struct solve *s);

/* ---- steps of all contacts at once ---- */

enum {
    CONTACTS = 32,   /* at most: more have their symmetry, if any, broken by where they lie */
    WORK = 4000000,  /* products of numbers in a start, at most: some ms */
    POWER_STEPS = 30 /* to find |W| */
};

/* Over |W| as the power method finds it, which is from below */
static const double SAFE = 1.05;
/* Of eps: less is not worth a step */
static const double ENOUGH = 0.1;

static bool even_concerns(const struct problem *p)
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

static int even_start(struct solve *s)
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

enum {
    CHUNK = 150,        /* sweeps before each choice, at least; else half of all so far */
    FIRST_SUBSET = 50,  /* contacts of the first subset, at least; 100 are slower */
    SUBSET_USUAL = 250, /* contacts that a first subset seldom exceeds: for its price */
    SUBSETS = 25,       /* subsets in a row, at most */
    SETTLE = 50,        /* sweeps after each subset, at least */
    STEPS_TO_KNOW = 15, /* factorisations that sweeps have cost before all is factorised */
    STEPS_IF_FAR = 5,   /* the same while the criterion is more than FAR times eps */
    SURE = 3, /* factor by which sweeps may have cost less where there is much to gain, at most */
    STEPS_TO_END = 25, /* factorisations that it takes to the end, mostly */
    RETRIES = 8,       /* attempts from other sweeps where the first has failed, at most */
    RETRY_COST = 3,    /* cost of all retries, at most, in multiples of all that was spent before */
    LAST_SWEEPS = 20000, /* sweeps at most after that */
    CHUNKS_MAX = 64,     /* chunks of a solve whose end is remembered */
    WANDER_FROM = 10000  /* sweeps that nothing is given up before */
};

#define SUBSET_CONTACT 4e4  /* ns a contact of a small subset, mostly */
#define IN_VAIN        0.25 /* of all that a solve costs: may be spent without gain beside sweeps */
#define AFFORD         3e10 /* ns: a factorisation that costs more is not made */
#define CHEAP          2e8  /* ns that the last sweeps may always take */
#define FAR            30   /* times eps: sweeps that have come nearer mostly end soon */
#define WANDER_MAP     1e-4 /* natural map from which on sweeps may wander */
#define WANDER         0.75 /* of the best map of a quarter of the sweeps: it has to fall below */

struct strategy {
    struct solve *s;
    struct anderson *sweeps;
    struct newton w;  /* its system is NULL before the factors are made */
    double price;     /* ns of a sweep */
    bool ready;       /* w is assembled */
    bool tried;       /* all contacts were factorised, or cannot be: only sweeps remain */
    double vain;      /* ns that subsets have cost which gained little */
    int64_t contacts; /* contacts of the next subset, at least */
    struct {          /* a chunk ago: the best criterion, and the sweeps made */
        double value;
        int32_t sweeps;
    } older;
    int32_t sweeps_max; /* of the whole solve */
    int chunks;
    struct { /* after each chunk: the sweeps made, and their best criterion so far */
        int32_t sweeps;
        double value;
    } chunk[CHUNKS_MAX];
};

/*
 * How many more sweeps it takes from this value of the criterion to eps, if the criterion falls as
 * a power of their number, with the exponent since older.value; INFINITY where it hardly falls.
 */
static double sweeps_to_come(const struct strategy *a, double value)
{
    int32_t now = a->s->rep->sweeps;
    double p = log(a->older.value / value) / log((double)now / a->older.sweeps);
    return p > 0.1 ? now * (pow(value / solve_target(a->s), 1 / p) - 1) : INFINITY;
}

/* The price of the sweeps to come, `more`, over this price (ns): at most SURE, and 0 below 1 */
static double gain(const struct strategy *a, double more, double price)
{
    double ratio = more * a->price / price;
    return ratio < 1 ? 0 : fmin(ratio, SURE);
}

/* ns that may be spent without gain: a fraction of what was spent so far, and of what the sweeps
   to come would cost, counted as no more than that */
static double allowance(const struct strategy *a, double more)
{
    double spent = a->s->rep->work;
    return IN_VAIN * (spent + fmin(more * a->price, spent));
}

/*
 * Solves subsets in turn with sweeps; sweeps go on after a subset while what is left to sweep costs
 * less than the subset did. After a subset that gained little comes a larger one: a few more
 * contacts often decide. Subsets that gained little may cost `vain` ns in all. Returns the number
 * of subsets, -1 when memory is short.
 */
static int in_subsets(struct strategy *a, double vain)
{
    struct solve *s = a->s;
    double best = s->value;
    int subsets = 0;
    for (; !solve_over(s) && isfinite(s->value) && subsets < SUBSETS && a->vain < vain; subsets++) {
        double more, before_all = s->rep->work;
        int64_t solved = subset_solve(&a->w.a, s, a->contacts, subsets > 0, vain - a->vain);
        if (solved < 0) return -1;
        double cost = s->rep->work - before_all;
        if (!solved) return a->vain += cost, subsets;
        anderson_restart(a->sweeps);
        double now = s->value;
        do {
            double before = now;
            if (anderson_sweeps(a->sweeps, SETTLE)) return -1;
            now = anderson_best_value(a->sweeps);
            more = SETTLE * log(now / solve_target(s)) / log(before / now);
        } while (!solve_over(s) && more > 0 && more * a->price < cost);
        anderson_restore_best(a->sweeps);
        if (!(s->value < best / 4)) a->vain += cost, a->contacts += a->contacts / 5;
        best = fmin(best, s->value);
    }
    return subsets;
}

/*
 * New attempts from r = 0 with other sweeps each time: whether subsets suffice, or the path from
 * their reactions reaches the solution, is chance.
 */
static int try_again(struct strategy *a)
{
    static const double omegas[] = { 1.3, 1.5, 1 };
    struct solve *s = a->s;
    double work_max = (1 + RETRY_COST) * s->rep->work;
    a->contacts = FIRST_SUBSET;
    for (int k = 0; k < RETRIES && s->rep->work < work_max && !solve_over(s); k++) {
        double *none = calloc((size_t)a->w.a.size + 4, sizeof *none);
        if (!none) return -1;
        scaled_put(&a->w.a, s, none);
        free(none);
        int32_t sweeps = newton_sweeps_per_step(&a->w, s->p) * (k + 2) / 2;
        if (nlgs_sweeps(s, sweeps, s->o->relax > 0 ? s->o->relax : omegas[k % 3]) ||
            in_subsets(a, a->vain + work_max - s->rep->work) < 0)
            return -1;
        ipm_from(&a->w, s, k % 2 ? 1e-4 : 1e-3);
    }
    return 0;
}

/*
 * All contacts by Newton's method, by the interior point method where that is too far from the
 * solution, and by Newton again from what the latter has reached. Between balls Newton seldom
 * succeeds at first, and the sweeps between its steps cost as much as the interior point method, so
 * there it is not tried.
 */
static int factorise(struct strategy *a)
{
    struct solve *s = a->s;
    if (s->p->kind.full) newton_polish(&a->w, s, 1e-4, 2);
    ipm_solve(&a->w, s);
    if (solve_over(s)) return 0;
    solve_restore_best(s);
    newton_polish(&a->w, s, 1e-4, 6);
    return try_again(a);
}

/* Assembles all contacts, and keeps the best iterate from now on. Returns 0; 1 where the problem is
   too large, -1 when memory is short. */
static int make_ready(struct strategy *a)
{
    if (a->ready) return 0;
    int e = newton_assemble(&a->w, a->s);
    if (e) return e;
    a->ready = true;
    return solve_keep_best(a->s);
}

/* Whether all contacts are to be factorised, where a Newton step costs `price` ns. The more sweeps
   are to come, the fewer must have been made. */
static bool pays(const struct strategy *a, double more, double price)
{
    const struct solve *s = a->s;
    int steps =
        anderson_best_value(a->sweeps) > FAR * solve_target(s) ? STEPS_IF_FAR : STEPS_TO_KNOW;
    return price <= AFFORD &&
           gain(a, more, STEPS_TO_END * price) * s->rep->sweeps * a->price >= steps * price;
}

/* Whether the factors of all contacts may pay. Before their fill is known, which has a price
   itself, judged by the least that they can cost */
static bool may_pay(const struct strategy *a, double more)
{
    if (a->w.system) return pays(a, more, a->w.price);
    return pays(a, more, system_price_least(&a->w.a)) &&
           system_price_new(&a->w.a) <= allowance(a, more);
}

/* Tries what may be better than the `more` sweeps to come. Where nothing is, the sweeps are not
   disturbed. Returns 0, or -1 when memory is short. */
static int look_for_better(struct strategy *a, double more)
{
    struct solve *s = a->s;
    int e = make_ready(a);
    if (e) return a->tried = true, e < 0 ? -1 : 0;
    int fits = subset_fits(&a->w.a, s, a->contacts, false, allowance(a, more) - a->vain);
    if (fits < 0) return -1;
    if (!fits && !may_pay(a, more)) return 0;
    anderson_restore_best(a->sweeps);
    int subsets = in_subsets(a, allowance(a, more));
    if (subsets < 0) return -1;
    if (solve_over(s)) return 0;
    if (subsets) a->older.sweeps = 0; // the gain so far says nothing about the next sweeps
    if (!may_pay(a, more)) return 0;
    if (!a->w.system && (e = newton_factors(&a->w, s))) return a->tried = true, e < 0 ? -1 : 0;
    if (!pays(a, more, a->w.price)) return 0;
    if (factorise(a)) return -1;
    a->tried = true;
    double rest = fmin(fmax(s->rep->work, CHEAP) / a->price, LAST_SWEEPS);
    if (a->sweeps_max - s->rep->sweeps > rest) a->sweeps_max = s->rep->sweeps + (int32_t)rest;
    return 0;
}

/*
 * Whether the sweeps wander: in a large pile friction makes their fixed points repel, along motions of
 * much of the pile that hardly change the velocities at the contacts, and they stay at some distance for
 * ever [nsd-convergence(7), STAGNATION]. Then four times the sweeps have hardly improved the best map. Only
 * below a map that is small already, where a chain of contacts that drifts no longer decides.
 */
static bool wanders(struct strategy *a)
{
    const struct solve *s = a->s;
    double best = anderson_best_value(a->sweeps);
    int32_t now = s->rep->sweeps;
    if (a->chunks < CHUNKS_MAX) {
        a->chunk[a->chunks].sweeps = now, a->chunk[a->chunks].value = best;
        a->chunks++;
    }
    if (s->o->criterion != CRITERION_NATURAL || now < WANDER_FROM || best > WANDER_MAP)
        return false;
    int k = a->chunks - 1;
    while (k >= 0 && a->chunk[k].sweeps > now / 4) k--;
    return k >= 0 && best > WANDER * a->chunk[k].value;
}

static const char wander[] = "the sweeps wander, more come no nearer";

/* Sweeps in chunks, with a look for something better after each. 0, or -1 when memory is short */
static int sweep_and_choose(struct strategy *a)
{
    struct solve *s = a->s;
    const struct report *rep = s->rep;
    // what a subset costs, mostly: until the sweeps have cost as much nothing else is tried
    double least = fmin((double)s->p->n, SUBSET_USUAL) * SUBSET_CONTACT;
    while (rep->sweeps < a->sweeps_max && !solve_over(s)) {
        int32_t had = rep->sweeps, chunk = had / 2 > CHUNK ? had / 2 : CHUNK;
        double before = anderson_best_value(a->sweeps);
        if (anderson_sweeps(a->sweeps, chunk < a->sweeps_max - had ? chunk : a->sweeps_max - had))
            return -1;
        if (!isfinite(s->value)) break;
        double more = a->older.sweeps ? sweeps_to_come(a, anderson_best_value(a->sweeps)) : 0;
        a->older.value = before, a->older.sweeps = had;
        if (!a->tried && gain(a, more, least) * rep->sweeps * a->price >= least) {
            if (s->p->exchange && s->p->exchange->may_want) {
                s->p->exchange->wants_whole = true;
                break;
            }
            if (!s->p->exchange && look_for_better(a, more)) return -1;
        }
        if (!solve_over(s) && wanders(a)) {
            s->rep->given_up = wander;
            break;
        }
    }
    anderson_restore_best(a->sweeps);
    return 0;
}

static int auto_run(struct solve *s)
{
    if (s->p->kind.extra) return solver_anderson.run(s); // W is none that could be factorised
    if (even_concerns(s->p)) {
        struct exchange *others = s->p->exchange;
        if (others && others->may_want) return others->wants_whole = true, 0;
        if (!others && even_start(s)) return -1;
    }
    struct strategy a = { .s = s,
                          .sweeps = anderson_new(s),
                          .price = price_sweep(s->p),
                          .contacts = FIRST_SUBSET,
                          .older.value = INFINITY,
                          .sweeps_max = s->o->max_sweeps };
    if (!a.sweeps) return -1;
    int failed = sweep_and_choose(&a);
    if (a.ready) newton_free(&a.w);
    anderson_free(a.sweeps);
    return failed;
}

const struct solver solver_auto = {
    "auto", "sweeps, and factorisations of some or all contacts where they pay", 0, auto_run
};
