/* mpi/blocks.c: every rank its own contacts, an exchange a sweep [mpi/blocks.h]. */
#include "mpi/blocks.h"

#include "mpi/halo.h"
#include "state/rotation.h"

#include "solve/mass_splitting.h"
#include "step/move.h"
#include "step/project.h"

#include <stdlib.h>
#include <string.h>

enum {
    TWIST = 6, /* numbers of a body's velocity */
    TAG = 9
};

static struct blocks *blocks_of(struct exchange *s)
{
    return (struct blocks *)s;
}

/* Where the numbers of a body are that ranks add up: `width` of them */
typedef double *place_text(void *of, int32_t body);

static double *twist_of(void *problem, int32_t body)
{
    const struct problem *p = problem;
    return (double *)&p->body[p->seat[body]]; // v[3], and w[3] after it
}

/* What goes to each rank and comes from it: so many numbers for each body of the lists */
static void post(struct comm *t, int width, const struct border *go_list, double **go,
                 const struct border *come_list, double **come)
{
    MPI_Request *r = comm_new(t, 2 * t->n, sizeof(MPI_Request));
    int n = 0;
    for (int q = 0; q < t->n; q++)
        if (come_list[q].n)
            MPI_Irecv(come[q], (int)(width * come_list[q].n), MPI_DOUBLE, q, TAG, t->mpi, &r[n++]);
    for (int q = 0; q < t->n; q++) {
        if (!go_list[q].n) continue;
        MPI_Isend(go[q], (int)(width * go_list[q].n), MPI_DOUBLE, q, TAG, t->mpi, &r[n++]);
        t->bytes += width * go_list[q].n * (int64_t)sizeof(double), t->messages++;
    }
    double since = comm_busy();
    MPI_Waitall(n, r, MPI_STATUSES_IGNORE);
    comm_waited(t, since);
    free(r);
}

static double **letters(const struct comm *t, const struct border *b, int width)
{
    double **v = comm_new(t, t->n, sizeof *v);
    for (int q = 0; q < t->n; q++) v[q] = comm_new(t, width * b[q].n, sizeof **v);
    return v;
}

static void letters_free(const struct comm *t, double **v)
{
    for (int q = 0; v && q < t->n; q++) free(v[q]);
    free(v);
}

static void blocks_remember(struct blocks *b, int width, place_text *at, void *arg, double **since)
{
    for (int q = 0; q < b->part->comm->n; q++)
        for (int64_t k = 0; k < b->touched[q].n; k++)
            memcpy(since[q] + width * k, at(arg, b->touched[q].body[k]),
                   (size_t)width * sizeof **since);
}

/* Copies' changes since[] are added to the bodies, in the order of ranks; copies become what these are. */
static void add_up(struct blocks *b, int width, place_text *at, void *arg, double **since)
{
    struct comm *t = b->part->comm;
    double **here = letters(t, b->touched, width), **there = letters(t, b->pushed, width);
    const size_t size = (size_t)width * sizeof(double);
    for (int q = 0; q < t->n; q++)
        for (int64_t k = 0; k < b->touched[q].n; k++) {
            const double *v = at(arg, b->touched[q].body[k]);
            for (int j = 0; j < width; j++) here[q][width * k + j] = v[j] - since[q][width * k + j];
        }
    post(t, width, b->touched, here, b->pushed, there);
    for (int q = 0; q < t->n; q++)
        for (int64_t k = 0; k < b->pushed[q].n; k++) {
            double *v = at(arg, b->pushed[q].body[k]);
            for (int j = 0; j < width; j++) v[j] += there[q][width * k + j];
        }
    for (int q = 0; q < t->n; q++)
        for (int64_t k = 0; k < b->pushed[q].n; k++)
            memcpy(there[q] + width * k, at(arg, b->pushed[q].body[k]), size);
    post(t, width, b->pushed, there, b->touched, here);
    for (int q = 0; q < t->n; q++)
        for (int64_t k = 0; k < b->touched[q].n; k++)
            memcpy(at(arg, b->touched[q].body[k]), here[q] + width * k, size);
    letters_free(t, here), letters_free(t, there);
    blocks_remember(b, width, at, arg, since);
}

static void blocks_settle(struct exchange *s, struct problem *p)
{
    add_up(blocks_of(s), TWIST, twist_of, p, blocks_of(s)->since);
}

static void blocks_after_group(struct exchange *s, struct problem *p, int64_t group)
{
    if (group == blocks_of(s)->plan.groups - 1) blocks_settle(s, p);
}

static void blocks_begin_solve(struct exchange *s, struct problem *p)
{
    blocks_remember(blocks_of(s), TWIST, twist_of, p, blocks_of(s)->since);
}

static void blocks_judging(struct exchange *s, struct problem *p, bool begins)
{
    (void)s;
    mass_splitting_hold(p, !begins);
}

static void blocks_add(struct exchange *s, double *x, int n)
{
    struct comm *t = blocks_of(s)->part->comm;
    double *all = comm_new(t, (int64_t)n * t->n, sizeof *all), since = comm_busy();
    MPI_Allgather(x, n, MPI_DOUBLE, all, n, MPI_DOUBLE, t->mpi);
    comm_waited(t, since);
    for (int j = 0; j < n; j++) x[j] = 0;
    for (int q = 0; q < t->n; q++)
        for (int j = 0; j < n; j++) x[j] += all[q * n + j];
    free(all);
}

static double blocks_sum_along(struct exchange *s, const struct problem *p, const double *term)
{
    double sum = 0;
    for (int64_t i = 0; i < p->slots; i++) sum += p->contact[i] >= 0 ? term[i] : 0;
    blocks_add(s, &sum, 1);
    return sum;
}

/* ---- the borders ---- */

/* touched[] of what the contacts push; pushed[] as the others tell */
static void blocks_find_borders(struct blocks *b, const struct contacts *s)
{
    const struct subdomain *y = b->part;
    struct comm *t = y->comm;
    struct parcel *out = parcels_new(t), *in = parcels_new(t);
    bool *is = comm_new(t, y->p.n, sizeof *is);
    for (int64_t i = 0; i < s->n; i++) {
        int32_t a = s->c[i].a;
        if (a >= 0 && y->owner[a] != t->me && y->p.mass[a] > 0) is[a] = true;
    }
    b->touched = comm_new(t, t->n, sizeof *b->touched);
    b->pushed = comm_new(t, t->n, sizeof *b->pushed);
    b->since = comm_new(t, t->n, sizeof *b->since);
    for (int q = 0; q < t->n; q++) {
        struct border *to = &b->touched[q];
        to->body = comm_new(t, y->here[q].n, sizeof *to->body);
        for (int64_t k = 0; k < y->here[q].n; k++) {
            int32_t body = y->here[q].body[k];
            if (!is[body]) continue;
            int32_t place = (int32_t)k; // among those that the owner has lent
            to->body[to->n++] = body;
            parcel_put(t, &out[q], &place, sizeof place);
        }
        b->since[q] = comm_new(t, TWIST * to->n, sizeof **b->since);
    }
    free(is);
    comm_exchange(t, out, in);
    for (int q = 0; q < t->n; q++) {
        struct border *from = &b->pushed[q];
        int64_t n = (int64_t)(in[q].size / sizeof(int32_t));
        from->body = comm_new(t, n, sizeof *from->body);
        for (; from->n < n; from->n++) {
            int32_t place;
            parcel_take(t, &in[q], &place, sizeof place);
            if (place < 0 || place >= y->lent[q].n)
                comm_fail(t, EX_SOFTWARE, "ranks disagree about a border");
            from->body[from->n] = y->lent[q].body[place];
        }
    }
    parcels_free(t, out), parcels_free(t, in);
}

/* ranks[n]: how many ranks push each body at once */
static int32_t *count_ranks(const struct blocks *b)
{
    const struct subdomain *y = b->part;
    struct comm *t = y->comm;
    int32_t *ranks = comm_new(t, y->p.n, sizeof *ranks);
    struct parcel *out = parcels_new(t), *in = parcels_new(t);
    for (int64_t i = 0; i < y->p.n; i++) ranks[i] = 1;
    for (int q = 0; q < t->n; q++)
        for (int64_t k = 0; k < b->pushed[q].n; k++) ranks[b->pushed[q].body[k]]++;
    for (int q = 0; q < t->n; q++)
        for (int64_t k = 0; k < b->pushed[q].n; k++)
            parcel_put(t, &out[q], &ranks[b->pushed[q].body[k]], sizeof *ranks);
    comm_exchange(t, out, in);
    for (int q = 0; q < t->n; q++)
        for (int64_t k = 0; k < b->touched[q].n; k++)
            parcel_take(t, &in[q], &ranks[b->touched[q].body[k]], sizeof *ranks);
    parcels_free(t, out), parcels_free(t, in);
    return ranks;
}

static void find_slower(struct blocks *b, const struct contacts *s)
{
    int32_t *ranks = count_ranks(b);
    b->slower = comm_new(b->part->comm, s->n, sizeof *b->slower);
    for (int64_t i = 0; i < s->n; i++) {
        const struct contact *c = &s->c[i];
        int32_t k = ranks[c->b];
        if (c->a >= 0 && ranks[c->a] > k) k = ranks[c->a];
        b->slower[i] = k;
    }
    free(ranks);
    b->exchange.slower = b->slower;
}

void blocks_begin(struct blocks *b, struct subdomain *y, const struct contacts *s, enum order order)
{
    struct comm *t = y->comm;
    *b = (struct blocks){ .part = y };
    b->exchange = (struct exchange){ .after_group = blocks_after_group,
                                     .begin = blocks_begin_solve,
                                     .settle = blocks_settle,
                                     .judging = blocks_judging,
                                     .add = blocks_add,
                                     .sum_along = blocks_sum_along };
    answers_alike(&b->exchange, t);
    blocks_find_borders(b, s);
    find_slower(b, s);
    if (schedule_bodies(&b->plan, order, s, &y->p))
        comm_fail(t, EX_SOFTWARE, "no memory for the order of the contacts");
    // a rank's threads share groups
    b->plan.beyond = b->plan.inside = b->plan.rim = b->plan.rest = 0;
    // one without a contact, in which the exchange is made all the same
    if (!b->plan.groups) {
        free(b->plan.group);
        b->plan.group = comm_new(t, 2, sizeof *b->plan.group), b->plan.groups = 1;
    }
    int64_t bundles = 0;
    for (int64_t g = 0; g < b->plan.groups; g++)
        bundles += (b->plan.group[g + 1] - b->plan.group[g] + BUNDLE - 1) / BUNDLE;
    b->exchange.contacts = comm_sum(t, s->n), b->exchange.bundles = comm_sum(t, bundles);
}

/* ---- the motion ---- */

static double *impulse_of(void *impulses, int32_t body)
{
    const struct impulses *sum = impulses;
    return &sum->force[body].x;
}

static double *moment_of(void *impulses, int32_t body)
{
    const struct impulses *sum = impulses;
    return &sum->moment[body].x;
}

static double *displacement_of(void *displaced, int32_t body)
{
    struct displaced *d = displaced;
    return &d[body].d.x;
}

/* Displacements that are being sought */
struct apart {
    struct blocks *b;
    double **since; /* those of copies after the last exchange */
};

static bool in_any(void *with, bool here)
{
    const struct apart *a = with;
    return comm_most(a->b->part->comm, here) > 0;
}

static bool after_sweep(void *with, struct displaced *d, bool more)
{
    struct apart *a = with;
    add_up(a->b, 3, displacement_of, d, a->since);
    return in_any(with, more);
}

/* The bodies of this rank */
static bool *blocks_own_of(const struct subdomain *y)
{
    bool *own = comm_new(y->comm, y->p.n, sizeof *own);
    for (int64_t i = 0; i < y->p.n; i++) own[i] = y->owner[i] == y->comm->me;
    return own;
}

static void project_here(struct blocks *b, const struct contacts *s, const bool *own,
                         struct projected *did)
{
    struct comm *t = b->part->comm;
    struct failure failure = { 0 };
    struct apart a = { b, letters(t, b->touched, 3) };
    const struct project_share share = { &a, own, b->slower, in_any, after_sweep };
    if (project_shared(&b->part->p, s, &share, did, &failure))
        comm_fail(t, failure.status, failure.text);
    letters_free(t, a.since);
    subdomain_refresh(b->part);
}

void blocks_move_apart(struct blocks *b, const struct contacts *s, struct projected *did)
{
    const struct packing *p = &b->part->p;
    bool *own = did ? blocks_own_of(b->part) : NULL;
    subdomain_refresh(b->part);
    if (overlap_projects(p->overlap)) project_here(b, s, own, did);
    if (did && energy_has_peculiar(p)) did->peculiar = energy_peculiar(p, own);
    if (did)
        blocks_add(&b->exchange, (double *)did,
                   sizeof *did / sizeof(double)); // it has nothing else
    free(own);
}

void blocks_balance(struct blocks *b, const struct contacts *s, const struct impulses *sum,
                    struct balance *told)
{
    struct subdomain *y = b->part;
    struct failure failure = { 0 };
    bool *own = blocks_own_of(y);
    if (balance_step(told, &y->p, s, sum, own, &failure))
        comm_fail(y->comm, failure.status, failure.text);
    free(own);
    blocks_add(&b->exchange, (double *)told, sizeof *told / sizeof(double)); // it has nothing else
}

/* What impulses of copies begin with, dt times their force or torque from outside (NULL: none), which their owner has, too */
static double **begun(const struct blocks *b, const vec3 *acts)
{
    double **from = letters(b->part->comm, b->touched, 3);
    for (int q = 0; acts && q < b->part->comm->n; q++)
        for (int64_t k = 0; k < b->touched[q].n; k++) {
            vec3 x = v3_scale(b->part->p.dt, acts[b->touched[q].body[k]]);
            memcpy(&from[q][3 * k], &x, sizeof x);
        }
    return from;
}

void blocks_add_impulses(struct blocks *b, struct impulses *sum)
{
    const struct external_force *o = &b->part->p.outside;
    double **from = begun(b, o->force);
    add_up(b, 3, impulse_of, sum, from);
    letters_free(b->part->comm, from), from = begun(b, o->torque);
    add_up(b, 3, moment_of, sum, from);
    letters_free(b->part->comm, from);
}

void blocks_free(struct blocks *b)
{
    const struct comm *t = b->part->comm;
    borders_free(t, b->touched), borders_free(t, b->pushed);
    letters_free(t, b->since);
    free(b->slower);
    schedule_free(&b->plan);
    *b = (struct blocks){ 0 };
}
