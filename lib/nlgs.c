/*
 * nlgs.c: the non-linear Gauss-Seidel method [paper, 3.1]: sweep over the contacts, each solved by a
 * local method with the others held still, until the criterion is met.
 */
#include "solver.h"

#include <omp.h>

enum {
    CHECK_FIRST = 40, /* sweeps that are all judged */
    CHECK_EVERY = 25,
    FORESIGHT = 4,     /* times less change than that of the sweep before is not expected */
    PARALLEL_FROM = 64 /* bundles of a group worth a second thread */
};

static double most(const double x[BUNDLE])
{
    double y = 0;
    for (int k = 0; k < BUNDLE; k++) y = x[k] > y ? x[k] : y;
    return y;
}

static int64_t count(const double x[BUNDLE])
{
    double y = 0;
    for (int k = 0; k < BUNDLE; k++) y += x[k];
    return (int64_t)y;
}

static double add_tally(struct report *rep, const struct tally *t)
{
    rep->newton += count(t->newton);
    rep->safeguarded += count(t->safeguarded), rep->gave_up += count(t->gave_up);
    return most(t->change);
}

/* One sweep into the report; returns the largest change of a normal velocity, m/s. */
static double sweep(struct solve *s, double omega, bool keep)
{
    const struct solve_opt *o = s->o;
    sweep_text *text = sweep_widest()->sweep[o->method->id];
    const struct sweep_opt opt = { o->local, omega, keep };
    double change = 0;
    s->rep->sweeps++;
    if (o->threads == 1 || s->p->bundles < PARALLEL_FROM * s->p->groups) { // no team: that costs
        struct tally t = { 0 };
        text(s->p, 0, 1, &opt, &t);
        return add_tally(s->rep, &t);
    }
#pragma omp parallel num_threads(o->threads)
    {
        struct tally t = { 0 };
        text(s->p, omp_get_thread_num(), omp_get_num_threads(), &opt, &t);
#pragma omp critical
        change = fmax(change, add_tally(s->rep, &t));
    }
    return change;
}

/*
 * The criterion is evaluated after each of a solve's first 40 sweeps, when the largest change of a
 * sweep, gathered on the way, says that it may be met, every 25 sweeps, and at the end. What a sweep
 * believes of u is only wanted then: where rows are far, those that will not be judged do not write
 * it down, for memory's sake.
 */
int nlgs_sweep(struct solve *s, double omega, bool last, struct watch *w)
{
    s->believes = s->o->method->believes;
    int32_t n = s->rep->sweeps + 1;
    bool sure = s->o->history || s->o->every_sweep || n <= w->all || n - w->judged >= CHECK_EVERY ||
                n >= s->o->max_sweeps || last;
    bool keep = sure || s->p->bundles < SWEEP_FAR || w->change <= FORESIGHT * w->due;
    double change = w->change = sweep(s, omega, keep);
    w->looked = false;
    if (solve_history(s)) return -1;
    if (!sure && !(keep && change <= w->due)) return 0;
    solve_judge(s);
    // error and change shrink together, more or less: due after half the way, and all the time
    // when it is near
    w->due = s->value < 1.3 * s->o->eps ? INFINITY : change * sqrt(s->o->eps / s->value);
    w->judged = n, w->looked = true;
    return solve_met(s) || solve_spent(s) || !isfinite(s->value);
}

int nlgs_sweeps(struct solve *s, int32_t sweeps, double omega)
{
    int32_t end = s->rep->sweeps + sweeps;
    struct watch w = { .due = INFINITY, .judged = s->rep->sweeps, .all = CHECK_FIRST };
    while (s->rep->sweeps < end) {
        int over = nlgs_sweep(s, omega, s->rep->sweeps == end - 1, &w);
        if (over) return over < 0 ? -1 : 0;
    }
    return 0;
}

static int run(struct solve *s)
{
    return nlgs_sweeps(s, s->o->max_sweeps, s->o->relax);
}

const struct solver solver_nlgs = { "nlgs", 1, run };
