#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): qsort_r
#include "file/served.h"

#include "base/array.h"
#include "file/element.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- what reading a document may cost ---- */

/* Bytes that the datasets of a document of this size may hold; allowed: by the user, 0: not more than usual */
static uint64_t budget_unpacked(uint64_t size, uint64_t allowed)
{
    uint64_t usual = size > BUDGET_LEAST / BUDGET_RATIO ? size * BUDGET_RATIO : BUDGET_LEAST;
    return allowed > usual ? allowed : usual;
}

void budget_open(struct budget *b, uint64_t size, uint64_t allowed)
{
    *b = (struct budget){ .size = size, .most_frame = budget_unpacked(size, allowed) };
    b->most_document =
        BUDGET_ALL * (allowed > BUDGET_LEAST ? allowed : BUDGET_LEAST) + BUDGET_ALL_RATIO * size;
}

int budget_frame(struct budget *b, struct failure *failure)
{
    b->frame = 0;
    return budget_draw(b, BUDGET_FRAME, failure);
}

int budget_draw(struct budget *b, uint64_t bytes, struct failure *failure)
{
    uint64_t left = b->most_frame - b->frame, left_of_all = b->most_document - b->all;
    if (bytes <= left && bytes <= left_of_all) return b->frame += bytes, b->all += bytes, 0;
    return failure_set(
        failure, EX_DATAERR,
        bytes > left ? "a frame of it takes more than %llu MB of memory or work, and it "
                       "has %llu kB (--unpack allows more)"
                     : "its frames take more than %llu MB of work, and it has %llu kB "
                       "(--unpack allows more)",
        (unsigned long long)((bytes > left ? b->most_frame : b->most_document) / 1000000),
        (unsigned long long)(b->size / 1000 + 1));
}

enum {
    MOST_OBJECTS = 100000,   /* in a document; a group within itself would have endless ones */
    MOST_DEPTH = 32,         /* groups within groups */
    OPEN_SETS = 256,         /* datasets that stay open once they were looked at */
    FREE_FILL = 1 << 20,     /* bytes of a dataset that need not be stored: h5py leaves zeros out */
    UNPACKED_CACHE = 1 << 25 /* bytes of unpacked chunks that are kept: a row of them of a table */
};

void served_start(void)
{
    h5_start();
    H5PLset_loading_state(0);
    H5Lunregister(H5L_TYPE_EXTERNAL);
}

struct walk {
    struct served *served;
    const char *path; /* of the group in hand; "" is the root */
    int depth;
    struct failure *failure;
};

/* Refuses what would make libhdf5 open other files or load code. Is the data packed? */
static int check_storage(hid_t plist, struct served_entry *e, struct failure *failure)
{
    if (H5Pget_layout(plist) == H5D_VIRTUAL)
        return failure_set(failure, EX_DATAERR, "%s: a virtual dataset, of data in other files",
                           e->path);
    if (H5Pget_external_count(plist) != 0)
        return failure_set(failure, EX_DATAERR, "%s: its data are in another file", e->path);
    int filters = H5Pget_nfilters(plist);
    for (int k = 0; k < filters; k++) {
        unsigned flags, config;
        size_t values = 0;
        H5Z_filter_t f =
            H5Pget_filter2(plist, (unsigned)k, &flags, &values, NULL, 0, NULL, &config);
        if (f != H5Z_FILTER_DEFLATE && f != H5Z_FILTER_SHUFFLE && f != H5Z_FILTER_FLETCHER32 &&
            f != H5Z_FILTER_SZIP)
            return failure_set(failure, EX_DATAERR,
                               "%s: packed by a filter (%d) that is not built in", e->path, (int)f);
        e->packed |= f == H5Z_FILTER_DEFLATE || f == H5Z_FILTER_SZIP;
    }
    return filters < 0 ? failure_set(failure, EX_DATAERR, "%s: damaged filters", e->path) : 0;
}

/* A packed chunk has to stay in the cache while its pieces are handed out; other data bypass it. */
static hid_t open_again(hid_t set, hid_t plist, struct served_entry *e)
{
    hsize_t chunk[H5S_MAX_RANK], bytes = e->object.size ? e->object.size : 16;
    int rank = H5Pget_layout(plist) == H5D_CHUNKED ? H5Pget_chunk(plist, H5S_MAX_RANK, chunk) : 0;
    for (int k = 0; k < rank; k++) bytes *= chunk[k];
    if (!e->packed) return set;
    e->chunk = bytes;
    bytes = 2 * bytes > UNPACKED_CACHE ? 2 * bytes : UNPACKED_CACHE;
    hid_t file = H5Iget_file_id(set), access = H5Pcreate(H5P_DATASET_ACCESS);
    H5Pset_chunk_cache(access, 521, bytes, 1);
    H5Dclose(set);
    set = H5Dopen2(file, e->path, access);
    H5Pclose(access), H5Fclose(file);
    return set;
}

/* Under each of its names a dataset is read anew. */
static int count_bytes(struct served *s, const struct served_entry *e, struct failure *failure)
{
    if (__builtin_add_overflow(s->unpacked, e->bytes, &s->unpacked)) s->unpacked = UINT64_MAX;
    if (s->unpacked <= s->limit) return 0;
    return failure_set(failure, EX_DATAERR,
                       "%s: with it the file declares %llu MB in %llu kB (--unpack allows more)",
                       e->path, (unsigned long long)(s->unpacked / 1000000),
                       (unsigned long long)(s->size / 1000 + 1));
}

static int look_at_shape(struct served *s, hid_t set, struct served_entry *e,
                         struct failure *failure)
{
    hid_t disk = H5Dget_type(set), space = H5Dget_space(set);
    hsize_t shape[H5S_MAX_RANK] = { 0 };
    int rank = space < 0 ? -1 : H5Sget_simple_extent_dims(space, shape, NULL);
    H5S_class_t class = space < 0 ? H5S_NO_CLASS : H5Sget_simple_extent_type(space);
    size_t element = disk < 0 ? 0 : H5Tget_size(disk);
    if (disk >= 0) element_describe(disk, &e->object), H5Tclose(disk);
    if (space >= 0) H5Sclose(space);
    if (rank < 0 || class == H5S_NO_CLASS || !element)
        return failure_set(failure, EX_DATAERR, "%s: its shape cannot be read (damaged?)", e->path);
    e->object.rank = rank > OBJECT_RANK ? OBJECT_RANK + 1 : (uint32_t)rank;
    if (class == H5S_NULL || rank > OBJECT_RANK) e->object.kind = OBJECT_OTHER;
    if (rank <= OBJECT_RANK) memcpy(e->shape, shape, (size_t)rank * sizeof *shape);
    e->bytes = element;
    for (int k = 0; k < rank; k++)
        if (__builtin_mul_overflow(e->bytes, shape[k], &e->bytes)) e->bytes = UINT64_MAX;
    e->stored = H5Dget_storage_size(set);
    if (e->stored > s->size) e->stored = s->size;
    return count_bytes(s, e, failure);
}

static int look_at_dataset(struct served *s, hid_t set, struct served_entry *e,
                           struct failure *failure)
{
    hid_t plist = H5Dget_create_plist(set);
    int status = plist < 0
                     ? failure_set(failure, EX_DATAERR, "%s: cannot be opened (damaged?)", e->path)
                     : check_storage(plist, e, failure);
    s->chunked |= plist >= 0 && H5Pget_layout(plist) == H5D_CHUNKED;
    if (!status) status = look_at_shape(s, set, e, failure);
    if (!status) set = open_again(set, plist, e);
    if (plist >= 0) H5Pclose(plist);
    if (set < 0)
        return failure_set(failure, EX_DATAERR, "%s: cannot be opened (damaged?)", e->path);
    e->set = set, e->owner = true;
    if (s->count >= OPEN_SETS) H5Dclose(set), e->set = -1, e->owner = false;
    return status;
}

static struct served_entry *add_entry(struct walk *w, const char *name)
{
    struct served *s = w->served;
    if (s->count == MOST_OBJECTS)
        return failure_set(w->failure, EX_DATAERR, "%s: more than %d objects (a group in itself?)",
                           w->path, MOST_OBJECTS),
               NULL;
    if (!array_grow(&s->entry, &s->room, s->count + 1, sizeof *s->entry))
        return failure_set(w->failure, EX_SOFTWARE, "no memory for a list of objects"), NULL;
    struct served_entry *e = &s->entry[s->count];
    size_t length = strlen(w->path) + strlen(name) + 2;
    *e = (struct served_entry){ .set = -1, .address = HADDR_UNDEF, .path = malloc(length) };
    if (!e->path)
        return failure_set(w->failure, EX_SOFTWARE, "no memory for a list of objects"), NULL;
    snprintf(e->path, length, "%s/%s", w->path, name);
    s->count++;
    if (length > OBJECT_PATH)
        return failure_set(w->failure, EX_DATAERR, "%.100s...: a name too long", e->path), NULL;
    return e;
}

static herr_t look_at_link(hid_t from, const char *name, const H5L_info_t *info, void *data);

static int look_into_group(struct walk *w, hid_t group, const char *path)
{
    if (w->depth == MOST_DEPTH)
        return failure_set(w->failure, EX_DATAERR, "%s: groups more than %d deep", path,
                           MOST_DEPTH);
    struct walk in = { w->served, path, w->depth + 1, w->failure };
    if (H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, NULL, look_at_link, &in) < 0)
        failure_set(w->failure, EX_DATAERR, "%s: cannot be listed (damaged?)", *path ? path : "/");
    return w->failure->status;
}

/* The same object under another name: nothing of it is looked at again. */
static bool known_already(struct served *s, struct served_entry *e)
{
    for (int64_t k = 0; k + 1 < s->count && k < OPEN_SETS; k++) {
        const struct served_entry *other = &s->entry[k];
        if (other->address != e->address || other->set < 0) continue;
        char *path = e->path;
        *e = *other;
        e->path = path, e->owner = false;
        return true;
    }
    return false;
}

/* /VTKHDF of a document of nsd's is for VTK alone, whatever is in it: it is not opened. */
static bool is_for_vtk(const struct walk *w, hid_t root, const char *name)
{
    return !*w->path && !strcmp(name, "VTKHDF") && H5Lexists(root, "nsd", H5P_DEFAULT) > 0;
}

static herr_t look_at_link(hid_t from, const char *name, const H5L_info_t *info, void *data)
{
    struct walk *w = data;
    if (is_for_vtk(w, from, name)) return 0;
    if (info->type != H5L_TYPE_HARD && info->type != H5L_TYPE_SOFT)
        return failure_set(w->failure, EX_DATAERR, "%s/%.200s: a link into another file", w->path,
                           name),
               -1;
    if (!*name || strchr(name, '/') || !strcmp(name, ".") || !strcmp(name, ".."))
        return failure_set(w->failure, EX_DATAERR, "%s/%.200s: not a name", w->path, name), -1;
    struct served_entry *e = add_entry(w, name);
    if (!e) return -1;
    if (info->type == H5L_TYPE_HARD) e->address = info->u.address;
    if (info->type == H5L_TYPE_HARD && known_already(w->served, e))
        return count_bytes(w->served, e, w->failure) ? -1 : 0;
    hid_t object = H5Oopen(from, name, H5P_DEFAULT);
    if (object < 0 && info->type == H5L_TYPE_SOFT) { // it leads nowhere
        free(e->path), w->served->count--;
        return 0;
    }
    H5I_type_t type = object < 0 ? H5I_BADID : H5Iget_type(object);
    if (type == H5I_DATASET) return look_at_dataset(w->served, object, e, w->failure) ? -1 : 0;
    if (type == H5I_GROUP) look_into_group(w, object, e->path); // e may have moved
    if (type != H5I_GROUP && type != H5I_DATATYPE)
        failure_set(w->failure, EX_DATAERR, "%s: cannot be opened (damaged?)", e->path);
    else if (type == H5I_DATATYPE)
        e->object.kind = OBJECT_OTHER;
    if (object >= 0) H5Oclose(object);
    return w->failure->status ? -1 : 0;
}

static int served_by_path(const void *one, const void *other, void *entries)
{
    const struct served_entry *e = entries;
    return strcmp(e[*(const int64_t *)one].path, e[*(const int64_t *)other].path);
}

static int sort_entries(struct served *s, struct failure *failure)
{
    if (!(s->sorted = malloc(((size_t)s->count + 1) * sizeof *s->sorted)))
        return failure_set(failure, EX_SOFTWARE, "no memory for a list of objects");
    for (int64_t k = 0; k < s->count; k++) s->sorted[k] = k;
    qsort_r(s->sorted, (size_t)s->count, sizeof *s->sorted, served_by_path, s->entry);
    return 0;
}

int served_open(struct served *s, hid_t file, uint64_t size, uint64_t limit,
                struct failure *failure)
{
    *s = (struct served){ .file = file, .size = size, .limit = budget_unpacked(size, limit) };
    struct walk root = { s, "", 0, failure };
    hid_t group = H5Gopen2(file, "/", H5P_DEFAULT);
    if (group < 0) return failure_set(failure, EX_DATAERR, "/: cannot be opened (damaged?)");
    look_into_group(&root, group, "");
    H5Gclose(group);
    return failure->status ? failure->status : sort_entries(s, failure);
}

void served_close(struct served *s)
{
    for (int64_t k = 0; k < s->count; k++) {
        if (s->entry[k].owner) H5Dclose(s->entry[k].set);
        free(s->entry[k].path);
    }
    free(s->entry), free(s->sorted);
    if (s->file >= 0) H5Fclose(s->file);
    *s = (struct served){ .file = -1 };
}

struct served_entry *served_find(const struct served *s, const char *path, struct failure *failure)
{
    for (int64_t lo = 0, hi = s->sorted ? s->count : 0; lo < hi;) {
        int64_t k = lo + (hi - lo) / 2;
        int order = strcmp(s->entry[s->sorted[k]].path, path);
        if (!order) return &s->entry[s->sorted[k]];
        *(order < 0 ? &lo : &hi) = order < 0 ? k + 1 : k;
    }
    return failure_set(failure, EX_DATAERR, "%s: no such dataset", path), NULL;
}

hid_t served_set(const struct served *s, const struct served_entry *e, struct failure *failure)
{
    if (e->set >= 0) return e->set;
    hid_t set = H5Dopen2(s->file, e->path, H5P_DEFAULT);
    if (set < 0) failure_set(failure, EX_DATAERR, "%s: no such dataset", e->path);
    return set;
}

/* Is as much stored as is wanted of the dataset's first bytes? What filters packed is not counted. */
int served_stored(const struct served_entry *e, uint64_t bytes, struct failure *failure)
{
    if (bytes <= FREE_FILL || bytes - FREE_FILL <= e->stored) return 0;
    if (e->packed && e->stored && bytes / 1100 <= e->stored) return 0; // gzip packs 1032 to 1
    return failure_set(failure, EX_DATAERR, "%s: %llu bytes are declared, and %llu are stored",
                       e->path, (unsigned long long)bytes, (unsigned long long)e->stored);
}
