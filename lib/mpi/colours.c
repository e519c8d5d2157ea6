/* mpi/colours.c: the order of all contacts, walked by all ranks [mpi/colours.h]. */
#include "mpi/colours.h"

#include "mpi/halo.h"

#include <stdlib.h>
#include <string.h>

enum { PARTS = 3, COPIES = 1, QUIET = 2 }; /* of a group, and two of them; 0: what is told of */

/* ---- what solvers ask ---- */

static struct colours *colours_of(struct exchange *s)
{
    return (struct colours *)s;
}

static void colours_after_group(struct exchange *s, struct problem *p, int64_t group)
{
    struct colours *c = colours_of(s);
    if (group % PARTS == COPIES) halo_send(&c->wires, p, group / PARTS);
    if (group % PARTS == QUIET) halo_wait(&c->wires, p, group / PARTS);
}

static void colours_begin_solve(struct exchange *s, struct problem *p)
{
    (void)s, (void)p;
}

static void colours_settle(struct exchange *s, struct problem *p)
{
    halo_refresh(colours_of(s)->part, p);
}

static void colours_judging(struct exchange *s, struct problem *p, bool begins)
{
    (void)s, (void)p, (void)begins;
}

static const struct tally_order *tally(struct colours *c, const struct problem *p)
{
    if (!c->tallied) tally_begin(&c->tally, c->part->comm, p, c->slot, c->exchange.bundles);
    c->tallied = true;
    return &c->tally;
}

static void sum(struct exchange *s, const struct problem *p, const struct summands *of, double *out)
{
    struct colours *c = colours_of(s);
    tally_sum(tally(c, p), c->part->comm, s->bundles, of, out);
}

static double colours_sum_along(struct exchange *s, const struct problem *p, const double *term)
{
    struct colours *c = colours_of(s);
    return tally_along(tally(c, p), c->part->comm, s->bundles, term);
}

/* ---- the order ---- */

/* other[first[i]] .. other[first[i + 1] - 1]: the ranks that have copies of body i */
struct holders {
    int64_t *first;
    int32_t *rank;
};

static void holders_find(struct holders *h, const struct subdomain *y)
{
    const struct comm *t = y->comm;
    h->first = comm_new(t, y->p.n + 1, sizeof *h->first);
    for (int q = 0; q < t->n; q++)
        for (int64_t k = 0; k < y->lent[q].n; k++) h->first[y->lent[q].body[k] + 2]++;
    for (int64_t i = 0; i <= y->p.n; i++) h->first[i + 1] += h->first[i];
    // first[i + 1] is where the next rank of body i goes, and in the end where body i + 1 begins
    h->rank = comm_new(t, h->first[y->p.n + 1], sizeof *h->rank);
    for (int q = 0; q < t->n; q++)
        for (int64_t k = 0; k < y->lent[q].n; k++) h->rank[h->first[y->lent[q].body[k] + 1]++] = q;
}

/* Body i (own, and moving) of a contact whose other body is `other` (< 0: a wall): who must be told of
   what this contact makes of it? Returns how many. */
static int told(const struct subdomain *y, const struct holders *h, int32_t i, int32_t other,
                int32_t *rank)
{
    int n = 0;
    if (i < 0 || y->owner[i] != y->comm->me || !(y->p.mass[i] > 0)) return 0;
    for (int64_t k = h->first[i]; k < h->first[i + 1]; k++)
        if (other < 0 || y->owner[other] != h->rank[k]) rank[n++] = h->rank[k];
    return n;
}

/* A contact's place in the walk */
struct stop {
    int64_t group, slot, contact;
};

static int by_walk(const void *a, const void *b)
{
    const struct stop *x = a, *y = b;
    if (x->group != y->group) return x->group < y->group ? -1 : 1;
    return x->slot < y->slot ? -1 : x->slot > y->slot;
}

static void colours_lay_plan(struct colours *c, const struct comm *t, int64_t groups, int64_t n,
                             struct stop *stop)
{
    struct schedule *plan = &c->plan;
    int64_t bundles = 0;
    qsort(stop, (size_t)n, sizeof *stop, by_walk);
    plan->groups = PARTS * groups;
    plan->sequence = comm_new(t, n, sizeof *plan->sequence);
    plan->group = comm_new(t, plan->groups + 1, sizeof *plan->group);
    for (int64_t i = 0; i < n; i++) {
        plan->sequence[i] = stop[i].contact;
        plan->group[stop[i].group + 1]++;
    }
    c->exchange.copies = comm_new(t, 2 * groups, sizeof *c->exchange.copies);
    for (int64_t g = 0; g < plan->groups; g++) {
        int64_t more = (plan->group[g + 1] + BUNDLE - 1) / BUNDLE;
        if (g % PARTS == COPIES && more) {
            c->exchange.copies[2 * c->exchange.n_copies] = bundles;
            c->exchange.copies[2 * c->exchange.n_copies++ + 1] = bundles + more;
        }
        bundles += more;
        plan->group[g + 1] += plan->group[g];
    }
}

static int by_errand(const void *a, const void *b)
{
    const struct halo_item *x = a, *y = b;
    if (x->rank != y->rank) return x->rank < y->rank ? -1 : 1;
    if (x->group != y->group) return x->group < y->group ? -1 : 1;
    return x->body < y->body ? -1 : x->body > y->body;
}

void colours_begin(struct colours *c, struct subdomain *y, const struct contacts *s,
                   const struct verdict *verdict, int64_t groups, int64_t bundles)
{
    struct comm *t = y->comm;
    struct holders h;
    int64_t errands = 0, room = 0;
    struct halo_item *errand = NULL;
    int32_t *rank = comm_new(t, t->n, sizeof *rank);
    struct stop *stop = comm_new(t, s->n, sizeof *stop);
    *c = (struct colours){ .part = y };
    c->exchange = (struct exchange){ .bundles = bundles,
                                     .may_want = true,
                                     .after_group = colours_after_group,
                                     .begin = colours_begin_solve,
                                     .settle = colours_settle,
                                     .judging = colours_judging,
                                     .sum = sum,
                                     .sum_along = colours_sum_along };
    answers_alike(&c->exchange, t);
    c->slot = comm_new(t, s->n, sizeof *c->slot);
    holders_find(&h, y);
    for (int64_t i = 0; i < s->n; i++) {
        const struct contact *k = &s->c[i];
        const int32_t body[2] = { k->b, k->a };
        bool mine = subdomain_counts(y, k), tells = false;
        for (int j = 0; j < 2; j++) {
            int n = told(y, &h, body[j], body[1 - j], rank);
            tells = tells || n;
            if (errands + n > room) {
                room = 2 * room + n + 256;
                errand = realloc(errand, (size_t)room * sizeof *errand);
                if (!errand) comm_fail(t, EX_SOFTWARE, "no memory for the borders");
            }
            for (int m = 0; m < n; m++)
                errand[errands++] = (struct halo_item){ verdict[i].group, rank[m], body[j] };
        }
        int in = !mine ? COPIES : tells ? 0 : QUIET;
        stop[i] = (struct stop){ PARTS * verdict[i].group + in, verdict[i].slot, i };
        c->slot[i] = mine ? verdict[i].slot : -1;
    }
    free(h.first), free(h.rank), free(rank);
    colours_lay_plan(c, t, groups, s->n, stop);
    free(stop);
    if (errands) qsort(errand, (size_t)errands, sizeof *errand, by_errand);
    halo_lay(&c->wires, y, groups, errands, errand);
    free(errand);
}

void colours_free(struct colours *c)
{
    halo_free(&c->wires);
    if (c->tallied) tally_free(&c->tally);
    free(c->slot), free(c->exchange.copies);
    schedule_free(&c->plan);
    *c = (struct colours){ 0 };
}
