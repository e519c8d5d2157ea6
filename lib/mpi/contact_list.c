/* mpi/contact_list.c: contacts gathered, and verdicts told [mpi/contact_list.h]. */
#include "mpi/contact_list.h"

#include <stdlib.h>
#include <string.h>

static bool comes_first(const struct contact *a, const struct contact *b)
{
    return a->a < b->a || (a->a == b->a && a->b < b->b);
}

/* Merges what the ranks have sent: contacts of one pair are all of one rank. */
static void contact_list_merge(struct contact_list *l, struct comm *t, struct parcel *in,
                               struct contacts *all)
{
    const size_t size = sizeof(struct contact);
    struct contact **c = comm_new(t, t->n, sizeof(struct contact *));
    int64_t *n = comm_new(t, t->n, sizeof *n);
    l->n = 0;
    for (int q = 0; q < t->n; q++) {
        c[q] = (struct contact *)(void *)in[q].bytes;
        n[q] = (int64_t)(in[q].size / size), l->n += n[q];
    }
    l->whose = comm_new(t, l->n, sizeof *l->whose);
    free(all->c);
    all->c = comm_new(t, l->n, size), all->n = l->n, all->room = l->n + 1;
    for (int64_t i = 0; i < l->n; i++) {
        int least = -1;
        for (int q = 0; q < t->n; q++)
            if (n[q] && (least < 0 || comes_first(c[q], c[least]))) least = q;
        all->c[i] = *c[least]++, n[least]--, l->whose[i] = least;
    }
    free(c), free(n);
}

void contact_list_gather(struct contact_list *l, const struct subdomain *y,
                         const struct contacts *s, struct contacts *all)
{
    struct comm *t = y->comm;
    struct parcel mine = { 0 }, *in = parcels_new(t);
    for (int64_t i = 0; i < s->n; i++) {
        struct contact c = s->c[i];
        if (!subdomain_counts(y, &c)) continue;
        c.b = y->row[c.b];
        if (c.a >= 0) c.a = y->row[c.a];
        parcel_put(t, &mine, &c, sizeof c);
    }
    *l = (struct contact_list){ 0 };
    comm_gather(t, &mine, in);
    contacts_free_found(all), contacts_free_tie(all);
    if (!t->me) contact_list_merge(l, t, in, all);
    parcels_free(t, in);
    MPI_Bcast(&l->n, 1, MPI_INT64_T, 0, t->mpi);
}

void contact_list_free(struct contact_list *l)
{
    free(l->whose);
    *l = (struct contact_list){ 0 };
}

/* Does another rank have the contact too, which this one counts? Which: the owner of a */
static int other_rank(const struct subdomain *y, const struct contact *c)
{
    return c->a >= 0 && y->owner[c->a] != y->comm->me ? y->owner[c->a] : -1;
}

/*
 * Records of `size` bytes: of[l->n] at the first, to[s->n] here. From those who count a contact they go on to
 * those who have it too; both have their common contacts in the same order.
 */
static void tell(const struct contact_list *l, const struct subdomain *y, const struct contacts *s,
                 const void *of, void *to, size_t size)
{
    struct comm *t = y->comm;
    struct parcel *out = parcels_new(t), *in = parcels_new(t), mine = { 0 };
    for (int64_t i = 0; i < l->n && !t->me; i++)
        parcel_put(t, &out[l->whose[i]], (const char *)of + (size_t)i * size, size);
    comm_scatter(t, out, &mine);
    for (int64_t i = 0; i < s->n; i++) {
        char *x = (char *)to + (size_t)i * size;
        int q = other_rank(y, &s->c[i]);
        if (!subdomain_counts(y, &s->c[i])) continue;
        parcel_take(t, &mine, x, size);
        if (q >= 0) parcel_put(t, &out[q], x, size);
    }
    parcel_free(&mine);
    comm_exchange(t, out, in);
    for (int64_t i = 0; i < s->n; i++)
        if (!subdomain_counts(y, &s->c[i]))
            parcel_take(t, &in[y->owner[s->c[i].b]], (char *)to + (size_t)i * size, size);
    for (int q = 0; q < t->n; q++)
        if (in[q].at != in[q].size) comm_fail(t, EX_SOFTWARE, "ranks disagree about contacts");
    parcels_free(t, out), parcels_free(t, in);
}

void contact_list_tell(const struct contact_list *l, const struct subdomain *y,
                       const struct contacts *s, const struct verdict *all, struct verdict *mine)
{
    tell(l, y, s, all, mine, sizeof *mine);
    for (int64_t i = 0; i < s->n; i++)
        if (mine[i].row != y->row[s->c[i].b])
            comm_fail(y->comm, EX_SOFTWARE, "ranks disagree about a contact");
}

/* What laws make of a contact, and what it starts from */
struct law_record {
    EACH_PAIR_COLUMN(PAIR_NUMBER) // mu, en, et
    double r[3], u[3], moment[3];
    struct contact_law law;
};

void contact_list_tell_laws(const struct contact_list *l, const struct subdomain *y,
                            struct contacts *s, const struct contacts *all)
{
    struct comm *t = y->comm;
    int32_t has[3] = { all->found != NULL, all->moment != NULL, all->law != NULL };
    struct law_record *of = comm_new(t, t->me ? 0 : l->n, sizeof *of),
                      *to = comm_new(t, s->n, sizeof *to);
    MPI_Bcast(has, 3, MPI_INT32_T, 0, t->mpi);
    for (int64_t i = 0; i < l->n && !t->me; i++) {
#define PUT(member, ...) of[i].member = all->c[i].member;
        EACH_PAIR_COLUMN(PUT)
#undef PUT
        for (int k = 0; k < 3 && all->found; k++)
            of[i].r[k] = all->found[i].r[k], of[i].u[k] = all->found[i].u[k];
        for (int k = 0; k < 3 && all->moment; k++) of[i].moment[k] = all->moment[i][k];
        if (all->law) of[i].law = all->law[i];
    }
    tell(l, y, s, of, to, sizeof *to);
    if ((has[0] && contacts_alloc_found(s)) || (has[1] && contacts_alloc_moment(s)) ||
        (has[2] && contacts_alloc_laws(s)))
        comm_fail(t, EX_SOFTWARE, "no memory for the contacts");
    for (int64_t i = 0; i < s->n; i++) {
#define TAKE(member, ...) s->c[i].member = to[i].member;
        EACH_PAIR_COLUMN(TAKE)
#undef TAKE
        for (int k = 0; k < 3 && has[0]; k++)
            s->found[i].r[k] = to[i].r[k], s->found[i].u[k] = to[i].u[k];
        for (int k = 0; k < 3 && has[1]; k++) s->moment[i][k] = to[i].moment[k];
        if (has[2]) s->law[i] = to[i].law;
    }
    free(of), free(to);
}

void contact_list_found(const struct contact_list *l, const struct subdomain *y,
                        const struct contacts *s, struct contacts *all)
{
    struct comm *t = y->comm;
    struct parcel mine = { 0 }, *in = parcels_new(t);
    const double none[3] = { 0 };
    int rolls = s->moment != NULL, any;
    MPI_Allreduce(&rolls, &any, 1, MPI_INT, MPI_MAX, t->mpi);
    for (int64_t i = 0; i < s->n; i++) {
        if (!subdomain_counts(y, &s->c[i])) continue;
        parcel_put(t, &mine, &s->found[i], sizeof s->found[i]);
        if (any) parcel_put(t, &mine, s->moment ? s->moment[i] : none, sizeof none);
    }
    comm_gather(t, &mine, in);
    if (!t->me && (contacts_alloc_found(all) || (any && contacts_alloc_moment(all))))
        comm_fail(t, EX_SOFTWARE, "no memory for the reactions");
    for (int64_t i = 0; i < l->n && !t->me; i++) {
        parcel_take(t, &in[l->whose[i]], &all->found[i], sizeof *all->found);
        if (any) parcel_take(t, &in[l->whose[i]], all->moment[i], sizeof none);
    }
    parcels_free(t, in);
}

/* ---- sums along the order of all slots ---- */

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
static int *chunk_owners(struct comm *t, const struct contact_list_item *item, int64_t n,
                         int64_t chunks)
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
