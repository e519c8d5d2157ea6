/* mpi/subdomain.c: bodies dealt, and what is told of them [mpi/subdomain.h]. */
#include "mpi/subdomain.h"

#include "mpi/settings.h"
#include "state/part.h"

#include <malloc.h>
#include <stdlib.h>
#include <string.h>

/* A margin is the way of the fastest body in STEPS_AHEAD steps, in mean radii at least and at most: */
#define STEPS_AHEAD  16
#define MARGIN_LEAST 0.05
#define MARGIN_MOST  0.5

/* What a body weighs beside a contact, when space is cut: it is moved once a step, and seeks neighbours, while a
   contact is solved a hundred times. Its half of each contact comes on top. */
#define A_BODY 0.1f

/* A body on its way: this, then its row of each column that the packing has */
struct traveller {
    int32_t row, owner, load;
};

static void subdomain_fail(const struct subdomain *y, const struct failure *failure)
{
    comm_fail(y->comm, failure->status, failure->text);
}

/* What acts on body i from outside, where anything does */
static void put_force(struct comm *t, struct parcel *to, const struct packing *p, int64_t i)
{
    const struct external_force *o = &p->outside;
    if (o->force) parcel_put(t, to, &o->force[i], sizeof *o->force);
    if (o->torque) parcel_put(t, to, &o->torque[i], sizeof *o->torque);
}

static void take_force(struct comm *t, struct parcel *from, struct packing *p, int64_t i)
{
    struct external_force *o = &p->outside;
    if (o->force) parcel_take(t, from, &o->force[i], sizeof *o->force);
    if (o->torque) parcel_take(t, from, &o->torque[i], sizeof *o->torque);
}

static size_t force_bytes(const struct packing *p)
{
    return (p->outside.force ? sizeof(vec3) : 0) + (p->outside.torque ? sizeof(vec3) : 0);
}

/* What a body has of all columns, or of those that move, into a parcel and out of one */
static void put_body(struct comm *t, struct parcel *to, const struct packing *p, int64_t i,
                     bool moving)
{
    for (const struct field *b = body_columns; b->name; b++)
        if (field_array(b, p) && (!moving || b->traits & FIELD_MOVES))
            parcel_put(t, to, field_row(b, p, i), field_bytes(b));
}

static void take_body(struct comm *t, struct parcel *from, struct packing *p, int64_t i,
                      bool moving)
{
    for (const struct field *b = body_columns; b->name; b++)
        if (field_array(b, p) && (!moving || b->traits & FIELD_MOVES))
            parcel_take(t, from, field_row(b, p, i), field_bytes(b));
}

/* Bytes of a traveller with all that follows it */
static size_t traveller_bytes(const struct packing *p)
{
    size_t bytes = sizeof(struct traveller) + force_bytes(p);
    for (const struct field *b = body_columns; b->name; b++)
        if (field_array(b, p)) bytes += field_bytes(b);
    return bytes;
}

void borders_free(const struct comm *t, struct border *b)
{
    for (int q = 0; b && q < t->n; q++) free(b[q].body);
    free(b);
}

/* Room for n bodies, none of them set */
static void resize(struct subdomain *y, int64_t n)
{
    struct failure failure = { 0 };
    struct packing *p = &y->p;
    if (packing_resize(p, n, &failure)) subdomain_fail(y, &failure);
    free(y->row), free(y->owner), free(y->dealt), free(y->load);
    y->row = comm_new(y->comm, n, sizeof *y->row),
    y->owner = comm_new(y->comm, n, sizeof *y->owner);
    y->dealt = comm_new(y->comm, n, sizeof *y->dealt),
    y->load = comm_new(y->comm, n, sizeof *y->load);
}

/* What is known of a body that has been copied into row i of y->p */
static void subdomain_set_body(struct subdomain *y, int64_t i, struct traveller b)
{
    y->row[i] = b.row, y->owner[i] = b.owner, y->load[i] = b.load;
    y->dealt[i] = y->p.x[i];
}

/* These bodies, of rows from `first` on, are this rank's own. */
static void take_own(struct subdomain *y, const struct packing *p, int64_t n, int64_t first)
{
    y->all = comm_sum(y->comm, n);
    resize(y, n);
    for (int64_t i = 0; i < n; i++) {
        packing_copy_body(&y->p, i, p, i);
        subdomain_set_body(y, i, (struct traveller){ (int32_t)(first + i), y->comm->me, 0 });
    }
    y->own = n;
    y->margin = -1; // they are to be dealt
}

/* At first the first rank owns all bodies. */
static void take_all(struct subdomain *y, const struct packing *whole)
{
    take_own(y, whole, y->comm->me ? 0 : whole->n, 0);
}

static void subdomain_begin_empty(struct subdomain *y, struct comm *t, struct decomposition *space,
                                  const struct packing *settings)
{
    struct failure failure = { 0 };
    *y = (struct subdomain){ .comm = t, .territory = space };
    if (!t->me) {
        struct packing none = packing_settings(settings);
        none.scene = NULL;
        if (packing_copy(&y->p, &none, &failure)) subdomain_fail(y, &failure);
    }
    settings_spread(t, &y->p);
    y->p.whole = &y->whole;
}

void subdomain_begin(struct subdomain *y, struct comm *t, struct decomposition *space,
                     const struct packing *whole)
{
    subdomain_begin_empty(y, t, space, whole);
    take_all(y, whole);
    subdomain_recut(y);
}

void subdomain_begin_rows(struct subdomain *y, struct comm *t, struct decomposition *space,
                          const struct packing *settings, const struct own_rows *rows)
{
    subdomain_begin_empty(y, t, space, settings);
    take_own(y, rows->p, rows->p->n, rows->first);
    if (y->all != rows->all) comm_fail(t, EX_SOFTWARE, "ranks disagree about rows of bodies");
    subdomain_recut(y);
}

void subdomain_begin_again(struct subdomain *y, const struct packing *whole)
{
    take_all(y, whole);
}

void subdomain_free(struct subdomain *y)
{
    borders_free(y->comm, y->lent), borders_free(y->comm, y->here);
    free(y->row), free(y->owner), free(y->dealt), free(y->load);
    packing_free(&y->p);
    decomposition_free(y->territory);
    *y = (struct subdomain){ 0 };
}

void subdomain_measure(struct subdomain *y)
{
    struct packing *p = &y->p;
    p->whole = NULL;
    struct whole w = packing_whole(p);
    double most[5] = { w.speed, w.rotation_speed, -w.small, w.large, w.apart }, all[5];
    MPI_Allreduce(most, all, 5, MPI_DOUBLE, MPI_MAX, y->comm->mpi);
    y->whole = (struct whole){ all[0], all[1], -all[2], all[3], all[4] };
    p->whole = &y->whole;
}

double subdomain_imbalance(struct subdomain *y, const struct contacts *s)
{
    memset(y->load, 0, (size_t)y->p.n * sizeof *y->load);
    int64_t mine = 0;
    for (int64_t i = 0; i < s->n; i++) {
        y->load[s->c[i].b]++;
        if (s->c[i].a >= 0) y->load[s->c[i].a]++;
        mine += subdomain_counts(y, &s->c[i]);
    }
    double most = comm_most(y->comm, (double)mine);
    int64_t all = comm_sum(y->comm, mine);
    return all ? most * y->comm->n / (double)all : 1;
}

void subdomain_recut(struct subdomain *y)
{
    int64_t n = 0;
    vec3 *x = comm_new(y->comm, y->own, sizeof *x);
    float *weight = comm_new(y->comm, y->own, sizeof *weight);
    for (int64_t i = 0; i < y->p.n; i++)
        if (y->owner[i] == y->comm->me)
            x[n] = y->p.x[i], weight[n++] = A_BODY + 0.5f * (float)y->load[i];
    decomposition_cut(y->territory, n, x, weight);
    free(x), free(weight);
    y->margin = -1, y->cuts++;
}

/* ---- dealing ---- */

/* Has any own body gone further than half the margin, at the predicted position? */
static bool subdomain_is_due(const struct subdomain *y)
{
    bool due = y->margin < 0;
    for (int k = 0; k < 3; k++) due = due || (y->p.cell.repeats[k] && cell_moves(&y->p.cell, k));
    for (int64_t i = 0; i < y->p.n && !due; i++) {
        vec3 d = v3_sub(packing_predict(&y->p, i), y->dealt[i]);
        due = y->owner[i] == y->comm->me && !(v3_norm(d) <= 0.49 * y->margin);
    }
    return comm_most(y->comm, due) > 0;
}

/* The ranks that have a copy of a body which is at x, and those of its images: mark[] is set. */
static void mark_ranks(const struct subdomain *y, const vec3 x, double half, int *met, bool *mark)
{
    const struct cell *c = &y->p.cell;
    int most[3];
    for (int k = 0; k < 3; k++) most[k] = c->repeats[k] ? 1 : 0;
    for (int i = -most[0]; i <= most[0]; i++)
        for (int j = -most[1]; j <= most[1]; j++)
            for (int k = -most[2]; k <= most[2]; k++) {
                const int8_t shift[3] = { (int8_t)i, (int8_t)j, (int8_t)k };
                vec3 at = v3_add(x, cell_shift(c->edge, shift)), d = v3(half, half, half);
                int n = decomposition_meets(y->territory, v3_sub(at, d), v3_add(at, d), met);
                for (int m = 0; m < n; m++) mark[met[m]] = true;
            }
}

/* A traveller that has come: where it lies in its parcel */
struct arrival {
    struct traveller body;
    struct parcel *parcel;
    size_t at; /* of its columns */
};

static int by_row(const void *a, const void *b)
{
    const struct arrival *x = a, *y = b;
    return x->body.row < y->body.row ? -1 : x->body.row > y->body.row;
}

/* The lists of bodies that are here and elsewhere: a copy's rank tells the owner. */
static void subdomain_find_borders(struct subdomain *y)
{
    struct comm *t = y->comm;
    struct parcel *out = parcels_new(t), *in = parcels_new(t);
    borders_free(t, y->lent), borders_free(t, y->here);
    y->lent = comm_new(t, t->n, sizeof *y->lent), y->here = comm_new(t, t->n, sizeof *y->here);
    for (int64_t i = 0; i < y->p.n; i++)
        if (y->owner[i] != t->me) y->here[y->owner[i]].n++;
    for (int q = 0; q < t->n; q++) {
        y->here[q].body = comm_new(t, y->here[q].n, sizeof *y->here[q].body);
        y->here[q].n = 0;
    }
    for (int64_t i = 0; i < y->p.n; i++) {
        struct border *b = &y->here[y->owner[i]];
        if (y->owner[i] == t->me) continue;
        b->body[b->n++] = (int32_t)i;
        parcel_put(t, &out[y->owner[i]], &y->row[i], sizeof *y->row);
    }
    comm_exchange(t, out, in);
    for (int q = 0; q < t->n; q++) {
        struct border *b = &y->lent[q];
        int64_t at = 0;
        b->n = (int64_t)(in[q].size / sizeof *y->row);
        b->body = comm_new(t, b->n, sizeof *b->body);
        for (int64_t k = 0; k < b->n; k++) { // both lists ascend
            int32_t row;
            parcel_take(t, &in[q], &row, sizeof row);
            while (at < y->p.n && y->row[at] < row) at++;
            if (at == y->p.n || y->row[at] != row)
                comm_fail(t, EX_SOFTWARE, "ranks disagree: a copy of a body that is not here");
            b->body[k] = (int32_t)at;
        }
    }
    parcels_free(t, out), parcels_free(t, in);
}

static double subdomain_mean_radius(const struct subdomain *y)
{
    double sum = 0, all;
    for (int64_t i = 0; i < y->p.n; i++) sum += y->owner[i] == y->comm->me ? y->p.radius[i] : 0;
    MPI_Allreduce(&sum, &all, 1, MPI_DOUBLE, MPI_SUM, y->comm->mpi);
    return y->all ? all / (double)y->all : 0;
}

/* m: every step must stay within half of it */
static double choose_margin(const struct subdomain *y)
{
    double r = subdomain_mean_radius(y), step = y->p.dt * y->whole.speed;
    double m = fmax(fmin(STEPS_AHEAD * step, MARGIN_MOST * r), MARGIN_LEAST * r);
    return fmax(m, 2.1 * step);
}

static void send_bodies(struct subdomain *y, double reach, struct parcel *out)
{
    struct comm *t = y->comm;
    int *met = comm_new(t, t->n, sizeof *met);
    bool *mark = comm_new(t, t->n, sizeof *mark);
    for (int64_t i = 0; i < y->p.n; i++) {
        if (y->owner[i] != t->me) continue;
        int owner = decomposition_owner(y->territory, y->p.x[i]);
        memset(mark, 0, (size_t)t->n * sizeof *mark);
        mark_ranks(y, y->p.x[i], y->p.radius[i] + y->whole.large + reach + y->margin, met, mark);
        mark[owner] = true;
        const struct traveller b = { y->row[i], owner, y->load[i] };
        for (int q = 0; q < t->n; q++)
            if (mark[q])
                parcel_put(t, &out[q], &b, sizeof b), put_body(t, &out[q], &y->p, i, false),
                    put_force(t, &out[q], &y->p, i);
    }
    free(met), free(mark);
}

/* Memory of parcels, in which all bodies have come and gone, is the system's again: it is kept otherwise. */
static void give_back(void)
{
#ifdef M_TRIM_THRESHOLD
    malloc_trim(0);
#endif
}

bool subdomain_deal(struct subdomain *y, double reach)
{
    struct comm *t = y->comm;
    if (!subdomain_is_due(y)) return false;
    y->margin = choose_margin(y), y->deals++;
    struct parcel *out = parcels_new(t), *in = parcels_new(t);
    send_bodies(y, reach, out);
    comm_exchange(t, out, in);
    const size_t bytes = traveller_bytes(&y->p);
    int64_t n = 0, k = 0;
    for (int q = 0; q < t->n; q++) n += (int64_t)(in[q].size / bytes);
    struct arrival *b = comm_new(t, n, sizeof *b);
    for (int q = 0; q < t->n; q++)
        for (size_t at = 0; at < in[q].size; at += bytes, k++) {
            in[q].at = at;
            parcel_take(t, &in[q], &b[k].body, sizeof b[k].body);
            b[k].parcel = &in[q], b[k].at = in[q].at;
        }
    qsort(b, (size_t)n, sizeof *b, by_row);
    resize(y, n);
    y->own = 0;
    for (int64_t i = 0; i < n; i++) {
        b[i].parcel->at = b[i].at;
        take_body(t, b[i].parcel, &y->p, i, false), take_force(t, b[i].parcel, &y->p, i);
        subdomain_set_body(y, i, b[i].body);
        y->own += b[i].body.owner == t->me;
    }
    free(b);
    parcels_free(t, out), parcels_free(t, in);
    subdomain_find_borders(y);
    give_back();
    return true;
}

static int compare_rows(const void *key, const void *row)
{
    int32_t x = *(const int32_t *)key, y = *(const int32_t *)row;
    return x < y ? -1 : x > y;
}

int32_t subdomain_find(const struct subdomain *y, int32_t row)
{
    const int32_t *at = bsearch(&row, y->row, (size_t)y->p.n, sizeof *at, compare_rows);
    return at ? (int32_t)(at - y->row) : -1;
}

/* ---- places and motion ---- */

/* act: and what acts on them */
static void subdomain_follow_all(struct subdomain *y, const struct packing *whole, bool act)
{
    struct comm *t = y->comm;
    struct parcel rows = { 0 }, mine = { 0 }, *in = parcels_new(t), *out = parcels_new(t);
    parcel_put(t, &rows, y->row, (size_t)y->p.n * sizeof *y->row);
    comm_gather(t, &rows, in);
    for (int q = 0; q < t->n && !t->me; q++)
        while (in[q].at < in[q].size) {
            int32_t row;
            parcel_take(t, &in[q], &row, sizeof row);
            put_body(t, &out[q], whole, row, true);
            if (act) put_force(t, &out[q], whole, row);
        }
    comm_scatter(t, out, &mine);
    for (int64_t i = 0; i < y->p.n; i++) {
        take_body(t, &mine, &y->p, i, true);
        if (act) take_force(t, &mine, &y->p, i);
    }
    parcel_free(&mine), parcels_free(t, in), parcels_free(t, out);
}

void subdomain_follow(struct subdomain *y, const struct packing *whole)
{
    subdomain_follow_all(y, whole, false);
}

void subdomain_act(struct subdomain *y, const struct packing *whole, bool scattered)
{
    settings_act(y->comm, &y->p, whole);
    if (!scattered) subdomain_follow_all(y, whole, true);
}

void subdomain_collect(const struct subdomain *y, struct packing *whole)
{
    struct comm *t = y->comm;
    struct parcel mine = { 0 }, *in = parcels_new(t);
    for (int64_t i = 0; i < y->p.n; i++) {
        if (y->owner[i] != t->me) continue;
        parcel_put(t, &mine, &y->row[i], sizeof *y->row), put_body(t, &mine, &y->p, i, true);
    }
    comm_gather(t, &mine, in);
    for (int q = 0; q < t->n && !t->me; q++)
        while (in[q].at < in[q].size) {
            int32_t row;
            parcel_take(t, &in[q], &row, sizeof row), take_body(t, &in[q], whole, row, true);
        }
    parcels_free(t, in);
}

void subdomain_refresh(struct subdomain *y)
{
    struct comm *t = y->comm;
    struct parcel *out = parcels_new(t), *in = parcels_new(t);
    for (int q = 0; q < t->n; q++)
        for (int64_t k = 0; k < y->lent[q].n; k++)
            put_body(t, &out[q], &y->p, y->lent[q].body[k], true);
    comm_exchange(t, out, in);
    for (int q = 0; q < t->n; q++)
        for (int64_t k = 0; k < y->here[q].n; k++)
            take_body(t, &in[q], &y->p, y->here[q].body[k], true);
    parcels_free(t, out), parcels_free(t, in);
}
