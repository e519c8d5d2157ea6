/*
 * solve/nlgs.c: the non-linear Gauss-Seidel method [paper, 3.1]: sweep over the contacts, each
 * solved by a local method with the others held still, until the criterion is met.
 */
#include "solve/nlgs.h"

#include "base/team.h"
#include "solve/backend.h"
#include "solve/device.h"
#include "solve/exchange.h"
#include "solve/solver.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

enum {
    CHECK_FIRST = 40,      /* first sweeps of a solve, all judged: easy problems end there */
    CHECK_EVERY = 25,      /* sweeps from one judgement to the next, at most */
    FORESIGHT = 4,         /* factor by which the change is taken to fall in a sweep, at most */
    CHEAP_FORESIGHT = 1000 /* the same for problems in a near cache, where storing u costs little */
};

/* Adds one thread's counts to the report; returns its largest change of a normal velocity, m/s. */
static double add_tally(struct report *rep, const struct tally *t)
{
    rep->newton += (int64_t)bundle_sum(t->newton);
    rep->safeguarded += (int64_t)bundle_sum(t->safeguarded);
    rep->gave_up += (int64_t)bundle_sum(t->gave_up);
    return bundle_max(t->change);
}

/* Sweeps that a team makes */
struct round {
    struct problem *p;
    sweep_text *text;
    struct sweep_opt quiet, last; /* of all but the last sweep, and of that */
    int32_t sweeps;
    pthread_mutex_t lock; /* of what follows */
    struct report *rep;
    double change; /* m/s: the largest of a normal velocity in the last sweep */
};

static void make_round(void *arg, int me, int threads)
{
    struct round *r = arg;
    struct tally t = { 0 };
    for (int32_t k = r->sweeps - 1; k >= 0; k--) {
        memset(t.change, 0, sizeof t.change);
        r->text(r->p, me, threads, k ? &r->quiet : &r->last, &t);
    }
    pthread_mutex_lock(&r->lock);
    r->change = fmax(r->change, add_tally(r->rep, &t));
    pthread_mutex_unlock(&r->lock);
}

/* The same by a device; returns the change, NaN where the device is lost */
static double sweep_there(const struct round *r)
{
    struct tally t = { 0 };
    for (int32_t k = r->sweeps - 1; k >= 0; k--) {
        memset(t.change, 0, sizeof t.change);
        device_sweep(r->p, k ? &r->quiet : &r->last, &t);
    }
    double change = add_tally(r->rep, &t);
    return r->p->device->lost.status ? NAN : change;
}

/* omega of the last sweep that may be made: 1, for the iterate is kept, and an over-relaxed one may have more energy than
   the step began with. */
static double last_omega(const struct solve *s, double omega, int32_t n)
{
    return n >= s->o->max_sweeps && !(s->o->relax > 0) ? 1 : omega;
}

/* `unjudged` sweeps and one more, which stores u if `keep`. Counts them in the report; returns the
   largest change of a normal velocity in the last one, m/s. */
static double nlgs_sweep_once(struct solve *s, double omega, int32_t unjudged, bool keep)
{
    const struct solve_opt *o = s->o;
    struct round r = { .p = s->p,
                       .text = backend_widest()->sweep->sweep[o->method->id][s->p->kind.id],
                       .quiet = { o->local, omega, false },
                       .last = { o->local, last_omega(s, omega, s->rep->sweeps + unjudged + 1),
                                 keep },
                       .sweeps = unjudged + 1,
                       .lock = PTHREAD_MUTEX_INITIALIZER,
                       .rep = s->rep };
    s->rep->sweeps += unjudged + 1, s->rep->work += (unjudged + 1) * price_sweep(s->p);
    s->renewed = false;
    if (s->p->device) return sweep_there(&r);
    team_do(problem_team(s->p, o->threads), make_round, &r);
    return s->p->exchange ? s->p->exchange->most(s->p->exchange, r.change) : r.change;
}

/*
 * `unjudged` sweeps and one that may be judged: if it is one of a solve's first 40, if its largest
 * change says that the criterion may be met, after 25 sweeps without, or if it is the last. Only
 * then is the local method's u needed, so sweeps that will hardly be judged do not store it.
 * Returns as nlgs_sweep().
 */
static int judged_sweep(struct solve *s, double omega, int32_t unjudged, bool last, struct watch *w)
{
    s->believes = s->o->method->believes;
    int32_t n = s->rep->sweeps + unjudged + 1;
    bool sure = s->o->history || s->o->every_sweep || n <= w->judge_all_until ||
                n - w->last_judged >= CHECK_EVERY || n >= s->o->max_sweeps || n == s->enough ||
                last;
    bool keep =
        sure ||
        w->change <= (problem_bundles(s->p) < FAR_BUNDLES ? CHEAP_FORESIGHT : FORESIGHT) * w->due;
    double change = w->change = nlgs_sweep_once(s, omega, unjudged, keep && s->believes);
    w->just_judged = false;
    if (solve_history(s)) return -1;
    if (!sure && !(keep && change <= w->due)) return 0;
    solve_judge(s);
    // criterion and change fall together, roughly: judge again half way to eps (on a logarithmic
    // scale), and after every sweep when near
    double target = solve_target(s);
    w->due = s->value < 1.3 * target ? INFINITY : change * sqrt(target / s->value);
    w->last_judged = n, w->just_judged = true;
    return solve_met(s) || solve_spent(s) || !isfinite(s->value);
}

int nlgs_sweep(struct solve *s, double omega, struct watch *w)
{
    return judged_sweep(s, omega, 0, false, w);
}

/*
 * The number of sweeps that need no judgement: as many as leave the change too large for one even
 * if each divides it by FORESIGHT. Only by halves, whose two threads then run on without meeting
 * after every sweep; else 0
 */
static int32_t nlgs_foresee(const struct solve *s, const struct watch *w, int32_t end)
{
    int32_t n = s->rep->sweeps, next = w->last_judged + CHECK_EVERY;
    if (!problem_halves(s->p) || s->o->history || s->o->every_sweep || n < w->judge_all_until ||
        !(w->change > w->due))
        return 0;
    if (next > end) next = end;
    if (next > s->o->max_sweeps) next = s->o->max_sweeps;
    return (int32_t)fmin(log(w->change / w->due) / log(FORESIGHT), next - 1 - n);
}

int nlgs_sweeps(struct solve *s, int32_t sweeps, double omega)
{
    int32_t end = s->rep->sweeps + sweeps;
    struct watch w = { .due = INFINITY,
                       .last_judged = s->rep->sweeps,
                       .judge_all_until = CHECK_FIRST };
    while (s->rep->sweeps < end) {
        int32_t unjudged = nlgs_foresee(s, &w, end);
        int over = judged_sweep(s, omega, unjudged, s->rep->sweeps + unjudged == end - 1, &w);
        if (over) return over < 0 ? -1 : 0;
    }
    return 0;
}

static int nlgs_run(struct solve *s)
{
    return nlgs_sweeps(s, s->o->max_sweeps, s->o->relax > 0 ? s->o->relax : 1);
}

const struct solver solver_nlgs = { "nlgs", "Gauss-Seidel: sweeps of a local method", 1, nlgs_run };
