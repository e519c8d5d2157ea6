/* solve/step.c: a step from one state of a packing to the next [solve/step.h]. */
#include "solve/step.h"

#include "bodies/detect.h"
#include "bodies/move.h"
#include "bodies/swift.h"
#include "bodies/tidy.h"
#include "problem/prepare.h"
#include "solve/rebound.h"

#include <stdlib.h>

/* The reactions' sums and the balances they make; sum is to be freed in any case. */
static int sum_up(const struct packing *pack, const struct contacts *s, const struct step_opt *o,
                  struct report *rep, struct impulses *sum, struct why *why)
{
    rep->balanced = !o->bare, rep->tied = pack->law != NULL;
    rep->may_gain = packing_may_gain(pack);
    if (impulses_init(sum, pack, s, false, why)) return why->status;
    return o->bare ? 0 : balance_step(&rep->balance, pack, s, sum, NULL, why);
}

bool step_sweeps(const struct solver *global)
{
    return global == &solver_auto || global == &solver_nlgs || global == &solver_anderson;
}

/* Refuses what the solver asked for cannot solve. */
static int check_solver(const struct problem *p, const struct solver *global, struct why *why)
{
    if (!p->kind.rolls || step_sweeps(global)) return 0;
    return why_set(
        why, EX_DATAERR,
        "%s does not solve contacts with rolling friction: --global auto, anderson and nlgs do",
        global->name);
}

/* The contacts as they are, from the reactions that they have */
static int solve_contacts(const struct packing *pack, struct contacts *s, struct plan **kept,
                          const struct step_opt *o, struct report *rep, struct why *why)
{
    struct problem p;
    if (prepare_packing(&p, pack, s, step_sweeps(o->solve.global), o->alpha, o->solve.method->rho,
                        o->order, kept, why))
        return why->status;
    rep->step = pack->step + 1;
    rep->t = packing_next_time(pack);
    rep->err.max_overlap = contacts_max_overlap(s);
    if (check_solver(&p, o->solve.global, why)) return problem_free(&p), why->status;
    int failed = solve_problem(&p, &o->solve, rep);
    if (failed)
        why_set(why, EX_SOFTWARE, "no memory to solve the contacts");
    else if ((failed = problem_store(&p, s)))
        why_set(why, EX_SOFTWARE, "no memory for the solution");
    problem_free(&p);
    return failed ? why->status : 0;
}

int step_bound_impacts(const struct packing *pack, struct contacts *s, struct plan **kept,
                       const struct step_opt *o, struct report *rep, struct why *why)
{
    struct rebound_search *search = NULL;
    bool again = true;
    while (!rebound_reduce(&search, pack, s, &again, why) && again) {
        const struct report before = *rep;
        if (solve_contacts(pack, s, kept, o, rep, why)) break;
        rep->seconds += before.seconds, rep->elapsed += before.elapsed, rep->work += before.work;
        if (o->solve.history) continue; // which is of the last solve
        rep->sweeps += before.sweeps, rep->newton += before.newton;
        rep->safeguarded += before.safeguarded, rep->gave_up += before.gave_up;
    }
    rebound_free(search);
    return why->status;
}

int step_solve_contacts(const struct packing *pack, struct contacts *s, struct plan **kept,
                        const struct step_opt *o, struct report *rep, struct why *why)
{
    if (depth_of(&rep->depth, pack, s, NULL, why)) return why->status;
    if (!o->warm) contacts_free_found(s);
    if (solve_contacts(pack, s, kept, o, rep, why)) return why->status;
    return step_bound_impacts(pack, s, kept, o, rep, why);
}

int step_solve(const struct packing *pack, struct contacts *s, const struct step_opt *o,
               struct report *rep, struct why *why)
{
    if (step_solve_contacts(pack, s, NULL, o, rep, why)) return why->status;
    return step_balance(pack, s, o, rep, why);
}

int step_solve_delassus(struct delassus *W, double *u, const struct step_opt *o, struct report *rep,
                        struct why *why)
{
    struct problem p;
    if (!o->warm)
        for (int64_t i = 0; i < W->d * W->n; i++) W->r[i] = 0;
    if (problem_prepare_delassus(&p, W, o->alpha, o->solve.method->rho, o->order, why))
        return why->status;
    rep->balanced = rep->tied = rep->may_gain = false;
    int failed = solve_problem(&p, &o->solve, rep);
    for (int64_t i = 0; i < p.slots; i++) {
        double r[3], v[3];
        if (p.contact[i] < 0) continue;
        slot_get(&p, i, r, v);
        for (int k = 0; k < W->d; k++) u[W->d * p.contact[i] + k] = v[k];
    }
    problem_free(&p);
    return failed ? why_set(why, EX_SOFTWARE, "no memory to solve the contacts") : 0;
}

int step_detect(struct packing *p, struct contacts *s, struct neighbours *near,
                const struct step_opt *o, struct report *rep, struct why *why)
{
    double cpu = report_seconds(CLOCK_CPU);
    memory_set(&p->memory, o->warm);
    packing_tidy(p, NULL);
    int e = detect_contacts(s, p, o->gap, near, why);
    rep->detection = report_seconds(CLOCK_CPU) - cpu;
    return e || !o->warm ? e : memory_give(&p->memory, s, packing_rolls(p), why);
}

int step_balance(const struct packing *p, const struct contacts *s, const struct step_opt *o,
                 struct report *rep, struct why *why)
{
    struct impulses sum = { 0 };
    sum_up(p, s, o, rep, &sum, why);
    impulses_free(&sum);
    return why->status;
}

int step_move(struct packing *p, struct contacts *s, const struct step_opt *o, struct report *rep,
              struct why *why)
{
    struct impulses sum = { 0 };
    if (!sum_up(p, s, o, rep, &sum, why) && isfinite(rep->err.paper.eps_glob))
        move_by(p, s, &sum, why);
    impulses_free(&sum);
    return why->status;
}

void step_forget(struct step_memory *m)
{
    neighbours_free(&m->near);
    plan_free(m->plan);
    *m = (struct step_memory){ 0 };
}

void step_watch(const struct packing *p, int64_t n, const struct surface *surface,
                struct report *rep)
{
    struct passed passed;
    rep->watched = swift_watches(p);
    swift_passed(&passed, p, n, surface);
    rep->passed = passed.n;
    if (passed.n) rep->passed_id = passed.id, rep->passed_through = passed.through;
}

int step_advance(struct packing *p, struct contacts *s, struct step_memory *m,
                 const struct step_opt *o, struct report *rep, struct why *why)
{
    struct neighbours once = { 0 }, *near = m ? &m->near : NULL;
    if (step_detect(p, s, near, o, rep, why) ||
        step_solve_contacts(p, s, m ? &m->plan : NULL, o, rep, why) || step_move(p, s, o, rep, why))
        return why->status;
    if (!neighbours_surfaces(near ? near : &once, p, why))
        step_watch(p, p->n, (near ? near : &once)->surface, rep);
    neighbours_free(&once);
    return why->status;
}
