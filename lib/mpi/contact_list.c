/* mpi/contact_list.c: contacts gathered, and verdicts told [mpi/contact_list.h]. */
#include "mpi/contact_list.h"

#include <stdlib.h>

static bool comes_first(const struct contact *a, const struct contact *b)
{
    return a->a < b->a || (a->a == b->a && a->b < b->b);
}

/* Merges what the ranks have sent: contacts of one pair are all of one rank. */
static void contact_list_merge(struct contact_list *l, struct comm *t, struct parcel *in, struct contacts *all)
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
