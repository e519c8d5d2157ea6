/* mpi/rows.c: blocks of rows, to parts and from them [mpi/rows.h]. */
#include "mpi/rows.h"

#include <stdlib.h>
#include <string.h>

/* What is said of a block in front of it */
struct rows_block {
    int64_t first, n, all;
    int32_t dim;
    uint32_t optional; /* packing_optional() */
};

static void rows_fail(const struct comm *t, const struct failure *failure)
{
    comm_fail(t, failure->status, failure->text);
}

static void rows_make_room(struct rows *r, const struct rows_block *b)
{
    struct comm *t = r->comm;
    struct failure failure = { 0 };
    rows_free(r);
    *r = (struct rows){ .comm = t, .all = b->all, .first = rows_begin(b->all, t->n, t->me) };
    int64_t n = rows_begin(b->all, t->n, t->me + 1) - r->first;
    if (packing_init(&r->p, b->dim, n, &failure) || packing_alloc_optional(&r->p, b->optional, &failure))
        rows_fail(t, &failure);
}

/* Rows first .. end - 1 that a block and rank k both have; false: none */
static bool common(const struct rows_block *b, const struct comm *t, int k, int64_t *first, int64_t *end)
{
    *first = rows_begin(b->all, t->n, k), *end = rows_begin(b->all, t->n, k + 1);
    if (*first < b->first) *first = b->first;
    if (*end > b->first + b->n) *end = b->first + b->n;
    return *first < *end;
}

void rows_take(struct rows *r, struct comm *t, const struct packing *block, int64_t first,
               int64_t all)
{
    struct rows_block b = { 0 };
    struct parcel *out = parcels_new(t), mine = { 0 };
    int64_t from, end;
    const struct column *c;
    if (!t->me) b = (struct rows_block){ first, block->n, all, block->dim, packing_optional(block) };
    MPI_Bcast(&b, sizeof b, MPI_BYTE, 0, t->mpi);
    r->comm = t;
    if (!b.first) rows_make_room(r, &b);
    for (int q = 0; q < t->n && !t->me; q++)
        for (int k = 0; common(&b, t, q, &from, &end) && k < BODY_COLUMNS; k++)
            if (column_array(c = &body_columns[k].column, block))
                parcel_put(t, &out[q], column_row(c, block, from - first),
                           (size_t)(end - from) * column_bytes(c));
    comm_scatter(t, out, &mine);
    for (int k = 0; common(&b, t, t->me, &from, &end) && k < BODY_COLUMNS; k++)
        if (column_array(c = &body_columns[k].column, &r->p))
            parcel_take(t, &mine, column_row(c, &r->p, from - r->first),
                        (size_t)(end - from) * column_bytes(c));
    for (int64_t i = 0; i < b.n && !t->me; i++)
        r->mass += block->mass[i], r->heavy += block->mass[i] > 0;
    parcel_free(&mine), parcels_free(t, out);
}

void rows_deal(struct rows *r, struct subdomain *y, struct decomposition *space,
               const struct packing *settings)
{
    subdomain_begin_rows(y, r->comm, space, settings,
                         &(struct own_rows){ &r->p, r->first, r->all });
    packing_free(&r->p);
}

void rows_free(struct rows *r)
{
    packing_free(&r->p);
}

/* ---- back ---- */

/* The rank that has a row */
static int holder_of(const struct rows *r, int32_t row)
{
    int k = (int)((int64_t)row * r->comm->n / r->all);
    while (rows_begin(r->all, r->comm->n, k) > row) k--;
    while (rows_begin(r->all, r->comm->n, k + 1) <= row) k++;
    return k;
}

/* The column's numbers of all own bodies, for those who have their rows; c NULL: their rows */
static void send_off(const struct haul *h, const struct column *c, struct parcel *out)
{
    const struct subdomain *y = h->part;
    size_t bytes = c ? column_bytes(c) : 0;
    const char *from = c ? column_array(c, &y->p) : NULL;
    for (int64_t i = 0; i < y->p.n; i++) {
        if (y->owner[i] != y->comm->me) continue;
        struct parcel *to = &out[holder_of(h->rows, y->row[i])];
        if (c)
            parcel_put(y->comm, to, from + (size_t)i * bytes, bytes);
        else
            parcel_put(y->comm, to, &y->row[i], sizeof *y->row);
    }
}

void haul_begin(struct haul *h, const struct rows *r, const struct subdomain *y)
{
    struct comm *t = r->comm;
    int64_t n = 0;
    *h = (struct haul){ .rows = r, .part = y };
    h->n = rows_begin(r->all, t->n, t->me + 1) - r->first;
    if (!y) return;
    struct parcel *out = parcels_new(t), *in = parcels_new(t);
    send_off(h, NULL, out);
    comm_exchange(t, out, in);
    h->at = comm_new(t, t->n, sizeof *h->at);
    for (int q = 0; q < t->n; q++) {
        int64_t many = (int64_t)(in[q].size / sizeof(int32_t));
        h->at[q] = comm_new(t, many, sizeof **h->at);
        for (int64_t i = 0; i < many; i++, n++) {
            int32_t row;
            parcel_take(t, &in[q], &row, sizeof row);
            h->at[q][i] = row - r->first;
            if (row < r->first || row - r->first >= h->n)
                comm_fail(t, EX_SOFTWARE, "ranks disagree about rows of bodies");
        }
    }
    if (n != h->n) comm_fail(t, EX_SOFTWARE, "ranks disagree about rows of bodies");
    parcels_free(t, out), parcels_free(t, in);
}

void haul_column(struct haul *h, const struct column *c, void *to)
{
    struct comm *t = h->rows->comm;
    size_t bytes = column_bytes(c);
    if (!h->part) {
        memcpy(to, column_array(c, &h->rows->p), (size_t)h->n * bytes);
        return;
    }
    struct parcel *out = parcels_new(t), *in = parcels_new(t);
    send_off(h, c, out);
    comm_exchange(t, out, in);
    for (int q = 0; q < t->n; q++)
        for (int64_t i = 0; in[q].at < in[q].size; i++)
            parcel_take(t, &in[q], (char *)to + (size_t)h->at[q][i] * bytes, bytes);
    parcels_free(t, out), parcels_free(t, in);
}

void haul_end(struct haul *h)
{
    for (int q = 0; h->at && q < h->rows->comm->n; q++) free(h->at[q]);
    free(h->at);
    *h = (struct haul){ 0 };
}
