/* mpi/rows.c: blocks of rows, to parts and from them, and into files [mpi/rows.h]. */
#include "mpi/rows.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

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
    if (packing_init(&r->p, b->dim, n, &failure) ||
        packing_alloc_optional(&r->p, b->optional, &failure))
        rows_fail(t, &failure);
}

/* Rows first .. end - 1 that a block and rank k both have; false: none */
static bool common(const struct rows_block *b, const struct comm *t, int k, int64_t *first,
                   int64_t *end)
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
    const struct field *c;
    if (!t->me)
        b = (struct rows_block){ first, block->n, all, block->dim, packing_optional(block) };
    MPI_Bcast(&b, sizeof b, MPI_BYTE, 0, t->mpi);
    r->comm = t;
    if (!b.first) rows_make_room(r, &b);
    for (int q = 0; q < t->n && !t->me; q++)
        for (int k = 0; common(&b, t, q, &from, &end) && k < BODY_COLUMNS; k++)
            if (field_array(c = &body_columns[k], block))
                parcel_put(t, &out[q], field_row(c, block, from - first),
                           (size_t)(end - from) * field_bytes(c));
    comm_scatter(t, out, &mine);
    for (int k = 0; common(&b, t, t->me, &from, &end) && k < BODY_COLUMNS; k++)
        if (field_array(c = &body_columns[k], &r->p))
            parcel_take(t, &mine, field_row(c, &r->p, from - r->first),
                        (size_t)(end - from) * field_bytes(c));
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

/* Columns of bodies on their way into rows */
struct haul {
    const struct rows *rows;
    const struct subdomain *part; /* NULL: they have not been dealt, and lie in the rows */
    int64_t n;                    /* rows of this rank */
    int64_t **at;                 /* [ranks][...] which of these comes from each, in order */
};

/* The column's numbers of all own bodies, for those who have their rows; c NULL: their rows */
static void send_off(const struct haul *h, const struct field *c, struct parcel *out)
{
    const struct subdomain *y = h->part;
    size_t bytes = c ? field_bytes(c) : 0;
    const char *from = c ? field_array(c, &y->p) : NULL;
    for (int64_t i = 0; i < y->p.n; i++) {
        if (y->owner[i] != y->comm->me) continue;
        struct parcel *to = &out[holder_of(h->rows, y->row[i])];
        if (c)
            parcel_put(y->comm, to, from + (size_t)i * bytes, bytes);
        else
            parcel_put(y->comm, to, &y->row[i], sizeof *y->row);
    }
}

static void haul_begin(struct haul *h, const struct rows *r, const struct subdomain *y)
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

/* to[n][width] = the column's numbers in the rows of this rank. */
static void haul_column(struct haul *h, const struct field *c, void *to)
{
    struct comm *t = h->rows->comm;
    size_t bytes = field_bytes(c);
    if (!h->part) {
        memcpy(to, field_array(c, &h->rows->p), (size_t)h->n * bytes);
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

static void haul_end(struct haul *h)
{
    for (int q = 0; h->at && q < h->rows->comm->n; q++) free(h->at[q]);
    free(h->at);
    *h = (struct haul){ 0 };
}

/* ---- rows of bodies into files ---- */

/* What the first tells of a dataset: its column as its place in struct packing, for pointers are of one process */
struct target {
    char path[80];
    int64_t frame;
    int32_t type, width;
    uint64_t offset;
};

/* ---- one process ---- */

/* Where `n` rows from `first` on are to go; to be closed. */
static hid_t select_rows(hid_t set, const struct target *o, int64_t first, int64_t n)
{
    const hsize_t row = (hsize_t)first, rows = (hsize_t)n, width = (hsize_t)o->width;
    const hsize_t start[3] = { (hsize_t)o->frame, row, 0 }, count[3] = { 1, rows, width };
    const int from = o->frame < 0; // the dataset has no frames
    hid_t space = H5Dget_space(set);
    herr_t e =
        !n ? H5Sselect_none(space)
           : H5Sselect_hyperslab(space, H5S_SELECT_SET, start + from, NULL, count + from, NULL);
    if (e >= 0) return space;
    H5Sclose(space);
    return -1;
}

static bool rows_write_rows(hid_t file, const struct target *o, int64_t first, int64_t n,
                            hid_t transfer, const void *data)
{
    const hsize_t numbers = (hsize_t)(n * o->width);
    hid_t set = H5Dopen2(file, o->path, H5P_DEFAULT);
    hid_t space = set < 0 ? -1 : select_rows(set, o, first, n),
          memory = H5Screate_simple(1, &numbers, NULL);
    bool good =
        space >= 0 && memory >= 0 &&
        H5Dwrite(set, column_native((enum column_type)o->type), memory, space, transfer, data) >= 0;
    if (memory >= 0) H5Sclose(memory);
    if (space >= 0) H5Sclose(space);
    if (set >= 0) good &= H5Dclose(set) >= 0;
    return good;
}

/* The first writes what the others send it, one after the other. */
static bool write_by_first(const struct rows *r, hid_t file, const struct target *o, void *mine)
{
    struct comm *t = r->comm;
    size_t bytes = (size_t)o->width * field_size((enum column_type)o->type);
    bool good = true;
    for (int q = 0; q < t->n; q++) {
        int64_t first = rows_begin(r->all, t->n, q), n = rows_begin(r->all, t->n, q + 1) - first;
        struct parcel out = { 0 }, *in = parcels_new(t);
        if (q && q == t->me) parcel_put(t, &out, mine, (size_t)n * bytes);
        if (q) comm_gather(t, &out, in);
        if (!t->me)
            good = good && rows_write_rows(file, o, first, n, H5P_DEFAULT, q ? in[q].bytes : mine);
        parcels_free(t, in);
    }
    return good;
}

/* ---- all ranks ---- */

/* Is libhdf5 the one that knows MPI? */
static bool files_parallel(void)
{
#ifdef H5_HAVE_PARALLEL
    return true;
#else
    return false;
#endif
}

#ifdef H5_HAVE_PARALLEL
enum {
    LOCAL_BUFFER = 1 << 22 /* bytes that MPI-IO may collect in a process: it takes 32 MiB else */
};

/* Closes what MPI has not been told to keep: none of it changes what the first has of the file. */
static hid_t open_by_all(const struct comm *t, const char *path)
{
    char size[20];
    MPI_Info info;
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    snprintf(size, sizeof size, "%d", LOCAL_BUFFER);
    MPI_Info_create(&info);
    MPI_Info_set(info, "cb_buffer_size", size);
    H5Pset_fapl_mpio(access, t->mpi, info);
    H5Pset_all_coll_metadata_ops(access, true);
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, access);
    H5Pclose(access);
    MPI_Info_free(&info);
    return file;
}

static hid_t collective(void)
{
    hid_t transfer = H5Pcreate(H5P_DATASET_XFER);
    H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE);
    return transfer;
}
#else
static hid_t open_by_all(const struct comm *t, const char *path)
{
    (void)t, (void)path;
    return -1;
}

static hid_t collective(void)
{
    return H5P_DEFAULT;
}
#endif

/* Do all ranks see the same file there? */
static bool all_see(const struct comm *t, const char *path)
{
    struct stat st;
    int64_t here = *path && !stat(path, &st) ? (int64_t)st.st_ino : -1, first = here;
    MPI_Bcast(&first, 1, MPI_INT64_T, 0, t->mpi);
    int same = here >= 0 && here == first, all;
    MPI_Allreduce(&same, &all, 1, MPI_INT, MPI_MIN, t->mpi);
    return all;
}

/* No reader would accept a body that is not as it should be: the first of them ends the run. */
static void rows_check_bodies(const struct rows *r, const struct subdomain *y)
{
    int64_t bad = INT64_MAX, least;
    struct failure failure = { 0 };
    for (int64_t i = 0; y && i < y->p.n && bad == INT64_MAX; i++) {
        struct packing one = packing_with_bodies(&y->p, &y->p, i, 1);
        if (y->owner[i] != y->comm->me) continue;
        if (packing_check_bodies(&one, y->row[i], &failure)) bad = y->row[i];
    }
    MPI_Allreduce(&bad, &least, 1, MPI_INT64_T, MPI_MIN, r->comm->mpi);
    if (bad == least && bad < INT64_MAX) comm_fail(r->comm, failure.status, failure.text);
    if (least < INT64_MAX) MPI_Barrier(r->comm->mpi);
}

/* The datasets, how many they are, the file's path and whether it is the first that writes: as the first has it */
static struct target *spread_targets(struct comm *t, const struct files_wish *wish, int *places,
                                     char path[PATH_MAX], bool *gather)
{
    const struct unfilled *place = wish->place;
    struct parcel o = { 0 };
    if (!t->me && wish->path) snprintf(path, PATH_MAX, "%s", wish->path);
    *gather = wish->gather;
    for (int k = 0; k < wish->places && !t->me; k++) {
        const struct field *c = place[k].column;
        struct target x;
        memset(&x, 0, sizeof x);
        memcpy(x.path, place[k].path, sizeof x.path);
        x.frame = place[k].frame, x.type = (int32_t)c->type, x.width = c->width;
        x.offset = c->offset;
        parcel_put(t, &o, &x, sizeof x);
    }
    comm_spread(t, &o);
    *places = (int)(o.size / sizeof(struct target));
    struct target *all = comm_new(t, *places, sizeof *all);
    for (int k = 0; k < *places; k++) parcel_take(t, &o, &all[k], sizeof *all);
    parcel_free(&o);
    MPI_Bcast(path, PATH_MAX, MPI_CHAR, 0, t->mpi);
    MPI_Bcast(gather, 1, MPI_C_BOOL, 0, t->mpi);
    return all;
}

int files_fill(const struct rows *r, const struct subdomain *y, const struct files_wish *wish,
               struct failure *failure)
{
    struct comm *t = r->comm;
    struct haul h;
    char where[PATH_MAX] = "";
    int places;
    bool gather;
    rows_check_bodies(r, y);
    struct target *o = spread_targets(t, wish, &places, where, &gather);
    bool by_all = !gather && files_parallel() && all_see(t, where);
    hid_t ours = by_all ? open_by_all(t, where) : -1, transfer = by_all ? collective() : -1;
    bool good = comm_most(t, by_all && ours < 0) == 0;
    haul_begin(&h, r, y);
    for (int k = 0; k < places; k++) {
        const struct field c = { .type = (enum column_type)o[k].type,
                                 .width = o[k].width,
                                 .offset = o[k].offset };
        char *data = comm_new(t, h.n, field_bytes(&c));
        haul_column(&h, &c, data);
        if (!by_all)
            good &= write_by_first(r, wish->file, &o[k], data);
        else if (good)
            good = rows_write_rows(ours, &o[k], r->first, h.n, transfer, data);
        free(data);
    }
    haul_end(&h);
    free(o);
    if (transfer > 0) H5Pclose(transfer);
    if (ours >= 0) good &= H5Fclose(ours) >= 0;
    int mine = good, all;
    MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MIN, t->mpi);
    return all ? 0 : failure_set(failure, EX_IOERR, "bodies cannot be written (disk full?)");
}
