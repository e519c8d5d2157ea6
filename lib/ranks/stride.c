/* ranks/stride.c: one time step of all ranks [ranks/stride.h]. */
#include "ranks/stride.h"

#include "bodies/detect.h"
#include "bodies/freedom.h"
#include "bodies/tidy.h"
#include "problem/prepare.h"
#include "ranks/blocks.h"
#include "ranks/colours.h"
#include "ranks/roll.h"
#include "ranks/settings.h"

#include <stdlib.h>
#include <string.h>

enum {
    CUT_AFTER = 20 /* steps that cuts are left alone, at least */
};
#define IMBALANCE                                                                                  \
    1.1 /* contacts of the rank that has most over the mean: from here on cuts are made anew */

void stride_begin(struct stride *y, struct talk *t, const struct packing *whole, struct rows *rows)
{
    int varies = packing_varies(whole);
    MPI_Bcast(&varies, 1, MPI_INT, 0, t->comm);
    *y = (struct stride){ .varies = varies, .scattered = rows };
    if (!rows) {
        part_begin(&y->part, t, whole);
        return;
    }
    y->mean_mass = rows->heavy > 0 ? rows->mass / rows->heavy : 1;
    MPI_Bcast(&y->mean_mass, 1, MPI_DOUBLE, 0, t->comm);
    rows_deal(rows, &y->part, whole);
}

void stride_begin_again(struct stride *y, const struct packing *whole)
{
    neighbours_free(&y->near);
    part_begin_again(&y->part, whole);
}

void stride_free(struct stride *y)
{
    neighbours_free(&y->near);
    part_free(&y->part);
}

static void fail(const struct stride *y, const struct why *why)
{
    talk_fail(y->part.talk, why->status, why->text);
}

/* Keeps the contacts for which keep[] is true, with their ties. */
static void sift(struct contacts *s, const bool *keep)
{
    int64_t n = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (!keep[i]) continue;
        if (s->tie) s->tie[n] = s->tie[i];
        s->c[n++] = s->c[i];
    }
    s->n = n;
}

/* The pairs within reach in which this rank has a body: contacts, but where laws decide what is one */
static void find_contacts(struct stride *y, double gap, double reach, struct contacts *s)
{
    struct part *part = &y->part;
    struct why why = { 0 };
    if (part_deal(part, reach)) neighbours_free(&y->near);
    if (detect_near(s, &part->p, reach, &y->near, &why)) fail(y, &why);
    bool *keep = talk_new(part->talk, s->n, sizeof *keep);
    for (int64_t i = 0; i < s->n; i++) keep[i] = part_has(part, &s->c[i]);
    sift(s, keep);
    free(keep);
    if (!part->p.law && detect_choose(s, &part->p, gap, reach, &why)) fail(y, &why);
}

static bool same_contact(const struct contact *x, const struct contact *y)
{
    return x->a == y->a && x->b == y->b && x->feature == y->feature &&
           !memcmp(x->shift, y->shift, sizeof x->shift);
}

/* The first rank chooses by the laws which of `all` are contacts; then all ranks have these. */
static int choose_by_laws(struct stride *y, const struct packing *whole, struct roll *roll,
                          struct contacts *s, struct contacts *all, const struct step_opt *o,
                          double reach, struct why *why)
{
    struct talk *t = y->part.talk;
    struct contacts before = { 0 };
    struct verdict *of = talk_new(t, t->me ? 0 : roll->n, sizeof *of),
                   *mine = talk_new(t, s->n, sizeof *mine);
    if (!t->me) {
        if (contacts_copy(&before, all))
            return free(of), free(mine), why_set(why, EX_SOFTWARE, "no memory for the contacts");
        if (detect_choose(all, whole, o->gap, reach, why)) return free(of), free(mine), why->status;
        int64_t k = 0;
        for (int64_t i = 0; i < before.n; i++) {
            of[i].row = before.c[i].b;
            of[i].keep = k < all->n && same_contact(&before.c[i], &all->c[k]);
            k += of[i].keep;
        }
    }
    roll_tell(roll, &y->part, s, of, mine);
    int64_t n = 0;
    for (int64_t i = 0; i < roll->n && !t->me; i++)
        if (of[i].keep) roll->whose[n++] = roll->whose[i];
    roll->n = t->me ? 0 : n;
    MPI_Bcast(&roll->n, 1, MPI_INT64_T, 0, t->comm);
    bool *keep = talk_new(t, s->n, sizeof *keep);
    for (int64_t i = 0; i < s->n; i++) keep[i] = mine[i].keep;
    sift(s, keep);
    free(keep), free(of), free(mine);
    contacts_free(&before);
    return 0;
}

/* The order of all, by the first: of[roll->n], and its groups, bundles and halves in size[] */
static int order_all(const struct stride *y, const struct packing *whole,
                     const struct contacts *all, enum order order, struct verdict *of,
                     int64_t size[3], struct why *why)
{
    struct schedule plan = { 0 };
    if (!y->part.talk->me && schedule_bodies(&plan, order, all, whole))
        return why_set(why, EX_SOFTWARE, "no memory for the order of the contacts");
    size[0] = plan.groups, size[1] = 0, size[2] = plan.rest > 0;
    for (int64_t g = 0; g < plan.groups; g++) {
        int64_t first = plan.group[g], n = plan.group[g + 1] - first;
        for (int64_t i = 0; i < n; i++) {
            int64_t c = plan.sequence[first + i];
            of[c] = (struct verdict){ size[1] * BUNDLE + i, g, 1, all->c[c].b };
        }
        size[1] += (n + BUNDLE - 1) / BUNDLE;
    }
    schedule_free(&plan);
    MPI_Bcast(size, 3, MPI_INT64_T, 0, y->part.talk->comm);
    return 0;
}

/* kg: as one process adds it */
static double mean_mass(const struct stride *y, const struct packing *whole)
{
    double sum = 0, n = 0;
    if (y->scattered) return y->mean_mass;
    for (int64_t i = 0; i < whole->n && !y->part.talk->me; i++)
        sum += whole->mass[i], n += whole->mass[i] > 0;
    double mean = n > 0 ? sum / n : 1;
    MPI_Bcast(&mean, 1, MPI_DOUBLE, 0, y->part.talk->comm);
    return mean;
}

/* Prepared, solved and stored, by all ranks */
static void solve(struct stride *y, struct problem *p, struct contacts *s, const struct step_opt *o,
                  struct report *rep)
{
    int64_t bytes = y->part.talk->bytes, messages = y->part.talk->messages;
    double since = talk_busy() - y->part.talk->waited;
    if (solve_problem(p, &o->solve, rep) || problem_store(p, s))
        talk_fail(y->part.talk, EX_SOFTWARE, "no memory to solve the contacts");
    y->sweeps += rep->sweeps;
    y->busy[0] += talk_busy() - y->part.talk->waited - since;
    y->solved[0] += y->part.talk->bytes - bytes;
    y->solved[1] += y->part.talk->messages - messages;
}

/* In the order of all; returns whether it is solved: else one process has to have all of it. */
static bool solve_in_order(struct stride *y, const struct packing *whole, const struct roll *roll,
                           struct contacts *s, const struct contacts *all, const struct step_opt *o,
                           struct report *rep, struct why *why)
{
    struct talk *t = y->part.talk;
    int64_t size[3];
    struct colours c;
    struct problem p;
    struct verdict *of = talk_new(t, t->me ? 0 : roll->n, sizeof *of),
                   *mine = talk_new(t, s->n, sizeof *mine);
    if (order_all(y, whole, all, o->order, of, size, why)) fail(y, why);
    roll_tell(roll, &y->part, s, of, mine);
    free(of);
    colours_begin(&c, &y->part, s, mine, size[0], size[1]);
    free(mine);
    c.shared.contacts = roll->n, c.shared.halves = size[2];
    c.shared.mean_mass = mean_mass(y, whole);
    if (problem_prepare_shared(&p, &y->part.p, s, o->alpha, o->solve.method->rho, &c.plan,
                               &c.shared, why))
        fail(y, why);
    solve(y, &p, s, o, rep);
    bool solved = !c.shared.wants_whole;
    problem_free(&p);
    colours_free(&c);
    return solved;
}

/* Each rank its own; *b is to be freed. */
static void solve_in_blocks(struct stride *y, struct blocks *b, const struct packing *whole,
                            struct contacts *s, const struct step_opt *o, struct report *rep,
                            struct why *why)
{
    struct problem p;
    bool *keep = talk_new(y->part.talk, s->n, sizeof *keep);
    for (int64_t i = 0; i < s->n; i++) keep[i] = part_counts(&y->part, &s->c[i]);
    int64_t n = 0;
    for (int64_t i = 0; i < s->n && s->found; i++)
        if (keep[i]) s->found[n++] = s->found[i];
    sift(s, keep);
    free(keep);
    blocks_begin(b, &y->part, s, o->order);
    b->shared.mean_mass = mean_mass(y, whole);
    if (problem_prepare_shared(&p, &y->part.p, s, o->alpha, o->solve.method->rho, &b->plan,
                               &b->shared, why))
        fail(y, why);
    blocks_brake(b, &p, s);
    solve(y, &p, s, o, rep);
    problem_free(&p);
}

/* Can ranks solve it together? */
static bool is_shared(const struct packing *p, const struct step_opt *o)
{
    const struct solver *g = o->solve.global;
    bool sweeps = g == &solver_auto || g == &solver_nlgs;
    for (int32_t k = 0; p->law && k < p->kinds * p->kinds; k++)
        if (law_adheres(&p->law[k])) return false;
    return (sweeps || (g == &solver_anderson && !packing_rolls(p))) && !freedoms_in(p);
}

bool stride_scatters(const struct packing *p, const struct step_opt *o)
{
    return o->order == ORDER_BLOCK && is_shared(p, o) && !p->law && !o->warm && !packing_varies(p);
}

static double max_overlap(const struct contacts *s)
{
    double depth = 0;
    for (int64_t i = 0; i < s->n; i++) depth = fmax(depth, -s->c[i].gap);
    return depth;
}

/* What only a bond knows of the widest gap, which the first rank has */
static void measure(struct stride *y, const struct packing *whole)
{
    double apart = y->part.talk->me ? 0 : packing_whole(whole).apart;
    part_measure(&y->part);
    MPI_Bcast(&apart, 1, MPI_DOUBLE, 0, y->part.talk->comm);
    y->part.whole.apart = apart;
}

/* The pairs here that are contacts, or may be by laws */
static void detect_here(struct stride *y, const struct packing *whole, struct contacts *s,
                        const struct step_opt *o, double *reach)
{
    packing_tidy(&y->part.p, NULL);
    measure(y, whole);
    *reach = talk_most(y->part.talk, detect_reach(&y->part.p, o->gap));
    find_contacts(y, o->gap, *reach, s);
}

/* The contacts here in s, those of all in `all`, and what they start from */
static int detect(struct stride *y, struct packing *whole, struct contacts *all, struct roll *roll,
                  struct contacts *s, const struct step_opt *o, struct why *why)
{
    struct talk *t = y->part.talk;
    struct contacts before = { 0 };
    double reach;
    if (o->warm) before = *all, *all = (struct contacts){ 0 };
    if (!t->me) packing_tidy(whole, &before);
    detect_here(y, whole, s, o, &reach);
    roll_call(roll, &y->part, s, all);
    int e = y->part.p.law ? choose_by_laws(y, whole, roll, s, all, o, reach, why) : 0;
    if (!e && !t->me && o->warm && contacts_match(all, &before))
        e = why_set(why, EX_SOFTWARE, "no memory for the last reactions");
    contacts_free(&before);
    if (!e && (y->part.p.law || o->warm)) roll_tell_laws(roll, &y->part, s, all);
    return e;
}

static void balance_load(struct stride *y, const struct contacts *s)
{
    y->imbalance = part_imbalance(&y->part, s);
    y->worst = fmax(y->worst, y->imbalance);
    y->steps++;
    if (y->imbalance <= IMBALANCE || y->steps - y->since < CUT_AFTER) return;
    part_recut(&y->part);
    y->since = y->steps;
}

/* ---- a step whose motion the first rank makes ---- */

static int step_by_first(struct stride *y, struct packing *whole, struct contacts *all,
                         const struct step_opt *o, struct report *rep, struct why *why)
{
    struct talk *t = y->part.talk;
    struct roll roll;
    struct contacts s = { 0 };
    struct blocks b;
    bool solved = is_shared(&y->part.p, o), blocks = solved && o->order == ORDER_BLOCK;
    double cpu = report_seconds(CLOCK_CPU);
    if (detect(y, whole, all, &roll, &s, o, why)) return why->status;
    rep->detection = report_seconds(CLOCK_CPU) - cpu;
    if (!t->me) {
        rep->step = whole->step + 1, rep->t = whole->t + whole->dt;
        rep->err.max_overlap = max_overlap(all);
    }
    if (blocks)
        solve_in_blocks(y, &b, whole, &s, o, rep, why), blocks_free(&b);
    else if (solved)
        solved = solve_in_order(y, whole, &roll, &s, all, o, rep, why);
    if (solved) roll_found(&roll, &y->part, &s, all);
    y->alone += !solved;
    if (!t->me) {
        if (!solved && step_solve_contacts(whole, all, o, rep, why)) return why->status;
        if (step_move(whole, all, o, rep, why)) return why->status;
        settings_copy_motion(&y->part.p, whole);
    }
    settings_follow(t, &y->part.p);
    part_follow(&y->part, whole);
    balance_load(y, &s);
    roll_free(&roll), contacts_free(&s);
    return 0;
}

/* ---- a step that each rank makes with its own, and the first hears of where a frame is kept ---- */

/* The contacts of all and their reactions, for the frame that the first keeps */
static void tell_contacts(struct stride *y, struct contacts *all, const struct contacts *s)
{
    struct roll roll;
    roll_call(&roll, &y->part, s, all);
    roll_found(&roll, &y->part, s, all);
    roll_free(&roll);
}

static int step_by_all(struct stride *y, struct packing *whole, struct contacts *all,
                       const struct step_opt *o, struct report *rep, struct why *why)
{
    struct talk *t = y->part.talk;
    struct contacts s = { 0 };
    struct blocks b;
    double reach, cpu = report_seconds(CLOCK_CPU);
    int told[2] = { o->bare, y->contacts };
    MPI_Bcast(told, 2, MPI_INT, 0, t->comm);
    const bool bare = told[0];
    detect_here(y, whole, &s, o, &reach);
    rep->detection = report_seconds(CLOCK_CPU) - cpu;
    rep->step = y->part.p.step + 1, rep->t = y->part.p.t + y->part.p.dt;
    rep->err.max_overlap = talk_most(t, max_overlap(&s));
    rep->balanced = !bare, rep->tied = false;
    solve_in_blocks(y, &b, whole, &s, o, rep, why);
    bool moves = isfinite(rep->err.paper.eps_glob);
    if (moves) {
        if (!bare && told[1]) tell_contacts(y, all, &s);
        blocks_move(&b, &s, bare ? NULL : &rep->balance);
        if (!t->me) settings_copy_motion(whole, &y->part.p);
    }
    if (!y->scattered && (!bare || !moves)) part_collect(&y->part, whole);
    balance_load(y, &s);
    blocks_free(&b);
    contacts_free(&s);
    return 0;
}

int stride_step(struct stride *y, struct packing *whole, struct contacts *all,
                const struct step_opt *o, struct report *rep, struct why *why)
{
    bool by_all = stride_scatters(&y->part.p, o) && !y->varies;
    double since = talk_busy() - y->part.talk->waited;
    int e = (by_all ? step_by_all : step_by_first)(y, whole, all, o, rep, why);
    y->busy[1] += talk_busy() - y->part.talk->waited - since;
    return e;
}
