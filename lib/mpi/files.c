/* mpi/files.c: rows of bodies into files [mpi/files.h]. */
#include "mpi/files.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

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

static bool rows_write_rows(hid_t file, const struct target *o, int64_t first, int64_t n, hid_t transfer,
                       const void *data)
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
    size_t bytes = (size_t)o->width * column_size((enum column_type)o->type);
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

bool files_parallel(void)
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
        const struct column *c = place[k].column;
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
        const struct column c = { NULL, NULL, (enum column_type)o[k].type, o[k].width,
                                  o[k].offset };
        char *data = comm_new(t, h.n, column_bytes(&c));
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
