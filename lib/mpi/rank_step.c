/* mpi/rank_step.c: one time step of all ranks [mpi/rank_step.h]. */
#include "mpi/rank_step.h"
#include "contact/depth.h"

#include "contact/detect.h"
#include "contact/touching.h"
#include "contact/tunnelling.h"
#include "mpi/blocks.h"
#include "mpi/colours.h"
#include "mpi/contact_list.h"
#include "mpi/settings.h"
#include "solve/prepare.h"
#include "state/account.h"
#include "state/freedom.h"
#include "state/placement.h"

#include <stdlib.h>
#include <string.h>

enum {
    CUT_AFTER = 20, /* steps that cuts are left alone, */
    LOST_MOST = 2   /* unless so many steps' work was lost since by what they became worse */
};
/* Contacts of the rank that has most over the mean: from here on cuts are made anew. */
#define IMBALANCE 1.1

void rank_step_begin(struct rank_step *y, struct comm *t, struct decomposition *space,
                     const struct packing *whole, struct rows *rows)
{
    int varies = packing_varies(whole);
    MPI_Bcast(&varies, 1, MPI_INT, 0, t->mpi);
    // the first cuts know no contacts
    *y = (struct rank_step){ .varies = varies, .scattered = rows, .since = -CUT_AFTER };
    if (!rows) {
        subdomain_begin(&y->part, t, space, whole);
        return;
    }
    y->mean_mass = rows->heavy > 0 ? rows->mass / rows->heavy : 1;
    MPI_Bcast(&y->mean_mass, 1, MPI_DOUBLE, 0, t->mpi);
    rows_deal(rows, &y->part, space, whole);
}

void rank_step_begin_again(struct rank_step *y, const struct packing *whole)
{
    neighbours_free(&y->near);
    subdomain_begin_again(&y->part, whole);
}

void rank_step_act(struct rank_step *y, const struct packing *whole)
{
    subdomain_act(&y->part, whole, y->scattered);
}

void rank_step_free(struct rank_step *y)
{
    neighbours_free(&y->near);
    subdomain_free(&y->part);
}

static void rank_step_fail(const struct rank_step *y, const struct failure *failure)
{
    comm_fail(y->part.comm, failure->status, failure->text);
}

/* Keeps the contacts for which keep[] is true, with all that is known of them. */
static void rank_step_sift(struct contacts *s, const bool *keep)
{
    int64_t n = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (!keep[i]) continue;
        if (s->law) s->law[n] = s->law[i];
        if (s->found) s->found[n] = s->found[i];
        if (s->moment) memcpy(s->moment[n], s->moment[i], sizeof *s->moment);
        s->c[n++] = s->c[i];
    }
    s->n = n;
}

/* The pairs within reach in which this rank has a body: contacts, but where laws decide what is one */
static void find_contacts(struct rank_step *y, double gap, double reach, struct contacts *s)
{
    struct subdomain *part = &y->part;
    struct failure failure = { 0 };
    if (subdomain_deal(part, reach)) neighbours_free(&y->near);
    if (detect_near(s, &part->p, reach, &y->near, &failure)) rank_step_fail(y, &failure);
    bool *keep = comm_new(part->comm, s->n, sizeof *keep);
    for (int64_t i = 0; i < s->n; i++) keep[i] = subdomain_has(part, &s->c[i]);
    rank_step_sift(s, keep);
    free(keep);
    if (!part->p.law && detect_choose(s, &part->p, gap, reach, &failure))
        rank_step_fail(y, &failure);
}

/* Which of `before` laws have left in `all`, into of[before->n]; `added`: what they have put there besides */
static void rank_step_compare(struct comm *t, const struct contacts *before,
                              const struct contacts *all, struct verdict *of, struct parcel *added)
{
    int64_t k = 0;
    for (int64_t i = 0; i <= before->n; i++) {
        int order = -1;
        while (k < all->n) {
            order = i < before->n ? contact_compare(&all->c[k], &before->c[i]) : -1;
            if (order >= 0) break;
            parcel_put(t, added, &all->c[k++], sizeof *all->c);
        }
        if (i == before->n) break;
        of[i].row = before->c[i].b, of[i].keep = k < all->n && order == 0;
        k += of[i].keep;
    }
}

/* Puts those of `added`, by rows of the whole, into s in which this rank has a body. */
static void insert(const struct rank_step *y, struct contacts *s, struct parcel *added)
{
    struct comm *t = y->part.comm;
    struct contacts both = { 0 };
    int64_t n = (int64_t)(added->size / sizeof(struct contact)), i = 0;
    both.c = comm_new(t, s->n + n, sizeof *both.c), both.room = s->n + n;
    for (; n > 0; n--) {
        struct contact c;
        parcel_take(t, added, &c, sizeof c);
        int32_t a = c.a < 0 ? c.a : subdomain_find(&y->part, c.a),
                b = subdomain_find(&y->part, c.b);
        bool here = b >= 0 && (c.a < 0 || a >= 0); // else neither body is this rank's
        c.a = a, c.b = b;
        if (!here || !subdomain_has(&y->part, &c)) continue;
        while (i < s->n && contact_compare(&s->c[i], &c) < 0) both.c[both.n++] = s->c[i++];
        both.c[both.n++] = c;
    }
    while (i < s->n) both.c[both.n++] = s->c[i++];
    contacts_free(s);
    *s = both;
}

/* Bonds between shapes are contacts where detection finds none [contact/bond_anchor.h]: these become known to the
   ranks that have their bodies, and the list is gathered again. */
static void add_to_all(struct rank_step *y, struct contact_list *list, struct contacts *s,
                       const struct contacts *all, struct parcel *added)
{
    struct comm *t = y->part.comm;
    struct contacts again = { 0 };
    comm_spread(t, added);
    if (!added->size) return;
    insert(y, s, added);
    contact_list_free(list);
    contact_list_gather(list, &y->part, s, &again);
    bool alike = t->me || again.n == all->n;
    for (int64_t i = 0; !t->me && alike && i < all->n; i++)
        alike = !contact_compare(&again.c[i], &all->c[i]);
    if (!alike) comm_fail(t, EX_SOFTWARE, "ranks disagree about the contacts of bonds");
    contacts_free(&again);
}

/* Contacts that this rank has, and those of all, which the first has */
struct rank_step_gathered {
    struct contacts *here, *all;
    struct contact_list *list; /* which of `all` are whose */
};

/* The first rank chooses by the laws which of all are contacts, and adds others; then all ranks have these. */
static int choose_by_laws(struct rank_step *y, const struct packing *whole,
                          const struct rank_step_gathered *g, const struct step_opt *o,
                          double reach, struct failure *failure)
{
    struct contact_list *list = g->list;
    struct contacts *s = g->here, *all = g->all;
    struct comm *t = y->part.comm;
    struct contacts before = { 0 };
    struct parcel added = { 0 };
    struct verdict *of = comm_new(t, t->me ? 0 : list->n, sizeof *of),
                   *mine = comm_new(t, s->n, sizeof *mine);
    if (!t->me) {
        if (contacts_copy(&before, all))
            return free(of), free(mine),
                   failure_set(failure, EX_SOFTWARE, "no memory for the contacts");
        if (detect_choose(all, whole, o->gap, reach, failure))
            return free(of), free(mine), failure->status;
        rank_step_compare(t, &before, all, of, &added);
    }
    contact_list_tell(list, &y->part, s, of, mine);
    int64_t n = 0;
    for (int64_t i = 0; i < list->n && !t->me; i++)
        if (of[i].keep) list->whose[n++] = list->whose[i];
    list->n = t->me ? 0 : n;
    MPI_Bcast(&list->n, 1, MPI_INT64_T, 0, t->mpi);
    bool *keep = comm_new(t, s->n, sizeof *keep);
    for (int64_t i = 0; i < s->n; i++) keep[i] = mine[i].keep;
    rank_step_sift(s, keep);
    free(keep), free(of), free(mine);
    contacts_free(&before);
    add_to_all(y, list, s, all, &added);
    parcel_free(&added);
    return 0;
}

/* The order of all contacts; all but `of` are known to all ranks */
struct ordered {
    struct verdict *of; /* [list->n] */
    int64_t groups, bundles, halves;
};

/* Sets it, by the first. */
static int order_all(const struct rank_step *y, const struct packing *whole,
                     const struct contacts *all, enum order order, struct ordered *to,
                     struct failure *failure)
{
    int64_t size[3];
    struct schedule plan = { 0 };
    if (!y->part.comm->me && schedule_bodies(&plan, order, all, whole))
        return failure_set(failure, EX_SOFTWARE, "no memory for the order of the contacts");
    size[0] = plan.groups, size[1] = 0, size[2] = plan.rest > 0;
    for (int64_t g = 0; g < plan.groups; g++) {
        int64_t first = plan.group[g], n = plan.group[g + 1] - first;
        for (int64_t i = 0; i < n; i++) {
            int64_t c = plan.sequence[first + i];
            to->of[c] = (struct verdict){ size[1] * BUNDLE + i, g, 1, all->c[c].b };
        }
        size[1] += (n + BUNDLE - 1) / BUNDLE;
    }
    schedule_free(&plan);
    MPI_Bcast(size, 3, MPI_INT64_T, 0, y->part.comm->mpi);
    to->groups = size[0], to->bundles = size[1], to->halves = size[2];
    return 0;
}

/* kg: as one process adds it */
static double mean_mass(const struct rank_step *y, const struct packing *whole)
{
    if (y->scattered) return y->mean_mass;
    double mean = y->part.comm->me ? 0 : packing_mean_mass(whole);
    MPI_Bcast(&mean, 1, MPI_DOUBLE, 0, y->part.comm->mpi);
    return mean;
}

/* Prepared, solved and stored, by all ranks */
static void rank_step_solve(struct rank_step *y, struct problem *p, struct contacts *s,
                            const struct step_opt *o, struct report *rep)
{
    int64_t bytes = y->part.comm->bytes, messages = y->part.comm->messages;
    double since = comm_busy() - y->part.comm->waited;
    if (solve_problem(p, &o->solve, rep) || problem_store(p, s))
        comm_fail(y->part.comm, EX_SOFTWARE, "no memory to solve the contacts");
    y->sweeps += rep->sweeps;
    y->busy[0] += comm_busy() - y->part.comm->waited - since;
    y->solved[0] += y->part.comm->bytes - bytes;
    y->solved[1] += y->part.comm->messages - messages;
}

/* In the order of all; returns whether it is solved: else one process has to have all of it. */
static bool solve_in_order(struct rank_step *y, const struct packing *whole,
                           const struct rank_step_gathered *g, const struct step_opt *o,
                           struct report *rep, struct failure *failure)
{
    const struct contact_list *list = g->list;
    struct contacts *s = g->here;
    struct comm *t = y->part.comm;
    struct colours c;
    struct problem p;
    struct ordered order = { .of = comm_new(t, t->me ? 0 : list->n, sizeof *order.of) };
    struct verdict *mine = comm_new(t, s->n, sizeof *mine);
    if (order_all(y, whole, g->all, o->order, &order, failure)) rank_step_fail(y, failure);
    contact_list_tell(list, &y->part, s, order.of, mine);
    free(order.of);
    colours_begin(&c, &y->part, s, mine, order.groups, order.bundles);
    free(mine);
    c.exchange.contacts = list->n, c.exchange.halves = order.halves;
    c.exchange.mean_mass = mean_mass(y, whole);
    const struct prepare_opt form = { .alpha = o->alpha,
                                      .rho_factor = o->solve.method->rho,
                                      .schedule = &c.plan,
                                      .exchange = &c.exchange };
    if (problem_prepare(&p, &y->part.p, s, &form, failure)) rank_step_fail(y, failure);
    rank_step_solve(y, &p, s, o, rep);
    bool solved = !c.exchange.wants_whole;
    problem_free(&p);
    colours_free(&c);
    return solved;
}

/* Each rank its own; *b is to be freed. */
static void solve_in_blocks(struct rank_step *y, struct blocks *b, const struct packing *whole,
                            struct contacts *s, const struct step_opt *o, struct report *rep)
{
    struct failure failure = { 0 };
    struct problem p;
    bool *keep = comm_new(y->part.comm, s->n, sizeof *keep);
    for (int64_t i = 0; i < s->n; i++) keep[i] = subdomain_counts(&y->part, &s->c[i]);
    rank_step_sift(s, keep);
    free(keep);
    blocks_begin(b, &y->part, s, o->order);
    b->exchange.mean_mass = mean_mass(y, whole);
    const struct prepare_opt form = { .alpha = o->alpha,
                                      .rho_factor = o->solve.method->rho,
                                      .schedule = &b->plan,
                                      .exchange = &b->exchange };
    if (problem_prepare(&p, &y->part.p, s, &form, &failure)) rank_step_fail(y, &failure);
    rank_step_solve(y, &p, s, o, rep);
    problem_free(&p);
}

/* May impacts be bounded, by the first rank, which then has all contacts? */
static bool bounds_impacts(const struct packing *p)
{
    bool said = false;
    for (int32_t k = 0; p->law && k < p->materials * p->materials; k++)
        said = said || p->law[k].impact == IMPACT_BOUNDED;
    return packing_may_gain(p) && (p->shape || said);
}

bool rank_step_scatters(const struct packing *p, const struct step_opt *o)
{
    return o->order == ORDER_BLOCK && !freedoms_in(p) && !p->law && !o->warm &&
           !packing_varies(p) && !bounds_impacts(p) && !p->sums.n;
}

/* The pairs here that are contacts, or may be by laws */
static void detect_here(struct rank_step *y, const struct packing *whole, struct contacts *s,
                        const struct step_opt *o, double *reach)
{
    // of the widest gap only a bond knows, and bonds are the first's
    double apart = y->part.comm->me ? 0 : packing_whole(whole).apart;
    packing_wrap(&y->part.p, NULL);
    subdomain_measure(&y->part);
    MPI_Bcast(&apart, 1, MPI_DOUBLE, 0, y->part.comm->mpi);
    y->part.whole.apart = apart;
    *reach = comm_most(y->part.comm, detect_reach(&y->part.p, o->gap));
    find_contacts(y, o->gap, *reach, s);
}

/* The contacts, and what they start from */
static int rank_step_detect(struct rank_step *y, struct packing *whole,
                            const struct rank_step_gathered *g, const struct step_opt *o,
                            struct failure *failure)
{
    struct contact_list *list = g->list;
    struct contacts *s = g->here, *all = g->all;
    struct comm *t = y->part.comm;
    double reach;
    if (!t->me) memory_set(&whole->memory, o->warm), packing_wrap(whole, NULL);
    if (!t->me && touching_bond(whole, failure)) return failure->status;
    detect_here(y, whole, s, o, &reach);
    contact_list_gather(list, &y->part, s, all);
    int e = y->part.p.law ? choose_by_laws(y, whole, g, o, reach, failure) : 0;
    if (!e && !t->me && o->warm)
        e = memory_give(&whole->memory, all, packing_rolls(whole), failure);
    if (!e && (y->part.p.law || o->warm)) contact_list_tell_laws(list, &y->part, s, all);
    return e;
}

static void balance_load(struct rank_step *y, const struct contacts *s)
{
    double imbalance = subdomain_imbalance(&y->part, s);
    y->worst = fmax(y->worst, imbalance), y->uneven += imbalance;
    y->steps++;
    if (y->steps == y->since + 1) y->fresh = imbalance, y->lost = 0;
    y->lost += imbalance - y->fresh;
    if (imbalance <= IMBALANCE) return;
    if (y->steps - y->since < CUT_AFTER && y->lost <= LOST_MOST) return;
    subdomain_recut(&y->part);
    y->since = y->steps;
}

/* ---- a step whose motion the first rank makes ---- */

/* The first rank's step, in which others help it to find and solve contacts */
struct by_first {
    struct step_makers makers; /* first: it is what the functions below are given */
    struct rank_step *y;
    struct contact_list list;
    struct contacts here;
};

static int detect_by_first(struct step_makers *m, struct packing *whole, struct contacts *all,
                           const struct step_opt *o, struct failure *failure)
{
    struct by_first *f = (struct by_first *)m;
    return rank_step_detect(f->y, whole, &(struct rank_step_gathered){ &f->here, all, &f->list }, o,
                            failure);
}

static int solve_by_first(struct step_makers *m, const struct packing *whole, struct contacts *all,
                          const struct step_opt *o, struct report *rep, struct failure *failure)
{
    struct by_first *f = (struct by_first *)m;
    struct rank_step *y = f->y;
    struct blocks b;
    bool solved = !freedoms_in(&y->part.p), blocks = solved && o->order == ORDER_BLOCK;
    if (blocks)
        solve_in_blocks(y, &b, whole, &f->here, o, rep), blocks_free(&b);
    else if (solved)
        solved = solve_in_order(y, whole, &(struct rank_step_gathered){ &f->here, all, &f->list },
                                o, rep, failure);
    if (solved) contact_list_found(&f->list, &y->part, &f->here, all);
    y->alone += !solved;
    if (m->helps) return 0;
    return solved ? step_bound_impacts(whole, all, NULL, o, rep, failure)
                  : step_solve_contacts(whole, all, NULL, o, rep, failure);
}

static int step_by_first(struct rank_step *y, struct packing *whole, struct contacts *all,
                         const struct step_opt *o, struct report *rep, struct failure *failure)
{
    struct comm *t = y->part.comm;
    struct by_first f = { .makers = { .helps = t->me,
                                      .detect = detect_by_first,
                                      .measure = step_measure_whole,
                                      .solve = solve_by_first,
                                      .balance = step_balance_whole,
                                      .find_unsolved = step_unsolved_whole,
                                      .move_apart = step_move_apart_whole,
                                      .watch = step_watch_whole },
                          .y = y };
    if (step_make(&f.makers, whole, all, o, rep, failure)) return failure->status;
    if (!t->me) settings_copy_motion(&y->part.p, whole);
    settings_follow(t, &y->part.p);
    subdomain_follow(&y->part, whole);
    balance_load(y, &f.here);
    contact_list_free(&f.list), contacts_free(&f.here);
    return 0;
}

/* ---- a step that each rank makes with its own, and the first hears of where a frame is kept ---- */

/* The contacts of all and their reactions, for the frame that the first keeps */
static void tell_contacts(struct rank_step *y, struct contacts *all, const struct contacts *s)
{
    struct contact_list list;
    contact_list_gather(&list, &y->part, s, all);
    contact_list_found(&list, &y->part, s, all);
    contact_list_free(&list);
}

/* own[p.n]: which bodies are this rank's own; to be freed */
static bool *own_bodies(const struct rank_step *y)
{
    const struct subdomain *part = &y->part;
    bool *own = comm_new(part->comm, part->p.n, sizeof *own);
    for (int64_t i = 0; i < part->p.n; i++) own[i] = part->owner[i] == part->comm->me;
    return own;
}

/* How deep they are, to all: a body counts where it is this rank's own, with all its contacts. Of ranks with
   the same depth the pair of the largest ids stands. */
static void measure_depth(struct rank_step *y, const struct contacts *s, struct depth *d)
{
    struct comm *t = y->part.comm;
    struct failure failure = { 0 };
    bool *own = own_bodies(y);
    if (depth_of(d, &y->part.p, s, own, &failure)) rank_step_fail(y, &failure);
    free(own);
    const double most = comm_most(t, d->deepest), none = -1e300;
    bool here = d->deepest == most;
    for (int k = 0; k < 2; k++) {
        double id = comm_most(t, here ? d->pair[k] : none);
        here = here && d->pair[k] == id;
        d->pair[k] = (int32_t)id;
    }
    double first = comm_most(t, d->pinched ? -d->pinched_id : none);
    d->pinched = comm_sum(t, d->pinched), d->pinched_id = d->pinched ? (int32_t)-first : 0;
    d->deepest = most;
}

/* The step of all ranks, each with its own bodies and contacts */
struct by_all {
    struct step_makers makers; /* first: it is what the functions below are given */
    struct rank_step *y;
    struct packing *whole;
    struct contacts *all; /* NULL: nobody needs those of all */
    struct blocks blocks;
};

static int detect_by_all(struct step_makers *m, struct packing *p, struct contacts *s,
                         const struct step_opt *o, struct failure *failure)
{
    struct by_all *a = (struct by_all *)m;
    double reach;
    (void)p, (void)failure;
    detect_here(a->y, a->whole, s, o, &reach);
    return 0;
}

static int measure_by_all(struct step_makers *m, const struct packing *p, const struct contacts *s,
                          struct report *rep, struct failure *failure)
{
    struct rank_step *y = ((struct by_all *)m)->y;
    (void)p, (void)failure;
    rep->err.max_overlap = comm_most(y->part.comm, contacts_max_overlap(s));
    measure_depth(y, s, &rep->depth);
    return 0;
}

static int solve_by_all(struct step_makers *m, const struct packing *p, struct contacts *s,
                        const struct step_opt *o, struct report *rep, struct failure *failure)
{
    struct by_all *a = (struct by_all *)m;
    (void)p;
    solve_in_blocks(a->y, &a->blocks, a->whole, s, o, rep);
    if (a->all && !o->bare && isfinite(rep->err.paper.eps_glob)) tell_contacts(a->y, a->all, s);
    return failure->status;
}

static void add_impulses_by_all(struct step_makers *m, struct impulses *sum)
{
    blocks_add_impulses(&((struct by_all *)m)->blocks, sum);
}

static int balance_by_all(struct step_makers *m, const struct packing *p, const struct contacts *s,
                          const struct impulses *sum, struct balance *b, struct failure *failure)
{
    (void)p, (void)failure;
    blocks_balance(&((struct by_all *)m)->blocks, s, sum, b);
    return 0;
}

/* Of ranks whose contacts are as far off the pair of the largest ids stands. */
static void find_unsolved_by_all(struct step_makers *m, const struct packing *p,
                                 const struct contacts *s, struct report *rep)
{
    struct comm *t = ((struct by_all *)m)->y->part.comm;
    double off;
    const bool any = contacts_unsolved(s, &off) >= 0;
    if (any) step_unsolved_whole(m, p, s, rep);
    bool here = comm_most(t, off) == off && any;
    for (int k = 0; k < 2; k++) {
        double id = comm_most(t, here ? rep->unsolved[k] : -INFINITY);
        here = here && rep->unsolved[k] == id;
        rep->unsolved[k] = isfinite(id) ? (int32_t)id : 0;
    }
}

/* The body of the least id, and what of it */
static void agree_by_all(struct step_makers *m, struct report *rep)
{
    struct comm *t = ((struct by_all *)m)->y->part.comm;
    struct endless *e = &rep->endless;
    if (comm_most(t, e->what) == 0) return;
    const double id = -comm_most(t, e->what ? -(double)e->id : -INFINITY);
    const double what = comm_most(t, e->what && e->id == id ? e->what : 0);
    *e = (struct endless){ (enum endless_what)what, (int32_t)id };
}

static int move_apart_by_all(struct step_makers *m, struct packing *p, const struct contacts *s,
                             struct projected *did, struct failure *failure)
{
    (void)p, (void)failure;
    blocks_move_apart(&((struct by_all *)m)->blocks, s, did);
    return 0;
}

static void watch_by_all(struct step_makers *m, const struct packing *p, struct report *rep)
{
    struct rank_step *y = ((struct by_all *)m)->y;
    struct comm *t = y->part.comm;
    bool *own = own_bodies(y);
    const int64_t here = tunnelling_count(p, own, &rep->fast_id);
    free(own);
    const double first = -comm_most(t, here ? -(double)rep->fast_id : -INFINITY);
    rep->watched = rep->watched || y->part.all > 1; // which no rank has all of
    rep->fast = comm_sum(t, here), rep->fast_id = rep->fast ? (int32_t)first : 0;
}

static int step_by_all(struct rank_step *y, struct packing *whole, struct contacts *all,
                       const struct step_opt *o, struct report *rep, struct failure *failure)
{
    struct comm *t = y->part.comm;
    struct contacts s = { 0 };
    int told[3] = { o->bare, y->contacts, y->may_end };
    MPI_Bcast(told, 3, MPI_INT, 0, t->mpi);
    struct step_opt of_first = *o;
    of_first.bare = told[0];
    struct by_all a = { .makers = { .detect = detect_by_all,
                                    .measure = measure_by_all,
                                    .solve = solve_by_all,
                                    .add_impulses = add_impulses_by_all,
                                    .balance = balance_by_all,
                                    .agree = agree_by_all,
                                    .find_unsolved = find_unsolved_by_all,
                                    .move_apart = move_apart_by_all,
                                    .watch = watch_by_all },
                        .y = y,
                        .whole = whole,
                        .all = told[1] ? all : NULL };
    if (step_make(&a.makers, &y->part.p, &s, &of_first, rep, failure)) rank_step_fail(y, failure);
    if (!t->me && report_made(rep)) settings_copy_motion(whole, &y->part.p);
    // with such a step the run ends, and keeps this
    const bool ends = !report_made(rep) || (told[2] && account_step_fails(rep));
    if (!y->scattered && (!of_first.bare || ends)) subdomain_collect(&y->part, whole);
    balance_load(y, &s);
    blocks_free(&a.blocks);
    contacts_free(&s);
    return 0;
}

/* ---- a step, in parts where small steps could not make it ---- */

/* Collective: the part, of all packings that know the time */
static int make_part(struct rank_step *y, struct substeps *s, struct packing *whole,
                     struct contacts *all, bool by_all, const struct step_opt *o,
                     struct report *rep, struct failure *failure)
{
    const bool first = !y->part.comm->me;
    substeps_enter(s, &y->part.p);
    if (first) substeps_enter(s, whole);
    if ((by_all ? step_by_all : step_by_first)(y, whole, all, o, rep, failure))
        return failure->status;
    substeps_leave(s, &y->part.p);
    if (first) substeps_leave(s, whole);
    if (first) return substeps_add(s, whole, all, rep, failure);
    substeps_count(s);
    return 0;
}

int rank_step_make(struct rank_step *y, struct packing *whole, struct contacts *all,
                   const struct step_opt *o, struct report *rep, struct failure *failure)
{
    bool by_all = rank_step_scatters(&y->part.p, o) && !y->varies;
    double since = comm_busy() - y->part.comm->waited;
    struct substeps steps;
    int e = 0;
    MPI_Bcast(&y->parts, 1, MPI_INT64_T, 0, y->part.comm->mpi);
    substeps_begin(&steps, &y->part.p, y->parts);
    const struct step_opt part = step_opt_part(o, &steps);
    for (int ends = 0; !ends && !e;) {
        e = make_part(y, &steps, whole, all, by_all, &part, rep, failure);
        ends = steps.ends;
        // one whose solve diverges ends the step, which the first knows
        if (!e && !substeps_alone(&steps)) MPI_Bcast(&ends, 1, MPI_INT, 0, y->part.comm->mpi);
    }
    substeps_free(&steps);
    y->busy[1] += comm_busy() - y->part.comm->waited - since;
    return e;
}
