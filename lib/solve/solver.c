/* solve/solver.c: the table of solvers, and what they share [solve/solver.h]. */
#include "solve/solver.h"

#include "base/team.h"
#include "solve/apply.h"
#include "solve/backend.h"
#include "solve/device.h"
#include "solve/err.h"
#include "solve/exchange.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- one point and its value ---- */

int best_init(struct best *b, int64_t size)
{
    *b = (struct best){ INFINITY, size, malloc(((size_t)size + 1) * sizeof *b->x), -1 };
    return b->x ? 0 : -1;
}

void best_free(struct best *b)
{
    free(b->x);
    *b = (struct best){ .value = INFINITY };
}

double *best_offer(struct best *b, double value)
{
    if (!b->x || !(value < b->value)) return NULL;
    b->value = value;
    return b->x;
}

void best_forget(struct best *b)
{
    b->value = INFINITY;
}

/* ---- the prices that were measured, and the formulas over them ---- */

#define SWEEP_BLOCK    2.0 /* ns per sweep, beyond kind.ns, for each block of W beside the diagonal, */
#define SWEEP_COMMON   2.0   /* and for each column of J */
#define ENTRY          14.0  /* ns an entry of the pattern, to assemble it and to multiply by it */
#define ASSEMBLY_ENTRY 15.0  /* ns an entry of W, to make its blocks and scale them */
#define ANALYSIS_ENTRY 150.0 /* ns an entry, for the two orders that base/matrix.c tries */

/* A Newton step over its factorisation at 1 ns a multiplication: substitutions and refinement take
   half as much again. With 1 or with 2 here, more of 54 problems ended unsolved. */
#define STEP 1.5

double price_sweep(const struct problem *p)
{
    double n = (double)p->n;
    if (!p->W) return p->kind.ns * n;
    return (p->kind.ns + SWEEP_COMMON * p->W->common) * n + SWEEP_BLOCK * (double)p->W->first[p->n];
}

double price_newton_step(double multiplications, double entries)
{
    return STEP * (multiplications + ENTRY * entries);
}

double price_assembly(double entries)
{
    return ASSEMBLY_ENTRY * entries;
}

double price_analysis(double entries)
{
    return ANALYSIS_ENTRY * entries;
}

/*
 * With CRITERION_VELOCITY a solve aims at AIM g dt at first, where that is less than eps, and is content with eps
 * after ENOUGH sweeps, or as many as cost CHEAP ns where these are more. So small problems are solved well, a pile
 * that comes to rest is solved better from step to step until one or two sweeps are left of each, and what flows
 * costs what eps costs.
 */
#define AIM            1e-3 /* a pile at rest keeps less than 1e-6 m g d a ball, which 1e-2 does not reach */
#define AIM_WEIGHTLESS 1e-4 /* without gravity, of the unit */
#define CHEAP          1e6  /* ns: 50 sweeps of 2000 contacts */
enum { ENOUGH = 20 };

static const char no_solution[] = "no solution: reactions grow without end";

#define PACE 1e-9 /* s on the wall per priced ns, before any Newton step was timed */

const struct solver *const solvers[] = { &solver_auto, &solver_nlgs, &solver_anderson, NULL };

enum {
    SLOTS_PER_THREAD = 16384, /* the fewest slots that are worth a thread: 100 us of copying */
    RENEW_EVERY = 1000        /* sweeps: their rounding stays below 1e-13 of the velocities */
};

/* r . W r / lambda r^2 of reactions without end is rounding; masses that differ by 1e12 leave 1e-12. */
#define NO_WORK 1e-14
#define LATER   10 /* times the reactions that there are: from then on they are looked at again */

/* err_eval(); where W alone is known, and no mass, what reactions without end are is seen by their work. */
static void solver_judge(struct err *e, struct problem *p, bool believes, enum err_terms which,
                         int threads)
{
    double work, most;
    err_eval(e, p, believes, which, threads);
    if (!e->jammed || p->packing || p->device || self_stress_work(p, &work, &most) ||
        !(work > NO_WORK))
        return;
    p->endless[1] = LATER * most;
    err_eval(e, p, believes, which, threads);
}

static void evaluate(struct solve *s)
{
    struct err e;
    solver_judge(&e, s->p, s->believes, err_terms_of(s->o->criterion), s->o->threads);
    s->value = err_value(&e, s->o->criterion, s->o->eps);
    s->jammed = e.jammed > 0;
}

static void solver_renew(struct solve *s)
{
    if (s->renewed) return;
    problem_renew(s->p, problem_team(s->p, s->o->threads));
    s->renewed = true, s->renewed_at = s->rep->sweeps;
}

double solve_judge(struct solve *s)
{
    if (s->rep->sweeps - s->renewed_at >= RENEW_EVERY) solver_renew(s);
    evaluate(s);
    if (solve_met(s) && !s->renewed) solver_renew(s), evaluate(s);
    solve_best_offer(s, &s->best);
    if (s->o->progress) s->o->progress(s->rep->sweeps, s->value);
    return s->value;
}

double solve_target(const struct solve *s)
{
    const struct problem *p = s->p;
    double fine = p->fall > 0 ? AIM * p->fall / p->unit : AIM_WEIGHTLESS;
    return s->rep->sweeps < s->enough ? fmin(fine, s->o->eps) : s->o->eps;
}

bool solve_met(const struct solve *s)
{
    return s->value <= solve_target(s);
}

double solve_seconds_left(const struct solve *s)
{
    if (!(s->o->max_seconds > 0)) return INFINITY;
    double left = s->o->max_seconds - (report_seconds(CLOCK_WALL) - s->start);
    return s->p->exchange ? s->p->exchange->agree(s->p->exchange, left) : left;
}

bool solve_spent(const struct solve *s)
{
    return s->rep->sweeps >= s->o->max_sweeps || solve_seconds_left(s) <= 0;
}

bool solve_over(const struct solve *s)
{
    return solve_met(s) || solve_spent(s);
}

int solve_history(struct solve *s)
{
    struct report *rep = s->rep;
    int32_t n = rep->sweeps;
    if (!s->o->history) return 0;
    if ((n & (n - 1)) == 0) { // room for the next power of two
        struct terms *h = realloc(rep->history, 2 * (size_t)n * sizeof *h);
        if (!h) return -1;
        rep->history = h;
    }
    struct err e;
    err_eval(&e, s->p, s->believes, ERR_TERMS, s->o->threads);
    rep->history[n - 1] = e.paper;
    return 0;
}

bool solve_affords(const struct solve *s, double price)
{
    return price * s->pace <= solve_seconds_left(s);
}

void solve_count_newton(struct solve *s, double price, double since)
{
    s->rep->newton++, s->rep->work += price;
    s->pace = fmax(s->pace, (report_seconds(CLOCK_WALL) - since) / price);
}

/* ---- the best iterate ---- */

/* An iterate is kept as r[slots][3] and, unless the contacts are more than MANY_CONTACTS,
   u[slots][3] and whether u is a local method's own. */
static bool with_u(const struct problem *p)
{
    return p->n <= MANY_CONTACTS;
}

/* Where in it begins what is beyond r, BESIDE_R numbers a slot */
static int64_t end_of_ru(const struct problem *p)
{
    return with_u(p) ? 6 * p->slots + 1 : 3 * p->slots;
}

int solve_best_init(struct best *b, const struct problem *p)
{
    if (p->device) {
        int failed = best_init(b, 0);
        b->place = device_place(p->device);
        return failed || b->place < 0 ? -1 : 0;
    }
    return best_init(b, end_of_ru(p) + (p->kind.extra ? BESIDE_R * p->slots : 0));
}

/* Slots that are kept */
struct solver_keeping {
    const struct problem *p;
    double *r;
};

static void keep_some(void *arg, int64_t first, int64_t end)
{
    const struct solver_keeping *k = arg;
    const struct problem *p = k->p;
    double *u = k->r + 3 * p->slots, unwanted[3] = { 0 };
    for (int64_t i = first; i < end; i++)
        slot_get(p, i, k->r + 3 * i, with_u(p) ? u + 3 * i : unwanted);
    for (int64_t i = first; p->kind.extra && i < end; i++)
        slot_get_beyond(p, i, k->r + end_of_ru(p) + BESIDE_R * i);
}

void solve_best_offer(const struct solve *s, struct best *b)
{
    const struct problem *p = s->p;
    struct solver_keeping k = { p, best_offer(b, s->value) };
    if (!k.r) return;
    if (p->device) {
        b->x[0] = s->believes;
        device_keep(s->p, b->place, with_u(p));
        return;
    }
    team_share(s->o->threads, p->slots, SLOTS_PER_THREAD, keep_some, &k);
    if (with_u(p)) k.r[6 * p->slots] = s->believes;
}

void solve_react(struct solve *s, const double *r)
{
    problem_react(s->p, r, problem_team(s->p, s->o->threads));
    s->believes = false, s->renewed = true, s->renewed_at = s->rep->sweeps;
}

void solve_best_restore(struct solve *s, const struct best *b)
{
    struct problem *p = s->p;
    if (!b->x || !(b->value < INFINITY) || s->value <= b->value) return;
    if (p->device) {
        s->believes = with_u(p) && b->x[0] != 0;
        device_restore(p, b->place, s->believes);
        s->renewed = true, s->renewed_at = s->rep->sweeps, s->value = b->value;
        return;
    }
    const double *r = b->x, *u = r + 3 * p->slots;
    for (int64_t i = 0; p->kind.extra && i < p->slots; i++)
        slot_set_beyond(p, i, r + end_of_ru(p) + BESIDE_R * i);
    solve_react(s, r);
    s->value = b->value, s->believes = with_u(p) && u[3 * p->slots] != 0;
    for (int64_t i = 0; s->believes && i < p->slots; i++) slot_set(p, i, r + 3 * i, u + 3 * i);
}

int solve_keep_best(struct solve *s)
{
    if (solve_best_init(&s->best, s->p)) return -1;
    solve_best_offer(s, &s->best);
    return 0;
}

void solve_restore_best(struct solve *s)
{
    solve_best_restore(s, &s->best);
}

/* ---- a whole solve ---- */

/* The device that is to solve the problem, compared with the CPU before it does so for the first time; NULL: the CPU
   is. -1 where the device fails */
static int choose_device(const struct problem *p, const struct solve_opt *o, struct report *rep,
                         struct device **device)
{
    struct failure failure = { 0 };
    *device = NULL;
    rep->on_cpu = NULL, rep->bus_to = rep->bus_from = 0, rep->kernels = 0;
    if (!o->device || !p->n) return 0;
    rep->on_cpu = device_declines(p);
    if (rep->on_cpu) return 0;
    *device = o->device, o->device->account = (struct device_account){ 0 };
    return device_check(o->device, &p->kind, o->method->id, &failure) ? -1 : 0;
}

/* The iterate comes back from it; -1 where it was lost. */
static int leave_device(struct problem *p, struct report *rep)
{
    struct failure failure = { 0 };
    struct device *d = p->device;
    if (!d) return 0;
    int failed = device_release(p, &failure);
    rep->bus_to = d->account.to, rep->bus_from = d->account.from, rep->kernels = d->account.kernels;
    return failed ? -1 : 0;
}

int solve_problem(struct problem *p, const struct solve_opt *o, struct report *rep)
{
    struct failure failure = { 0 };
    struct device *device;
    if (choose_device(p, o, rep, &device)) return -1; // compiles kernels: no time of the solve
    double cpu = report_seconds(CLOCK_CPU), wall = report_seconds(CLOCK_WALL);
    struct solve s = { .p = p, .o = o, .rep = rep, .start = wall };
    s.believes = o->method->believes, s.value = INFINITY, s.renewed = true;
    s.best.value = INFINITY, s.pace = PACE;
    if (o->criterion == CRITERION_VELOCITY)
        s.enough = (int32_t)fmax(ENOUGH, CHEAP / price_sweep(p));
    rep->criterion = o->criterion, rep->eps = o->eps;
    rep->sweeps = 0, rep->newton = rep->safeguarded = rep->gave_up = 0;
    rep->work = 0, rep->given_up = NULL;
    snprintf(rep->method, sizeof rep->method, "%s",
             o->global == &solver_nlgs ? o->method->name : o->global->name);
    if (device && device_hold(device, p, o->method->id, &failure)) return -1;
    int failed = p->n ? o->global->run(&s) : 0;
    solve_restore_best(&s);
    best_free(&s.best);
    if (failed) return leave_device(p, rep), -1;
    solver_renew(&s);
    if (!s.believes && p->device)
        device_velocities(p);
    else if (!s.believes)
        backend_widest()->judge->velocities(p, 0, p->bundles);
    if (p->exchange) {
        struct exchange *all = p->exchange;
        rep->newton = all->count(all, rep->newton);
        rep->safeguarded = all->count(all, rep->safeguarded);
        rep->gave_up = all->count(all, rep->gave_up);
    }
    double overlap = rep->err.max_overlap;
    solver_judge(&rep->err, p, s.believes, ERR_ALL, o->threads);
    rep->err.max_overlap = overlap;
    if (leave_device(p, rep)) return -1;
    if (rep->history && rep->sweeps) rep->history[rep->sweeps - 1] = rep->err.paper;
    bool jammed = rep->err.jammed && (o->criterion == CRITERION_VELOCITY || !p->packing);
    rep->converged = !p->n || (!jammed && err_value(&rep->err, o->criterion, o->eps) <= o->eps);
    if (jammed) rep->given_up = no_solution;
    rep->seconds = report_seconds(CLOCK_CPU) - cpu;
    rep->elapsed = report_seconds(CLOCK_WALL) - wall;
    return 0;
}
