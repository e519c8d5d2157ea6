/*
 * solve/auto.c: the solver that chooses. Sweeps are cheap and find which contacts hold, slide and part; where
 * they will not end soon a few contacts mostly hold them up, and those are solved by themselves. Where
 * that is not enough Newton on all contacts is, if it starts near enough, and where it does not, the
 * interior point method brings it there.
 *
 * What is measured on the way is how fast the criterion falls; prices are counted, not timed, so that
 * the same problem is solved the same way everywhere.
 */
#include "solve/ipm.h"
#include "solve/subset.h"

#include <stdlib.h>
#include <string.h>

enum {
    CHUNK = 150,        /* sweeps between two looks, at least; else half of all so far */
    PART = 50,          /* contacts of the first part, */
    ALL_PARTS = 250,    /* of all together, mostly, */
    PARTS = 25,         /* parts at most, */
    SETTLE = 50,        /* and sweeps after each, at least */
    STEPS_TO_KNOW = 15, /* factorisations that sweeps must have cost before they are given up; */
    STEPS_IF_FAR = 5,   /* this many while the criterion is FAR times eps, */
    SURE = 3,           /* or so many times less where there is no end to them */
    TRIES = 8,          /* from other sweeps, where the first have led nowhere; and */
    MORE = 3,           /* times what had been spent then is what all may cost */
    STEPS_TO_END = 25,  /* factorisations that the end will take, or so */
    LAST_RESORT = 20000 /* sweeps at most, for what that cost, when nothing else led there */
};

#define AFFORD  3e10 /* ns: a factorisation dearer than this is not made, */
#define CHEAP   2e8  /* ns: and so much the last resort may always take */
#define CONTACT 4e4  /* ns, or so, of a part's cost */
#define FAR     30   /* of eps: sweeps that have come nearer mostly end soon */

/*
 * How many more sweeps from this value, if it goes on as a power of their number, as it does on the way
 * from `before` after so many; infinite where it does not fall.
 */
static double to_go(const struct solve *s, double value, double before, int32_t sweeps)
{
    double p = log(before / value) / log((double)s->rep->sweeps / sweeps);
    return p > 0.1 ? s->rep->sweeps * (pow(value / s->o->eps, 1 / p) - 1) : INFINITY;
}

static bool over(const struct solve *s)
{
    return solve_met(s) || solve_spent(s);
}

/* What a solve has cost so far, ns or so */
static double effort(const struct newton *w, const struct report *rep)
{
    return (double)(rep->newton - w->aside) * w->cost + rep->sweeps * w->sweep_cost;
}

/*
 * Parts in turn with sweeps, for as long as a part costs less than what is left to sweep. After one that
 * gained little comes a larger one: a few contacts more often decide. Those that gained little may have
 * as many contacts as there are, all together. Returns how many parts there were; -1 when memory is
 * short.
 */
static int in_parts(struct newton *w, struct solve *s, struct anderson *sweeps)
{
    int64_t contacts = PART, vain = 0, solved;
    double best = s->value;
    int parts = 0;
    for (; !over(s) && isfinite(s->value) && vain < s->p->n && parts < PARTS; parts++) {
        double more;
        if (!(solved = subset_solve(w, s, contacts, parts > 0))) break;
        anderson_anew(sweeps);
        double now = s->value;
        do {
            double before = now;
            if (anderson_sweeps(sweeps, SETTLE)) return -1;
            now = anderson_best(sweeps);
            more = SETTLE * log(now / s->o->eps) / log(before / now);
        } while (!over(s) && more > 0 && more * w->sweep_cost < (double)solved * CONTACT);
        anderson_back(sweeps);
        if (!(s->value < best / 4)) vain += solved, contacts += contacts / 5;
        best = fmin(best, s->value);
    }
    return parts;
}

/*
 * From r = 0, by other sweeps each time: whether parts suffice, or the path from their reactions
 * arrives, is chance.
 */
static void again(struct newton *w, struct solve *s, struct anderson *sweeps)
{
    static const double omegas[] = { 1.3, 1.5, 1 };
    double most = MORE * effort(w, s->rep);
    for (int k = 0; k < TRIES && effort(w, s->rep) < most; k++) {
        if (over(s)) return;
        memset(w->x, 0, (size_t)w->whole.size * sizeof *w->x);
        newton_put(w, s);
        nlgs_sweeps(s, newton_share(w) * (k + 2) / 2,
                    s->o->relax > 0 ? s->o->relax : omegas[k % 3]);
        if (in_parts(w, s, sweeps) < 0) return;
        ipm_from(w, s, k % 2 ? 1e-4 : 1e-3);
    }
}

/*
 * Newton, and where that is too far away the interior point method; what it left is Newton's again.
 * Between balls Newton seldom arrives by itself, and the sweeps that it wants between its steps cost as
 * much as the interior point method.
 */
static void factorise(struct newton *w, struct solve *s, struct anderson *sweeps)
{
    if (s->p->full) newton_polish(w, s, 1e-4, 2);
    ipm_solve(w, s);
    if (over(s)) return;
    newton_back(w, s);
    newton_polish(w, s, 1e-4, 6);
    again(w, s, sweeps);
}

static int run(struct solve *s)
{
    const struct report *rep = s->rep;
    struct newton w = { 0 };
    struct anderson *sweeps = anderson_new(s);
    struct { // a chunk ago
        double value;
        int32_t sweeps;
    } older = { INFINITY, 0 };
    bool ready = false, parted = false, tried = false;
    int failed = 0;
    int32_t end = s->o->max_sweeps;
    // Sweeps go on by themselves until they have cost, and will, what the parts would.
    double price = newton_sweep_cost(s->p), dear = fmin((double)s->p->n, ALL_PARTS) * CONTACT;
    if (!sweeps) return nlgs_sweeps(s, end, s->o->relax > 0 ? s->o->relax : 1);
    while (!failed && rep->sweeps < end && !over(s)) {
        int32_t had = rep->sweeps, chunk = had / 2 > CHUNK ? had / 2 : CHUNK;
        double before = anderson_best(sweeps);
        failed = anderson_sweeps(sweeps, chunk < end - had ? chunk : end - had);
        if (failed || !isfinite(s->value)) break;
        double more = older.sweeps ? to_go(s, anderson_best(sweeps), older.value, older.sweeps) : 0;
        older.value = before, older.sweeps = had;
        if (tried || fmin(more, rep->sweeps) * price < dear) continue;
        anderson_back(sweeps);
        if (!ready && newton_assemble(&w, s->p)) { // too large for it
            tried = true;
            continue;
        }
        ready = true;
        if (!parted) {
            int parts = in_parts(&w, s, sweeps);
            failed = parts < 0;
            parted = parts > 0;
            if (failed || over(s)) break;
            if (parted) older.sweeps = 0; // what these sweeps gained says nothing of the next
        }
        if (!w.system && newton_factors(&w)) {
            tried = true;
            continue;
        }
        // the longer the way, the less it takes to be sure of it
        double gain = fmin(more * price / (STEPS_TO_END * w.cost), SURE);
        int steps = s->value > FAR * s->o->eps ? STEPS_IF_FAR : STEPS_TO_KNOW;
        if (w.cost > AFFORD || gain < 1 || gain * rep->sweeps * price < steps * w.cost) continue;
        factorise(&w, s, sweeps);
        tried = true;
        double spent = fmax(effort(&w, rep), CHEAP);
        double rest = fmin(spent / price, LAST_RESORT);
        if (end - rep->sweeps > rest) end = rep->sweeps + (int32_t)rest;
    }
    anderson_back(sweeps);
    if (ready) {
        newton_back(&w, s);
        newton_free(&w);
    }
    anderson_free(sweeps);
    return failed;
}

const struct solver solver_auto = { "auto", 0, run };
