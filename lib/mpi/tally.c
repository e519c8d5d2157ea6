/* mpi/tally.c: sums along the order of all slots [mpi/tally.h]. */
#include "mpi/tally.h"

#include <stdlib.h>
#include <string.h>

enum {
    OWNED = 1024 /* bundles that one rank adds up: a multiple of every chunk */
};

/* A slot here: the rank that adds it up, its place in the order of all, its place here */
struct contact_list_item {
    int64_t rank, place, slot;
};

static int contact_list_by_place(const void *a, const void *b)
{
    const struct contact_list_item *x = a, *y = b;
    if (x->rank != y->rank) return x->rank < y->rank ? -1 : 1;
    return x->place < y->place ? -1 : x->place > y->place;
}

/* owner[chunks]: the rank that has most of a chunk */
static int *chunk_owners(struct comm *t, const struct contact_list_item *item, int64_t n, int64_t chunks)
{
    struct {
        int n, rank;
    } *count = comm_new(t, chunks, sizeof *count), *most = comm_new(t, chunks, sizeof *most);
    int *owner = comm_new(t, chunks, sizeof *owner);
    for (int64_t k = 0; k < chunks; k++) count[k].rank = t->me;
    for (int64_t i = 0; i < n; i++) count[item[i].place / BUNDLE / OWNED].n++;
    MPI_Allreduce(count, most, (int)chunks, MPI_2INT, MPI_MAXLOC, t->mpi);
    for (int64_t k = 0; k < chunks; k++) owner[k] = most[k].rank;
    free(count), free(most);
    return owner;
}

void tally_begin(struct tally_order *o, struct comm *t, const struct problem *p,
                 const int64_t *slot, int64_t bundles)
{
    struct contact_list_item *item = comm_new(t, p->slots, sizeof *item);
    *o = (struct tally_order){ 0 };
    for (int64_t i = 0; i < p->slots; i++)
        if (p->contact[i] >= 0 && slot[p->contact[i]] >= 0)
            item[o->n++] = (struct contact_list_item){ 0, slot[p->contact[i]], i };
    int *owner = chunk_owners(t, item, o->n, bundles / OWNED + 1);
    for (int64_t i = 0; i < o->n; i++) item[i].rank = owner[item[i].place / BUNDLE / OWNED];
    free(owner);
    qsort(item, (size_t)o->n, sizeof *item, contact_list_by_place);
    struct parcel *out = parcels_new(t), *in = parcels_new(t);
    o->mine = comm_new(t, o->n, sizeof *o->mine);
    o->out = comm_new(t, t->n, sizeof *o->out), o->in = comm_new(t, t->n, sizeof *o->in);
    for (int64_t i = 0; i < o->n; i++) {
        o->mine[i] = item[i].slot, o->out[item[i].rank]++;
        parcel_put(t, &out[item[i].rank], &item[i].place, sizeof item->place);
    }
    comm_exchange(t, out, in);
    for (int q = 0; q < t->n; q++) {
        o->in[q] = (int)(in[q].size / sizeof(int64_t));
        o->got += o->in[q];
    }
    free(item), item = comm_new(t, o->got, sizeof *item);
    int64_t k = 0;
    for (int q = 0; q < t->n; q++)
        for (int i = 0; i < o->in[q]; i++, k++) {
            item[k].slot = k;
            parcel_take(t, &in[q], &item[k].place, sizeof item->place);
        }
    qsort(item, (size_t)o->got, sizeof *item, contact_list_by_place);
    o->at = comm_new(t, o->got, sizeof *o->at), o->where = comm_new(t, o->got, sizeof *o->where);
    for (int64_t i = 0; i < o->got; i++) o->at[i] = item[i].slot, o->where[i] = item[i].place;
    free(item);
    parcels_free(t, out), parcels_free(t, in);
}

void tally_free(struct tally_order *o)
{
    free(o->mine), free(o->out), free(o->in), free(o->at), free(o->where);
    *o = (struct tally_order){ 0 };
}

/* What has come, [got][terms], from term[slots][terms] of all ranks */
static double *bring(const struct tally_order *o, struct comm *t, int terms, const double *term)
{
    double *go = comm_new(t, o->n * terms, sizeof *go),
           *come = comm_new(t, o->got * terms, sizeof *come);
    int *count = comm_new(t, 4 * t->n, sizeof *count);
    if (o->n > INT32_MAX / terms || o->got > INT32_MAX / terms)
        comm_fail(t, EX_SOFTWARE,
                  "a sum over more numbers than MPI counts: more ranks, or --order block");
    for (int64_t i = 0; i < o->n; i++)
        memcpy(go + i * terms, term + o->mine[i] * terms, (size_t)terms * sizeof *go);
    int *from = count + t->n, *in = from + t->n, *to = in + t->n;
    for (int q = 0, a = 0, b = 0; q < t->n; q++) {
        count[q] = o->out[q] * terms, from[q] = a, a += count[q];
        in[q] = o->in[q] * terms, to[q] = b, b += in[q];
        if (q == t->me || !count[q]) continue;
        t->bytes += (int64_t)count[q] * (int64_t)sizeof *go, t->messages++;
    }
    double since = comm_busy();
    MPI_Alltoallv(go, count, from, MPI_DOUBLE, come, in, to, MPI_DOUBLE, t->mpi);
    comm_waited(t, since);
    free(go), free(count);
    return come;
}

/* Adds the chunks up, one after the other. */
static void add_chunks(struct comm *t, struct parcel *mine, int64_t chunks, size_t size,
                       double *out)
{
    struct parcel *in = parcels_new(t);
    comm_gather(t, mine, in);
    memset(out, 0, size * sizeof *out);
    double *all = t->me ? NULL : comm_new(t, chunks * (int64_t)size, sizeof *all);
    for (int q = 0; q < t->n && !t->me; q++)
        while (in[q].at < in[q].size) {
            int64_t k;
            parcel_take(t, &in[q], &k, sizeof k);
            parcel_take(t, &in[q], all + k * (int64_t)size, size * sizeof *all);
        }
    for (int64_t k = 0; k < chunks && !t->me; k++)
        for (size_t j = 0; j < size; j++) out[j] += all[k * (int64_t)size + (int64_t)j];
    free(all);
    parcels_free(t, in);
    double since = comm_busy();
    MPI_Bcast(out, (int)size, MPI_DOUBLE, 0, t->mpi);
    comm_waited(t, since);
}

void tally_sum(const struct tally_order *o, struct comm *t, int64_t bundles,
               const struct summands *of, double *out)
{
    const int64_t chunk = of->chunk;
    const int parts = of->parts, terms = of->terms;
    const size_t size = (size_t)terms * BUNDLE;
    double *come = bring(o, t, parts * terms, of->term),
           *sum = comm_new(t, (int64_t)size, sizeof *sum);
    struct parcel mine = { 0 };
    for (int64_t i = 0; i < o->got; i++) {
        int64_t k = o->where[i] / BUNDLE / chunk, lane = o->where[i] % BUNDLE;
        for (int j = 0; j < parts * terms; j++)
            sum[j % terms * BUNDLE + lane] += come[o->at[i] * parts * terms + j];
        if (i + 1 < o->got && o->where[i + 1] / BUNDLE / chunk == k) continue;
        parcel_put(t, &mine, &k, sizeof k), parcel_put(t, &mine, sum, size * sizeof *sum);
        memset(sum, 0, size * sizeof *sum);
    }
    free(come), free(sum);
    add_chunks(t, &mine, (bundles + chunk - 1) / chunk, size, out);
}

double tally_along(const struct tally_order *o, struct comm *t, int64_t bundles, const double *term)
{
    double *come = bring(o, t, 1, term), sum = 0;
    struct parcel mine = { 0 }, *in = parcels_new(t);
    for (int64_t i = 0; i < o->got; i++) {
        parcel_put(t, &mine, &o->where[i], sizeof *o->where);
        parcel_put(t, &mine, &come[o->at[i]], sizeof *come);
    }
    free(come);
    comm_gather(t, &mine, in);
    double *all = t->me ? NULL : comm_new(t, bundles * BUNDLE, sizeof *all);
    for (int q = 0; q < t->n && !t->me; q++)
        while (in[q].at < in[q].size) {
            int64_t slot;
            parcel_take(t, &in[q], &slot, sizeof slot);
            parcel_take(t, &in[q], &all[slot], sizeof *all);
        }
    for (int64_t i = 0; i < bundles * BUNDLE && !t->me; i++) sum += all[i];
    free(all);
    parcels_free(t, in);
    double since = comm_busy();
    MPI_Bcast(&sum, 1, MPI_DOUBLE, 0, t->mpi);
    comm_waited(t, since);
    return sum;
}
