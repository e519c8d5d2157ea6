#include "nlgs.h"

#include <omp.h>
#include <stdlib.h>

enum {
    CHECK_FIRST = 40, /* sweeps that are all judged */
    CHECK_EVERY = 25,
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

/* One sweep into the report; returns the largest change of a normal velocity, m/s. */
static double sweep(struct problem *p, const struct nlgs_opt *o, struct report *rep)
{
    sweep_text *text = sweep_widest()->sweep[o->method->id];
    const struct sweep_opt opt = { o->local, o->relax };
    int threads = p->bundles < PARALLEL_FROM * p->groups ? 1 : o->threads;
    double change = 0;
#pragma omp parallel num_threads(threads) if (threads > 1)
    {
        struct tally t = { 0 };
        text(p, omp_get_thread_num(), threads > 1 ? omp_get_num_threads() : 1, &opt, &t);
#pragma omp critical
        {
            change = fmax(change, most(t.change));
            rep->newton += count(t.newton);
            rep->safeguarded += count(t.safeguarded), rep->gave_up += count(t.gave_up);
        }
    }
    rep->sweeps++;
    return change;
}

static int keep(struct report *rep, int32_t sweeps, const struct terms *t)
{
    if ((sweeps & (sweeps - 1)) == 0) { // room for the next power of two
        struct terms *h = realloc(rep->history, 2 * (size_t)sweeps * sizeof *h);
        if (!h) return -1;
        rep->history = h;
    }
    rep->history[sweeps - 1] = *t;
    return 0;
}

int nlgs_solve(struct problem *p, const struct nlgs_opt *o, struct report *rep)
{
    double cpu = report_seconds(CLOCK_CPU), wall = report_seconds(CLOCK_WALL);
    double due = INFINITY; // a sweep's change below which to evaluate
    bool believes = o->method->believes;
    enum err_part part =
        o->history ? ERR_TERMS | err_part_of(o->criterion) : err_part_of(o->criterion);
    int32_t last = 0;
    rep->criterion = o->criterion, rep->eps = o->eps;
    rep->sweeps = 0, rep->converged = !p->n;
    rep->newton = rep->safeguarded = rep->gave_up = 0;
    while (!rep->converged && rep->sweeps < o->max_sweeps) {
        double change = sweep(p, o, rep);
        if (!o->history && !o->every_sweep && !(change <= due) && rep->sweeps > CHECK_FIRST &&
            rep->sweeps - last < CHECK_EVERY)
            continue;
        struct err e;
        err_eval(&e, p, believes, part, o->threads);
        if (o->history && keep(rep, rep->sweeps, &e.paper)) return -1;
        double value = err_of(&e, o->criterion);
        rep->converged = value <= o->eps;
        if (o->progress) o->progress(rep->sweeps, value);
        if (!isfinite(value)) break; // diverged
        // error and change shrink together, more or less: due after half the way, and all the time
        // when it is near
        due = value < 1.3 * o->eps ? INFINITY : change * sqrt(o->eps / value);
        last = rep->sweeps;
    }
    if (!believes) sweep_widest()->velocities(p, 0, p->bundles);
    double overlap = rep->err.max_overlap;
    err_eval(&rep->err, p, believes, ERR_ALL, o->threads);
    rep->err.max_overlap = overlap;
    rep->seconds = report_seconds(CLOCK_CPU) - cpu,
    rep->elapsed = report_seconds(CLOCK_WALL) - wall;
    return 0;
}
