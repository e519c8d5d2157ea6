/* solve/solver.c: see solve/solver.h. */
#include "solve/solver.h"

#include "problem/sweep.h"

#include <stdlib.h>

const struct solver *const solvers[] = { &solver_auto, &solver_nlgs, &solver_anderson,
                                         &solver_cg,   &solver_prox, &solver_ipm,
                                         NULL };

double solve_judge(struct solve *s)
{
    struct err e;
    err_eval(&e, s->p, s->believes, err_terms_of(s->o->criterion), s->o->threads);
    s->value = err_of(&e, s->o->criterion);
    if (s->o->progress) s->o->progress(s->rep->sweeps, s->value);
    return s->value;
}

bool solve_met(const struct solve *s)
{
    return s->value <= s->o->eps;
}

bool solve_spent(const struct solve *s)
{
    if (s->rep->sweeps >= s->o->max_sweeps) return true;
    return s->o->max_seconds > 0 && report_seconds(CLOCK_WALL) - s->start >= s->o->max_seconds;
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

int kept_init(struct kept *k, const struct problem *p)
{
    size_t size = (size_t)(p->slots + 1) * sizeof *k->r;
    bool many = p->n > MANY;
    *k = (struct kept){ INFINITY, malloc(size), many ? NULL : malloc(size) };
    return k->r && (many || k->u) ? 0 : -1;
}

void kept_free(struct kept *k)
{
    free(k->r), free(k->u);
    k->r = k->u = NULL;
}

void kept_offer(struct kept *k, const struct solve *s)
{
    double unwanted[3] = { 0 };
    if (!(s->value < k->value)) return;
    k->value = s->value;
    for (int64_t i = 0; i < s->p->slots; i++) slot_get(s->p, i, k->r[i], k->u ? k->u[i] : unwanted);
}

void kept_back(const struct kept *k, struct solve *s)
{
    if (!(k->value < INFINITY) || s->value <= k->value) return;
    for (int64_t i = 0; i < s->p->slots; i++) {
        if (s->p->contact[i] < 0) continue;
        slot_react(s->p, i, k->r[i]);
        if (k->u) slot_set(s->p, i, k->r[i], k->u[i]);
    }
    s->believes &= k->u != NULL;
    s->value = k->value;
}

int solve_problem(struct problem *p, const struct solve_opt *o, struct report *rep)
{
    double cpu = report_seconds(CLOCK_CPU), wall = report_seconds(CLOCK_WALL);
    struct solve s = { p, o, rep, o->method->believes, INFINITY, wall };
    rep->criterion = o->criterion, rep->eps = o->eps;
    rep->sweeps = 0, rep->newton = rep->safeguarded = rep->gave_up = 0;
    if (p->n && o->global->run(&s)) return -1;
    if (!s.believes) sweep_widest()->velocities(p, 0, p->bundles);
    double overlap = rep->err.max_overlap;
    err_eval(&rep->err, p, s.believes, ERR_ALL, o->threads);
    rep->err.max_overlap = overlap;
    rep->converged = !p->n || err_of(&rep->err, o->criterion) <= o->eps;
    rep->seconds = report_seconds(CLOCK_CPU) - cpu;
    rep->elapsed = report_seconds(CLOCK_WALL) - wall;
    return 0;
}
