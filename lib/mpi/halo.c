/* mpi/halo.c: velocities between ranks [mpi/halo.h]. */
#include "mpi/halo.h"

#include "base/failure.h"

#include <stdlib.h>
#include <string.h>

enum {
    TWIST = 6, /* numbers of a body's velocity */
    TAG = 8
};

static struct wire *wire_to(struct halo *w, int rank)
{
    for (int k = 0; k < w->n; k++)
        if (w->wire[k].rank == rank) return &w->wire[k];
    struct wire *x = &w->wire[w->n++];
    x->rank = rank;
    x->go = comm_new(w->comm, w->groups + 1, sizeof *x->go);
    x->come = comm_new(w->comm, w->groups + 1, sizeof *x->come);
    return x;
}

static int64_t halo_largest(const int64_t *first, int64_t groups)
{
    int64_t most = 0;
    for (int64_t g = 0; g < groups; g++)
        if (first[g + 1] - first[g] > most) most = first[g + 1] - first[g];
    return most;
}

/* What comes from a rank: groups and rows, as it has told */
static void take_list(struct halo *w, const struct subdomain *y, struct parcel *in, int rank)
{
    int64_t n = 0;
    if (!in->size) return;
    struct wire *x = wire_to(w, rank);
    int64_t most = (int64_t)(in->size / (sizeof(int64_t) + sizeof(int32_t)));
    x->come_body = comm_new(w->comm, most, sizeof *x->come_body);
    while (in->at < in->size) {
        int64_t g;
        int32_t row;
        parcel_take(w->comm, in, &g, sizeof g), parcel_take(w->comm, in, &row, sizeof row);
        int32_t body = subdomain_find(y, row);
        if (body < 0 || g < 0 || g >= w->groups)
            comm_fail(w->comm, EX_SOFTWARE,
                      "ranks disagree: a velocity of a body that is not here");
        x->come_body[n++] = body, x->come[g + 1]++;
    }
}

void halo_lay(struct halo *w, const struct subdomain *y, int64_t groups, int64_t n,
              const struct halo_item *errand)
{
    struct comm *t = y->comm;
    struct parcel *out = parcels_new(t), *in = parcels_new(t);
    *w = (struct halo){ .comm = t, .groups = groups };
    w->wire = comm_new(t, t->n, sizeof *w->wire);
    w->request = comm_new(t, 2 * t->n, sizeof(MPI_Request));
    int64_t *many = comm_new(t, t->n, sizeof *many), *next = comm_new(t, t->n, sizeof *next);
    for (int64_t i = 0; i < n; i++) many[errand[i].rank]++;
    for (int64_t i = 0; i < n; i++) {
        struct wire *x = wire_to(w, errand[i].rank);
        if (!x->go_body) x->go_body = comm_new(t, many[x->rank], sizeof *x->go_body);
        x->go_body[next[x->rank]++] = errand[i].body, x->go[errand[i].group + 1]++;
        parcel_put(t, &out[x->rank], &errand[i].group, sizeof errand->group);
        parcel_put(t, &out[x->rank], &y->row[errand[i].body], sizeof *y->row);
    }
    free(many), free(next);
    comm_exchange(t, out, in);
    for (int q = 0; q < t->n; q++) take_list(w, y, &in[q], q);
    parcels_free(t, out), parcels_free(t, in);
    for (int k = 0; k < w->n; k++) {
        struct wire *x = &w->wire[k];
        for (int64_t g = 0; g < groups; g++) x->go[g + 1] += x->go[g], x->come[g + 1] += x->come[g];
        x->go_v = comm_new(t, TWIST * halo_largest(x->go, groups), sizeof *x->go_v);
        x->come_v = comm_new(t, TWIST * halo_largest(x->come, groups), sizeof *x->come_v);
    }
}

void halo_free(struct halo *w)
{
    for (int k = 0; k < w->n; k++) {
        struct wire *x = &w->wire[k];
        free(x->go), free(x->come), free(x->go_body), free(x->come_body);
        free(x->go_v), free(x->come_v);
    }
    free(w->wire), free(w->request);
    *w = (struct halo){ 0 };
}

static void read_twist(const struct problem *p, int32_t body, double v[TWIST])
{
    const struct body *b = &p->body[p->seat[body]];
    memcpy(v, b->v, sizeof b->v), memcpy(v + 3, b->w, sizeof b->w);
}

static void write_twist(struct problem *p, int32_t body, const double v[TWIST])
{
    struct body *b = &p->body[p->seat[body]];
    memcpy(b->v, v, sizeof b->v), memcpy(b->w, v + 3, sizeof b->w);
}

void halo_send(struct halo *w, const struct problem *p, int64_t g)
{
    w->requests = 0;
    for (int k = 0; k < w->n; k++) {
        struct wire *x = &w->wire[k];
        int64_t n = x->come[g + 1] - x->come[g];
        if (n)
            MPI_Irecv(x->come_v, (int)(TWIST * n), MPI_DOUBLE, x->rank, TAG, w->comm->mpi,
                      &w->request[w->requests++]);
    }
    for (int k = 0; k < w->n; k++) {
        struct wire *x = &w->wire[k];
        int64_t n = x->go[g + 1] - x->go[g];
        if (!n) continue;
        for (int64_t i = 0; i < n; i++)
            read_twist(p, x->go_body[x->go[g] + i], x->go_v + TWIST * i);
        MPI_Isend(x->go_v, (int)(TWIST * n), MPI_DOUBLE, x->rank, TAG, w->comm->mpi,
                  &w->request[w->requests++]);
        w->comm->bytes += TWIST * n * (int64_t)sizeof(double), w->comm->messages++;
    }
}

void halo_wait(struct halo *w, struct problem *p, int64_t g)
{
    if (!w->requests) return;
    double since = comm_busy();
    MPI_Waitall(w->requests, w->request, MPI_STATUSES_IGNORE);
    comm_waited(w->comm, since);
    w->requests = 0;
    for (int k = 0; k < w->n; k++) {
        const struct wire *x = &w->wire[k];
        for (int64_t i = x->come[g]; i < x->come[g + 1]; i++)
            write_twist(p, x->come_body[i], x->come_v + TWIST * (i - x->come[g]));
    }
}

void halo_refresh(const struct subdomain *y, struct problem *p)
{
    struct comm *t = y->comm;
    double v[TWIST];
    struct parcel *out = parcels_new(t), *in = parcels_new(t);
    for (int q = 0; q < t->n; q++)
        for (int64_t k = 0; k < y->lent[q].n; k++) {
            read_twist(p, y->lent[q].body[k], v);
            parcel_put(t, &out[q], v, sizeof v);
        }
    comm_exchange(t, out, in);
    for (int q = 0; q < t->n; q++)
        for (int64_t k = 0; k < y->here[q].n; k++) {
            parcel_take(t, &in[q], v, sizeof v);
            write_twist(p, y->here[q].body[k], v);
        }
    parcels_free(t, out), parcels_free(t, in);
}

/* ---- what ranks answer alike ---- */

static double most(struct exchange *s, double x)
{
    return comm_most(s->with, x);
}

static int64_t halo_count(struct exchange *s, int64_t n)
{
    return comm_sum(s->with, n);
}

static double agree(struct exchange *s, double x)
{
    double since = comm_busy();
    struct comm *t = s->with;
    MPI_Bcast(&x, 1, MPI_DOUBLE, 0, t->mpi);
    comm_waited(t, since);
    return x;
}

static void halo_fail(struct exchange *s)
{
    comm_fail(s->with, EX_SOFTWARE, "no memory to solve the contacts");
}

void answers_alike(struct exchange *s, struct comm *t)
{
    s->with = t, s->most = most, s->count = halo_count, s->agree = agree, s->fail = halo_fail;
}
