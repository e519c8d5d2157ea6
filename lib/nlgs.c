#include "nlgs.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    CHECK_FIRST = 40, /* sweeps that are all judged */
    CHECK_EVERY = 25,
    PARALLEL_FROM = 128 /* rows of a group worth a second thread */
};

struct tally {
    double change; /* m/s: the largest change of a normal velocity in a sweep */
    int64_t newton, safeguarded, gave_up;
};

static void tally_add(struct tally *t, const struct tally *s)
{
    t->change = s->change > t->change ? s->change : t->change;
    t->newton += s->newton, t->safeguarded += s->safeguarded, t->gave_up += s->gave_up;
}

/* Over-relaxation: past the new reaction, and back onto the cone. */
static void relax(struct local *l, const double was[3], double omega)
{
    double tau[3];
    for (int k = 0; k < 3; k++) tau[k] = was[k] + omega * (l->r[k] - was[k]);
    cone_project(l->mu, tau, l->r);
    local_velocity(l);
}

static inline void visit(struct problem *p, int64_t i, const struct nlgs_opt *o, struct tally *t)
{
    struct local l;
    const double *was = p->row[i].r;
    problem_gather(p, i, &l);
    o->method->solve(&l, &o->local);
    if (o->relax != 1) relax(&l, was, o->relax);
    double change = fabs(l.r[0] - was[0]) * l.w[0];
    t->change = change > t->change ? change : t->change;
    t->newton += l.steps;
    if (l.trouble)
        t->safeguarded += l.trouble == LOCAL_SAFEGUARDED, t->gave_up += l.trouble == LOCAL_GAVE_UP;
    problem_scatter(p, i, &l);
}

static struct tally sweep(struct problem *p, const struct nlgs_opt *o)
{
    struct tally all = { 0 };
    if (o->threads == 1 || p->n < PARALLEL_FROM * p->groups) {
        for (int64_t i = 0; i < p->n; i++) visit(p, i, o, &all);
        return all;
    }
#pragma omp parallel num_threads(o->threads)
    {
        struct tally mine = { 0 };
        for (int64_t g = 0; g < p->groups; g++) {
            int64_t first = p->group[g], end = p->group[g + 1];
            if (end - first < PARALLEL_FROM) {
#pragma omp single
                for (int64_t i = first; i < end; i++) visit(p, i, o, &mine);
            } else {
#pragma omp for schedule(static)
                for (int64_t i = first; i < end; i++) visit(p, i, o, &mine);
            }
        }
#pragma omp critical
        tally_add(&all, &mine);
    }
    return all;
}

/* Where the method has no u of its own the motion's stands. */
static void velocities(struct problem *p)
{
    for (int64_t i = 0; i < p->n; i++) err_velocity(p, i, p->row[i].u);
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
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
    double start = seconds(), due = INFINITY; // a sweep's change below which to evaluate
    bool believes = o->method->believes;
    enum err_part part =
        o->history ? ERR_TERMS | err_part_of(o->criterion) : err_part_of(o->criterion);
    int32_t last = 0;
    rep->criterion = o->criterion, rep->eps = o->eps;
    rep->sweeps = 0, rep->converged = !p->n;
    rep->newton = rep->safeguarded = rep->gave_up = 0;
    while (!rep->converged && rep->sweeps < o->max_sweeps) {
        struct tally t = sweep(p, o);
        rep->sweeps++;
        rep->newton += t.newton, rep->safeguarded += t.safeguarded, rep->gave_up += t.gave_up;
        if (!o->history && !o->every_sweep && !(t.change <= due) && rep->sweeps > CHECK_FIRST &&
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
        due = value < 1.3 * o->eps ? INFINITY : t.change * sqrt(o->eps / value);
        last = rep->sweeps;
    }
    if (!believes) velocities(p);
    double overlap = rep->err.max_overlap;
    err_eval(&rep->err, p, believes, ERR_ALL, o->threads);
    rep->err.max_overlap = overlap;
    rep->seconds = seconds() - start;
    return 0;
}
