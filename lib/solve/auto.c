/*
 * auto.c: the solver that chooses. Sweeps are cheap and find which contacts hold, slide and part; where
 * they will not end soon a few contacts mostly hold them up, and those are solved by themselves. Where
 * that is not enough Newton on all contacts is, if it starts near enough, and where it does not, the
 * interior point method brings it there.
 *
 * What is measured on the way is how fast the criterion falls; prices are counted [solve/prices.h].
 */
#include "solve/anderson.h"
#include "solve/ipm.h"
#include "solve/nlgs.h"
#include "solve/prices.h"
#include "solve/subset.h"

#include <stdlib.h>
#include <string.h>

enum {
    CHUNK = 150,        /* sweeps between two looks, at least; else half of all so far */
    FIRST_SUBSET = 50,  /* contacts of the first subset */
    SUBSET_MOST = 250,  /* contacts of most first subsets */
    SUBSETS = 25,       /* subsets, at most */
    SETTLE = 50,        /* sweeps after each subset, at least */
    STEPS_TO_KNOW = 15, /* factorisations that sweeps must have cost before they are given up; */
    STEPS_IF_FAR = 5,   /* this many while the criterion is more than FAR times eps */
    SURE = 3,           /* times less of either where what is to come is as many times more */
    STEPS_TO_END = 25,  /* factorisations that the end will take, mostly */
    TRIES = 8,          /* from other sweeps, where the first have led nowhere, at most */
    MORE = 3,           /* times what had been spent then is what all tries may cost */
    LAST_RESORT = 20000 /* sweeps at most after that, when nothing else led there */
};

#define SUBSET_CONTACT 4e4  /* ns: what a contact of a small subset costs, mostly */
#define IN_VAIN        0.25 /* of all that a solve costs: what may be spent in vain beside sweeps */
#define AFFORD         3e10 /* ns: a factorisation dearer than this is not made */
#define CHEAP          2e8  /* ns: what the last resort may always take */
#define FAR            30   /* times eps: sweeps that have come nearer mostly end soon */

struct strategy {
    struct solve *s;
    struct anderson *sweeps;
    struct newton w; /* ready: assembled; its system is NULL before factors are made */
    double price;    /* of a sweep */
    bool ready, tried;
    double vain;      /* ns: what subsets that gained little have cost, */
    int64_t contacts; /* and how many contacts the next is to have */
    struct {          /* a chunk ago */
        double value;
        int32_t sweeps;
    } older;
    int32_t end; /* sweeps at most */
};

/*
 * How many more sweeps from this value, if it goes on as a power of their number, as it does on the way
 * from older.value; infinite where it does not fall.
 */
static double to_go(const struct strategy *a, double value)
{
    int32_t now = a->s->rep->sweeps;
    double p = log(a->older.value / value) / log((double)now / a->older.sweeps);
    return p > 0.1 ? now * (pow(value / a->s->o->eps, 1 / p) - 1) : INFINITY;
}

/* How many times the sweeps to come, `more`, are worth this price: at most SURE, and 0 below once. */
static double gain_of(const struct strategy *a, double more, double price)
{
    double gain = more * a->price / price;
    return gain < 1 ? 0 : fmin(gain, SURE);
}

/* ns: what may be spent in vain: a part of what was, and of what the sweeps to come would cost as long as that
   is no more */
static double allowance(const struct strategy *a, double more)
{
    double spent = a->s->rep->work;
    return IN_VAIN * (spent + fmin(more * a->price, spent));
}

/*
 * Subsets in turn with sweeps, for as long as the next costs less than what is left to sweep. After one
 * that gained little comes a larger one: a few contacts more often decide. Those that gained little may
 * have cost `vain` all together. Returns how many subsets there were; -1 when memory is short.
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
            more = SETTLE * log(now / s->o->eps) / log(before / now);
        } while (!solve_over(s) && more > 0 && more * a->price < cost);
        anderson_restore_best(a->sweeps);
        if (!(s->value < best / 4)) a->vain += cost, a->contacts += a->contacts / 5;
        best = fmin(best, s->value);
    }
    return subsets;
}

/*
 * From r = 0, by other sweeps each time: whether subsets suffice, or the path from their reactions
 * arrives, is chance.
 */
static int again(struct strategy *a)
{
    static const double omegas[] = { 1.3, 1.5, 1 };
    struct solve *s = a->s;
    double most = (1 + MORE) * s->rep->work;
    a->contacts = FIRST_SUBSET;
    for (int k = 0; k < TRIES && s->rep->work < most && !solve_over(s); k++) {
        double *none = calloc((size_t)a->w.a.size + 4, sizeof *none);
        if (!none) return -1;
        scaled_put(&a->w.a, s, none);
        free(none);
        int32_t sweeps = newton_sweeps_per_step(&a->w, s->p) * (k + 2) / 2;
        if (nlgs_sweeps(s, sweeps, s->o->relax > 0 ? s->o->relax : omegas[k % 3]) ||
            in_subsets(a, a->vain + most - s->rep->work) < 0)
            return -1;
        ipm_from(&a->w, s, k % 2 ? 1e-4 : 1e-3);
    }
    return 0;
}

/*
 * Newton, and where that is too far away the interior point method; what it left is Newton's again.
 * Between balls Newton seldom arrives by itself, and the sweeps that it wants between its steps cost as
 * much as the interior point method.
 */
static int factorise(struct strategy *a)
{
    struct solve *s = a->s;
    if (s->p->full) newton_polish(&a->w, s, 1e-4, 2);
    ipm_solve(&a->w, s);
    if (solve_over(s)) return 0;
    solve_restore_best(s);
    newton_polish(&a->w, s, 1e-4, 6);
    return again(a);
}

/* All contacts assembled, and the best iterate kept from now on. False where it is too large. */
static int make_ready(struct strategy *a)
{
    const char *reason;
    if (a->ready) return 0;
    int e = newton_assemble(&a->w, a->s, &reason);
    if (e) return e;
    a->ready = true;
    return solve_keep_best(a->s);
}

/* Is all of it factorised, where that costs `price`? The longer the way, the less it takes to be sure. */
static bool pays(const struct strategy *a, double more, double price)
{
    const struct solve *s = a->s;
    int steps = anderson_best_value(a->sweeps) > FAR * s->o->eps ? STEPS_IF_FAR : STEPS_TO_KNOW;
    return price <= AFFORD &&
           gain_of(a, more, STEPS_TO_END * price) * s->rep->sweeps * a->price >= steps * price;
}

/* Whether the factors of all contacts may pay: by the least that they can cost, for to find their fill has a
   price itself. */
static bool may_pay(const struct strategy *a, double more)
{
    if (a->w.system) return pays(a, more, a->w.price);
    return pays(a, more, system_price_least(&a->w.a)) &&
           system_price_new(&a->w.a) <= allowance(a, more);
}

/* What may be done instead of sweeps, `more` of which are to come: 0, or -1 when memory is short. Where
   nothing is, the sweeps do not notice. */
static int look_for_better(struct strategy *a, double more)
{
    struct solve *s = a->s;
    const char *reason;
    int e = make_ready(a);
    if (e) return a->tried = true, e < 0 ? -1 : 0;
    int fits = subset_fits(&a->w.a, s, a->contacts, false, allowance(a, more) - a->vain);
    if (fits < 0) return -1;
    if (!fits && !may_pay(a, more)) return 0;
    anderson_restore_best(a->sweeps);
    int subsets = in_subsets(a, allowance(a, more));
    if (subsets < 0) return -1;
    if (solve_over(s)) return 0;
    if (subsets) a->older.sweeps = 0; // what these sweeps gained says nothing of the next
    if (!may_pay(a, more)) return 0;
    if (!a->w.system && (e = newton_factors(&a->w, s, &reason)))
        return a->tried = true, e < 0 ? -1 : 0;
    if (!pays(a, more, a->w.price)) return 0;
    if (factorise(a)) return -1;
    a->tried = true;
    double rest = fmin(fmax(s->rep->work, CHEAP) / a->price, LAST_RESORT);
    if (a->end - s->rep->sweeps > rest) a->end = s->rep->sweeps + (int32_t)rest;
    return 0;
}

static int choose(struct strategy *a)
{
    struct solve *s = a->s;
    const struct report *rep = s->rep;
    // what a subset costs, mostly: sweeps go on by themselves until they have cost that
    double least = fmin((double)s->p->n, SUBSET_MOST) * SUBSET_CONTACT;
    while (rep->sweeps < a->end && !solve_over(s)) {
        int32_t had = rep->sweeps, chunk = had / 2 > CHUNK ? had / 2 : CHUNK;
        double before = anderson_best_value(a->sweeps);
        if (anderson_sweeps(a->sweeps, chunk < a->end - had ? chunk : a->end - had)) return -1;
        if (!isfinite(s->value)) break;
        double more = a->older.sweeps ? to_go(a, anderson_best_value(a->sweeps)) : 0;
        a->older.value = before, a->older.sweeps = had;
        if (a->tried || gain_of(a, more, least) * rep->sweeps * a->price < least) continue;
        if (look_for_better(a, more)) return -1;
    }
    anderson_restore_best(a->sweeps);
    return 0;
}

static int run(struct solve *s)
{
    struct strategy a = { .s = s,
                          .sweeps = anderson_new(s),
                          .price = price_sweep(s->p),
                          .contacts = FIRST_SUBSET,
                          .older.value = INFINITY,
                          .end = s->o->max_sweeps };
    if (!a.sweeps) return -1;
    int failed = choose(&a);
    if (a.ready) newton_free(&a.w);
    anderson_free(a.sweeps);
    return failed;
}

const struct solver solver_auto = {
    "auto", "sweeps, and factorisations of some or all contacts where they pay", 0, run
};
