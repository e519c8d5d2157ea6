/* step/step.c: a step from one state of a packing to the next [step/step.h]. */
#include "step/step.h"

#include "contact/depth.h"
#include "contact/detect.h"
#include "contact/touching.h"
#include "contact/tunnelling.h"
#include "solve/device.h"
#include "solve/prepare.h"
#include "state/breakable.h"
#include "state/placement.h"
#include "state/rotation.h"
#include "step/balance.h"
#include "step/breaking_load.h"
#include "step/hit_bound.h"
#include "step/move.h"
#include "step/project.h"
#include "step/small_step.h"
#include "step/sum_step.h"
#include "step/work_bound.h"

#include <stdlib.h>

/* Why solve_problem() has failed: the device, or memory */
static int solve_failed(const struct solve_opt *o, struct failure *failure)
{
    const struct failure *lost = o->device ? &o->device->lost : NULL;
    if (lost && lost->status) return failure_set(failure, lost->status, "%s", lost->text);
    return failure_set(failure, EX_SOFTWARE, "no memory to solve the contacts");
}

/* The contacts as they are, from the reactions that they have */
static int solve_contacts(const struct packing *pack, struct contacts *s, struct plan **kept,
                          const struct step_opt *o, struct report *rep, struct failure *failure)
{
    struct problem p;
    const struct prepare_opt form = {
        .alpha = o->alpha, .rho_factor = o->solve.method->rho, .order = o->order, .kept = kept
    };
    if (prepare_packing(&p, pack, s, &form, failure)) return failure->status;
    int failed = solve_problem(&p, &o->solve, rep);
    if (failed)
        solve_failed(&o->solve, failure);
    else if ((failed = problem_store(&p, s)))
        failure_set(failure, EX_SOFTWARE, "no memory for the solution");
    problem_free(&p);
    return failed ? failure->status : 0;
}

/* Solves contacts anew, from what they have; the report adds up what both solves took. */
static int solve_again(const struct packing *pack, struct contacts *s, struct plan **kept,
                       const struct step_opt *o, struct report *rep, struct failure *failure)
{
    const struct report before = *rep;
    if (solve_contacts(pack, s, kept, o, rep, failure)) return failure->status;
    rep->bus_to += before.bus_to, rep->bus_from += before.bus_from;
    rep->kernels += before.kernels;
    rep->seconds += before.seconds, rep->elapsed += before.elapsed, rep->work += before.work;
    if (o->solve.history) return 0; // which is of the last solve
    rep->sweeps += before.sweeps, rep->newton += before.newton;
    rep->safeguarded += before.safeguarded, rep->gave_up += before.gave_up;
    return 0;
}

/* The reactions of a solve that has not converged, reduced where they would give energy */
static int bound_work(const struct packing *pack, struct contacts *s, struct plan **kept,
                      const struct step_opt *o, struct report *rep, struct failure *failure)
{
    struct step_opt none = *o;
    const char *why = rep->given_up;
    bool again;
    none.solve.max_sweeps = 0; // u and the errors alone
    if (work_reduce(pack, s, &again, failure) || !again) return failure->status;
    solve_again(pack, s, kept, &none, rep, failure);
    rep->given_up = why;
    return failure->status;
}

int step_bound_impacts(const struct packing *pack, struct contacts *s, struct plan **kept,
                       const struct step_opt *o, struct report *rep, struct failure *failure)
{
    struct rebound_search *search = NULL;
    struct hit_search *hits = NULL;
    bool again = true;
    while (!hit_reduce(&hits, pack, s, &again, failure) && again)
        if (solve_again(pack, s, kept, o, rep, failure)) break;
    hit_free(hits);
    while (!failure->status && !rebound_reduce(&search, pack, s, &again, failure) && again)
        if (solve_again(pack, s, kept, o, rep, failure)) break;
    rebound_free(search);
    if (!failure->status && !rep->converged && !o->as_is && !o->solve.history)
        bound_work(pack, s, kept, o, rep, failure);
    return failure->status;
}

int step_solve_contacts(const struct packing *pack, struct contacts *s, struct plan **kept,
                        const struct step_opt *o, struct report *rep, struct failure *failure)
{
    if (!o->warm) contacts_free_found(s);
    if (solve_contacts(pack, s, kept, o, rep, failure)) return failure->status;
    return step_bound_impacts(pack, s, kept, o, rep, failure);
}

/* What is reported of a step before its solve */
static int step_begin(struct step_makers *m,
                      int measure(struct step_makers *m, const struct packing *p,
                                  const struct contacts *s, struct report *rep,
                                  struct failure *failure),
                      const struct packing *p, const struct contacts *s, struct report *rep,
                      struct failure *failure)
{
    rep->step = p->step + 1, rep->t = packing_next_time(p);
    return measure(m, p, s, rep, failure);
}

/* What the report's balances say of a step, and whether there are any */
static bool account_for(struct report *rep, const struct packing *p, const struct step_opt *o)
{
    rep->balanced = !o->bare, rep->tied = p->law != NULL, rep->may_gain = packing_may_gain(p);
    rep->soft = packing_has_springs(p);
    rep->projected = rep->sheared = false;
    return rep->balanced;
}

int step_solve(const struct packing *pack, struct contacts *s, const struct step_opt *o,
               struct report *rep, struct failure *failure)
{
    struct impulses sum = { 0 };
    if (step_begin(NULL, step_measure_whole, pack, s, rep, failure) ||
        step_solve_contacts(pack, s, NULL, o, rep, failure))
        return failure->status;
    if (!impulses_init(&sum, pack, s, false, failure) && account_for(rep, pack, o))
        step_balance_whole(NULL, pack, s, &sum, &rep->balance, failure);
    impulses_free(&sum);
    return failure->status;
}

int step_solve_delassus(struct delassus *W, double *u, const struct step_opt *o, struct report *rep,
                        struct failure *failure)
{
    struct problem p;
    if (!o->warm)
        for (int64_t i = 0; i < W->d * W->n; i++) W->r[i] = 0;
    const struct prepare_opt form = { .alpha = o->alpha,
                                      .rho_factor = o->solve.method->rho,
                                      .order = o->order };
    if (problem_prepare_delassus(&p, W, &form, failure)) return failure->status;
    rep->balanced = rep->tied = rep->may_gain = rep->projected = rep->sheared = rep->soft = false;
    int failed = solve_problem(&p, &o->solve, rep);
    for (int64_t i = 0; i < p.slots; i++) {
        double r[3], v[3];
        if (p.contact[i] < 0) continue;
        slot_get(&p, i, r, v);
        for (int k = 0; k < W->d; k++) u[W->d * p.contact[i] + k] = v[k];
    }
    problem_free(&p);
    return failed ? solve_failed(&o->solve, failure) : 0;
}

void step_forget(struct step_memory *m)
{
    neighbours_free(&m->near);
    plan_free(m->plan);
    small_list_free(&m->small);
    *m = (struct step_memory){ 0 };
}

void step_watch_whole(struct step_makers *m, const struct packing *p, struct report *rep)
{
    (void)m;
    rep->fast = tunnelling_count(p, NULL, &rep->fast_id);
}

int step_measure_whole(struct step_makers *m, const struct packing *p, const struct contacts *s,
                       struct report *rep, struct failure *failure)
{
    (void)m;
    rep->err.max_overlap = contacts_max_overlap(s);
    return depth_of(&rep->depth, p, s, NULL, failure);
}

void step_unsolved_whole(struct step_makers *m, const struct packing *p, const struct contacts *s,
                         struct report *rep)
{
    double off;
    (void)m;
    const int64_t i = contacts_unsolved(s, &off);
    if (i < 0) return;
    const struct contact *c = &s->c[i];
    rep->unsolved[0] = c->a < 0 ? c->a : p->id[c->a], rep->unsolved[1] = p->id[c->b];
}

int step_balance_whole(struct step_makers *m, const struct packing *p, const struct contacts *s,
                       const struct impulses *sum, struct balance *b, struct failure *failure)
{
    (void)m;
    return balance_step(b, p, s, sum, NULL, failure);
}

int step_move_apart_whole(struct step_makers *m, struct packing *p, const struct contacts *s,
                          struct projected *did, struct failure *failure)
{
    (void)m;
    if (overlap_projects(p->overlap) && project_apart(p, s, did, failure)) return failure->status;
    if (did && energy_has_peculiar(p)) did->peculiar = energy_peculiar(p, NULL);
    return 0;
}

void step_report_moved(struct report *rep, const struct packing *p, const struct projected *did)
{
    struct balance *b = &rep->balance;
    rep->projected = rep->balanced && overlap_projects(p->overlap);
    rep->sheared = rep->balanced && energy_has_peculiar(p);
    if (rep->projected) {
        b->projection = did->work, b->potential += did->work;
        for (int k = 0; k < 3; k++) b->spun[k] = did->spin[k];
    }
    if (rep->sheared) b->peculiar = did->peculiar, b->peculiar_change += did->peculiar;
}

static bool report_is_finite(const struct report *rep)
{
    const struct err *e = &rep->err;
    const struct balance *b = &rep->balance;
    double sum = e->paper.eps_glob + e->scaled.eps_glob + e->max_penetration +
                 e->max_penetration_true + e->max_overlap + e->natural + e->natural_siconos +
                 e->natural_q + e->velocity + e->velocity_error;
    double balance =
        b->kinetic + b->change + b->potential + b->gravity + b->drives + b->loads + b->dissipation;
    for (int k = 0; k < 3; k++) balance += b->momentum[k] + b->impulse[k];
    return isfinite(sum) && (!rep->balanced || isfinite(balance));
}

static void step_foresee(struct step_makers *m, const struct packing *p, const struct impulses *sum,
                         struct report *rep)
{
    if (!isfinite(rep->err.paper.eps_glob)) return;
    rep->endless = endless_after(p, sum);
    if (!rep->endless.what && !report_is_finite(rep)) rep->endless.what = ENDLESS_REPORT;
    if (m->agree) m->agree(m, rep);
}

/* The balances and the motion */
static int step_move(struct step_makers *m, struct packing *p, const struct contacts *s,
                     const struct step_opt *o, struct report *rep, struct failure *failure)
{
    struct impulses sum = { 0 };
    struct projected did = { 0 };
    if (impulses_init(&sum, p, s, false, failure)) goto end;
    if (m->add_impulses) m->add_impulses(m, &sum);
    if (account_for(rep, p, o) && m->balance(m, p, s, &sum, &rep->balance, failure)) goto end;
    step_foresee(m, p, &sum, rep);
    if (report_made(rep) && !sum_step(p, s, &sum, failure) && !move_by(p, s, &sum, failure))
        m->move_apart(m, p, s, rep->balanced ? &did : NULL, failure);
    if (rep->balanced) step_report_moved(rep, p, &did);
end:
    impulses_free(&sum);
    return failure->status;
}

/* How many bodies are too fast for the step, at its beginning, where it is the first, and at its end */
static void step_watch(struct step_makers *m, const struct packing *p, struct report *rep)
{
    const int64_t before = rep->fast;
    const int32_t id = rep->fast_id;
    rep->watched = tunnelling_watches(p);
    m->watch(m, p, rep);
    if (rep->fast < before) rep->fast = before, rep->fast_id = id;
}

int step_make(struct step_makers *m, struct packing *p, struct contacts *s,
              const struct step_opt *o, struct report *rep, struct failure *failure)
{
    double cpu = report_seconds(CLOCK_CPU);
    if (m->detect(m, p, s, o, failure)) return failure->status;
    rep->detection = report_seconds(CLOCK_CPU) - cpu;
    if (!m->helps && step_begin(m, m->measure, p, s, rep, failure)) return failure->status;
    rep->fast = 0, rep->endless = (struct endless){ 0 };
    if (!m->helps && !p->step) step_watch(m, p, rep);
    if (m->solve(m, p, s, o, rep, failure) || m->helps) return failure->status;
    if (!rep->converged) m->find_unsolved(m, p, s, rep);
    if (!step_move(m, p, s, o, rep, failure)) step_watch(m, p, rep);
    return failure->status;
}

/* ---- a process alone ---- */

struct alone {
    struct step_makers makers; /* first: it is what the functions below are given */
    struct step_memory *memory;
};

static int detect_alone(struct step_makers *m, struct packing *p, struct contacts *s,
                        const struct step_opt *o, struct failure *failure)
{
    struct step_memory *kept = ((struct alone *)m)->memory;
    memory_set(&p->memory, o->warm);
    packing_wrap(p, NULL);
    if (touching_bond(p, failure)) return failure->status;
    if (detect_contacts(s, p, o->gap, kept ? &kept->near : NULL, failure)) return failure->status;
    return o->warm ? memory_give(&p->memory, s, packing_rolls(p), failure) : 0;
}

static int solve_alone(struct step_makers *m, const struct packing *p, struct contacts *s,
                       const struct step_opt *o, struct report *rep, struct failure *failure)
{
    struct step_memory *kept = ((struct alone *)m)->memory;
    return step_solve_contacts(p, s, kept ? &kept->plan : NULL, o, rep, failure);
}

struct step_opt step_opt_part(const struct step_opt *o, const struct substeps *s)
{
    struct step_opt part = *o;
    part.solve.local.newton_abs /= (double)s->n;
    return part;
}

/* Of the smallest radius, over four: by more no body moves in a step of a packing that small steps lack something for, without being
   too fast */
#define FAST 0.25

int step_in_small(struct packing *p, struct contacts *s, struct step_memory *kept,
                  const struct step_opt *o, struct report *rep, bool *made, int64_t *parts,
                  struct failure *failure)
{
    *made = false, *parts = 0;
    rep->small = rep->small_limited = 0, rep->fine = o->small > 0;
    rep->missing = rep->missing_mean = 0, rep->missing_id = 0;
    rep->judged = o->small > 0 && o->compare, rep->compared = 0, rep->distance = 0;
    if (!(o->small > 0) || !kept) return 0;
    if (small_lacks(p)) {
        const double way = small_divides(p) ? o->small : FAST;
        if (small_parts(p, way) > 1) *parts = small_parts(p, o->small);
        return 0;
    }
    const struct small_opt small = { .overlap = o->small,
                                     .threads = o->solve.threads,
                                     .near = &kept->near,
                                     .bare = o->bare,
                                     .compare = o->compare,
                                     .bound = o->bound,
                                     .part = o->part,
                                     .warm = o->small_warm };
    rep->criterion = o->solve.criterion, rep->eps = o->solve.eps;
    small_advance(p, s, &kept->small, &small, rep, made, failure);
    if (!*made) *parts = small_parts(p, o->small);
    return failure->status;
}

void step_after_parts(struct packing *p, const struct step_opt *o, int64_t parts)
{
    if (!parts || small_lacks(p)) return;
    memory_set(&p->memory, false), memory_set(&p->memory, o->warm);
}

static int advance_alone(struct packing *p, struct contacts *s, struct step_memory *kept,
                         const struct step_opt *o, struct report *rep, struct failure *failure)
{
    struct substeps steps;
    struct alone a = { { .detect = detect_alone,
                         .measure = step_measure_whole,
                         .find_unsolved = step_unsolved_whole,
                         .solve = solve_alone,
                         .balance = step_balance_whole,
                         .move_apart = step_move_apart_whole,
                         .watch = step_watch_whole },
                       kept };
    bool made;
    int64_t parts;
    if (step_in_small(p, s, kept, o, rep, &made, &parts, failure) || made) return failure->status;
    substeps_begin(&steps, p, parts);
    const struct step_opt part = step_opt_part(o, &steps);
    while (!steps.ends) {
        substeps_enter(&steps, p);
        step_make(&a.makers, p, s, &part, rep, failure);
        substeps_leave(&steps, p);
        if (failure->status || substeps_add(&steps, p, s, rep, failure)) break;
    }
    substeps_free(&steps);
    step_after_parts(p, o, parts);
    return failure->status;
}

int step_advance(struct packing *p, struct contacts *s, struct step_memory *kept,
                 const struct step_opt *o, struct report *rep, struct failure *failure)
{
    struct breaking_start start;
    rep->breaks = p->breakage != NULL;
    if (!p->breakage) return advance_alone(p, s, kept, o, rep, failure);
    if (breaking_start(&start, p, failure)) return failure->status;
    if (!advance_alone(p, s, kept, o, rep, failure) && report_made(rep))
        breaking_load(p, s, &start, failure);
    rep->breaks = true, rep->balance.breaking = breakage_total(p).taken;
    breaking_start_free(&start);
    return failure->status;
}
