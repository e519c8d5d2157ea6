#include "io/serve.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_OBJECTS = 100000,  /* in a document; a group within itself would have endless ones */
    MOST_DEPTH = 32,        /* groups within groups */
    OPEN_SETS = 256,        /* datasets that stay open once they were looked at */
    LEAST_LIMIT = 1 << 26,  /* bytes: 64 MiB that any document may unpack to */
    LIMIT_RATIO = 64,       /* or so many times its own size: packed tables rarely reach 20 */
    FREE_FILL = 1 << 20,    /* bytes of a dataset that need not be stored: h5py leaves zeros out */
    SMALL_DATA = 1 << 16,   /* bytes of a dataset that are sent with the list of objects; */
    SMALL_LINKED = 1 << 12, /* of one under a second name, for step and time have forty; */
    MOST_SENT = 1 << 20,    /* and in all */
    UNPACKED_CACHE = 1 << 25, /* bytes of unpacked chunks that are kept: a row of them of a table */
    MOST_TEXT = 1 << 28,      /* bytes of a string */
    MOST_ATTRIBUTE = 1 << 20  /* bytes of an attribute */
};

/* What a walk has found under one name. */
struct entry {
    char *path;      /* absolute */
    haddr_t address; /* of the object in the file: several names may have one */
    hid_t set;       /* an open dataset, or -1 */
    bool owner;      /* it is closed here, not under another name */
    struct object object;
    hsize_t shape[SERVE_RANK];
    uint64_t stored; /* bytes that the file has of it, packed or not */
    bool packed;     /* by a filter */
};

void serve_start(void)
{
    h5_start();
    H5PLset_loading_state(0);
    H5Lunregister(H5L_TYPE_EXTERNAL);
}

/* ---- types ---- */

/* The kind of an object of this type on disk; its class and size. */
static void describe(hid_t disk, struct object *o)
{
    H5T_class_t class = H5Tget_class(disk);
    size_t size = H5Tget_size(disk);
    bool power = size == 1 || size == 2 || size == 4 || size == 8;
    o->kind = OBJECT_OTHER, o->class = 0, o->size = (uint32_t)size;
    if ((class == H5T_INTEGER || class == H5T_ENUM) && power) {
        hid_t base = class == H5T_ENUM ? H5Tget_super(disk) : -1;
        o->class = H5Tget_sign(base < 0 ? disk : base) == H5T_SGN_NONE ? 'u' : 'i';
        o->kind = OBJECT_NUMBERS;
        if (base >= 0) H5Tclose(base);
    } else if (class == H5T_FLOAT && size >= 2 && size <= 16) {
        o->kind = OBJECT_NUMBERS, o->class = 'f';
        o->size = size == 4 ? 4 : 8;
    } else if (class == H5T_STRING) {
        bool variable = H5Tis_variable_str(disk) > 0;
        o->kind = size && (variable || size <= MOST_TEXT) ? OBJECT_TEXT : OBJECT_OTHER;
        o->class = 's';
        if (variable) o->size = 0;
    }
}

/* Do numbers of this kind keep their values in the type wanted? Integers may become reals. */
static bool suits(const struct object *o, enum column_type want)
{
    if (o->kind != OBJECT_NUMBERS) return false;
    return want == COLUMN_F64 || o->class != 'f';
}

static const char *wanted(enum column_type type)
{
    return type == COLUMN_F64 ? "numbers" : "integers";
}

/* An integer that does not fit the type wanted fails the read instead of becoming another. */
static H5T_conv_ret_t overflow(H5T_conv_except_t what, hid_t from, hid_t to, void *in, void *out,
                               void *data)
{
    (void)from, (void)to, (void)in, (void)out, (void)data;
    return what == H5T_CONV_EXCEPT_RANGE_HI || what == H5T_CONV_EXCEPT_RANGE_LOW
               ? H5T_CONV_ABORT
               : H5T_CONV_UNHANDLED;
}

static hid_t strict_transfer(void)
{
    static hid_t plist = -1;
    if (plist < 0) {
        plist = H5Pcreate(H5P_DATASET_XFER);
        H5Pset_type_conv_cb(plist, overflow, NULL);
    }
    return plist;
}

/* ---- the walk ---- */

struct walk {
    struct served *served;
    const char *path; /* of the group in hand; "" is the root */
    int depth;
    struct why *why;
};

/* Refuses what would make libhdf5 open other files or load code. Is the data packed? */
static int check_storage(hid_t plist, struct entry *e, struct why *why)
{
    if (H5Pget_layout(plist) == H5D_VIRTUAL)
        return why_set(why, EX_DATAERR, "%s: a virtual dataset, of data in other files", e->path);
    if (H5Pget_external_count(plist) != 0)
        return why_set(why, EX_DATAERR, "%s: its data are in another file", e->path);
    int filters = H5Pget_nfilters(plist);
    for (int k = 0; k < filters; k++) {
        unsigned flags, config;
        size_t values = 0;
        H5Z_filter_t f =
            H5Pget_filter2(plist, (unsigned)k, &flags, &values, NULL, 0, NULL, &config);
        if (f != H5Z_FILTER_DEFLATE && f != H5Z_FILTER_SHUFFLE && f != H5Z_FILTER_FLETCHER32 &&
            f != H5Z_FILTER_SZIP)
            return why_set(why, EX_DATAERR, "%s: packed by a filter (%d) that is not built in",
                           e->path, (int)f);
        e->packed |= f == H5Z_FILTER_DEFLATE || f == H5Z_FILTER_SZIP;
    }
    return filters < 0 ? why_set(why, EX_DATAERR, "%s: damaged filters", e->path) : 0;
}

/* A packed chunk has to stay in the cache while its pieces are handed out; other data bypass it. */
static hid_t open_again(hid_t set, hid_t plist, const struct entry *e)
{
    hsize_t chunk[H5S_MAX_RANK], bytes = e->object.size ? e->object.size : 16;
    int rank = H5Pget_layout(plist) == H5D_CHUNKED ? H5Pget_chunk(plist, H5S_MAX_RANK, chunk) : 0;
    for (int k = 0; k < rank; k++) bytes *= chunk[k];
    if (!e->packed) return set;
    bytes = 2 * bytes > UNPACKED_CACHE ? 2 * bytes : UNPACKED_CACHE;
    hid_t file = H5Iget_file_id(set), access = H5Pcreate(H5P_DATASET_ACCESS);
    H5Pset_chunk_cache(access, 521, bytes, 1);
    H5Dclose(set);
    set = H5Dopen2(file, e->path, access);
    H5Pclose(access), H5Fclose(file);
    return set;
}

static int look_at_shape(struct served *s, hid_t set, struct entry *e, struct why *why)
{
    hid_t disk = H5Dget_type(set), space = H5Dget_space(set);
    hsize_t shape[H5S_MAX_RANK] = { 0 };
    int rank = space < 0 ? -1 : H5Sget_simple_extent_dims(space, shape, NULL);
    H5S_class_t class = space < 0 ? H5S_NO_CLASS : H5Sget_simple_extent_type(space);
    size_t element = disk < 0 ? 0 : H5Tget_size(disk);
    if (disk >= 0) describe(disk, &e->object), H5Tclose(disk);
    if (space >= 0) H5Sclose(space);
    if (rank < 0 || class == H5S_NO_CLASS || !element)
        return why_set(why, EX_DATAERR, "%s: its shape cannot be read (damaged?)", e->path);
    e->object.rank = rank > SERVE_RANK ? SERVE_RANK + 1 : (uint32_t)rank;
    if (class == H5S_NULL || rank > SERVE_RANK) e->object.kind = OBJECT_OTHER;
    if (rank <= SERVE_RANK) memcpy(e->shape, shape, (size_t)rank * sizeof *shape);
    uint64_t bytes = element;
    for (int k = 0; k < rank; k++)
        if (__builtin_mul_overflow(bytes, shape[k], &bytes)) bytes = UINT64_MAX;
    e->stored = H5Dget_storage_size(set);
    if (e->stored > s->size) e->stored = s->size;
    if (__builtin_add_overflow(s->unpacked, bytes, &s->unpacked)) s->unpacked = UINT64_MAX;
    if (s->unpacked > s->limit)
        return why_set(why, EX_DATAERR,
                       "%s: with it %llu MB are said to be in %llu kB (--unpack allows more)",
                       e->path, (unsigned long long)(s->unpacked / 1000000),
                       (unsigned long long)(s->size / 1000 + 1));
    return 0;
}

static int look_at_dataset(struct served *s, hid_t set, struct entry *e, struct why *why)
{
    hid_t plist = H5Dget_create_plist(set);
    int status = plist < 0 ? why_set(why, EX_DATAERR, "%s: cannot be opened (damaged?)", e->path)
                           : check_storage(plist, e, why);
    if (!status) status = look_at_shape(s, set, e, why);
    if (!status) set = open_again(set, plist, e);
    if (plist >= 0) H5Pclose(plist);
    if (set < 0) return why_set(why, EX_DATAERR, "%s: cannot be opened (damaged?)", e->path);
    e->set = set, e->owner = true;
    if (s->count >= OPEN_SETS) H5Dclose(set), e->set = -1, e->owner = false;
    return status;
}

static struct entry *add_entry(struct walk *w, const char *name)
{
    struct served *s = w->served;
    if (s->count == MOST_OBJECTS)
        return why_set(w->why, EX_DATAERR, "%s: more than %d objects (a group in itself?)", w->path,
                       MOST_OBJECTS),
               NULL;
    if (s->count == s->room) {
        int64_t room = s->room ? 2 * s->room : 128;
        struct entry *more = realloc(s->entry, (size_t)room * sizeof *more);
        if (!more) return why_set(w->why, EX_SOFTWARE, "no memory for a list of objects"), NULL;
        s->entry = more, s->room = room;
    }
    struct entry *e = &s->entry[s->count];
    size_t length = strlen(w->path) + strlen(name) + 2;
    *e = (struct entry){ .set = -1, .address = HADDR_UNDEF, .path = malloc(length) };
    if (!e->path) return why_set(w->why, EX_SOFTWARE, "no memory for a list of objects"), NULL;
    snprintf(e->path, length, "%s/%s", w->path, name);
    s->count++;
    if (length > SERVE_PATH)
        return why_set(w->why, EX_DATAERR, "%.100s...: a name too long", e->path), NULL;
    return e;
}

static herr_t look_at_link(hid_t from, const char *name, const H5L_info_t *info, void *data);

static int look_into_group(struct walk *w, hid_t group, const char *path)
{
    if (w->depth == MOST_DEPTH)
        return why_set(w->why, EX_DATAERR, "%s: groups more than %d deep", path, MOST_DEPTH);
    struct walk in = { w->served, path, w->depth + 1, w->why };
    if (H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, NULL, look_at_link, &in) < 0)
        why_set(w->why, EX_DATAERR, "%s: cannot be listed (damaged?)", *path ? path : "/");
    return w->why->status;
}

/* The same object under another name: nothing of it is looked at again. */
static bool known_already(struct served *s, struct entry *e)
{
    for (int64_t k = 0; k + 1 < s->count && k < OPEN_SETS; k++) {
        const struct entry *other = &s->entry[k];
        if (other->address != e->address || other->set < 0) continue;
        char *path = e->path;
        *e = *other;
        e->path = path, e->owner = false;
        return true;
    }
    return false;
}

static herr_t look_at_link(hid_t from, const char *name, const H5L_info_t *info, void *data)
{
    struct walk *w = data;
    if (info->type != H5L_TYPE_HARD && info->type != H5L_TYPE_SOFT)
        return why_set(w->why, EX_DATAERR, "%s/%.200s: a link into another file", w->path, name),
               -1;
    if (!*name || strchr(name, '/') || !strcmp(name, ".") || !strcmp(name, ".."))
        return why_set(w->why, EX_DATAERR, "%s/%.200s: not a name", w->path, name), -1;
    struct entry *e = add_entry(w, name);
    if (!e) return -1;
    if (info->type == H5L_TYPE_HARD) e->address = info->u.address;
    if (info->type == H5L_TYPE_HARD && known_already(w->served, e)) return 0;
    hid_t object = H5Oopen(from, name, H5P_DEFAULT);
    if (object < 0 && info->type == H5L_TYPE_SOFT) { // it leads nowhere
        free(e->path), w->served->count--;
        return 0;
    }
    H5I_type_t type = object < 0 ? H5I_BADID : H5Iget_type(object);
    if (type == H5I_DATASET) return look_at_dataset(w->served, object, e, w->why) ? -1 : 0;
    if (type == H5I_GROUP) look_into_group(w, object, e->path); // e may have moved
    if (type != H5I_GROUP && type != H5I_DATATYPE)
        why_set(w->why, EX_DATAERR, "%s: cannot be opened (damaged?)", e->path);
    else if (type == H5I_DATATYPE)
        e->object.kind = OBJECT_OTHER;
    if (object >= 0) H5Oclose(object);
    return w->why->status ? -1 : 0;
}

int serve_open(struct served *s, hid_t file, uint64_t size, uint64_t limit, struct why *why)
{
    uint64_t usual = size > LEAST_LIMIT / LIMIT_RATIO ? size * LIMIT_RATIO : LEAST_LIMIT;
    *s = (struct served){ .file = file, .size = size, .limit = limit > usual ? limit : usual };
    struct walk root = { s, "", 0, why };
    hid_t group = H5Gopen2(file, "/", H5P_DEFAULT);
    if (group < 0) return why_set(why, EX_DATAERR, "/: cannot be opened (damaged?)");
    look_into_group(&root, group, "");
    H5Gclose(group);
    return why->status;
}

void serve_close(struct served *s)
{
    for (int64_t k = 0; k < s->count; k++) {
        if (s->entry[k].owner) H5Dclose(s->entry[k].set);
        free(s->entry[k].path);
    }
    free(s->entry);
    if (s->file >= 0) H5Fclose(s->file);
    *s = (struct served){ .file = -1 };
}

static size_t padded(size_t size)
{
    return (size + 7) / 8 * 8;
}

static char *put_object(char *to, const struct object *o, const hsize_t *shape, const char *name)
{
    size_t rank = o->rank > SERVE_RANK ? 0 : o->rank;
    memcpy(to, o, sizeof *o), to += padded(sizeof *o);
    memcpy(to, shape, rank * sizeof *shape), to += rank * sizeof *shape;
    memcpy(to, name, o->name), to += padded(o->name);
    return to;
}

static size_t object_size(const struct object *o)
{
    return padded(sizeof *o) + (o->rank > SERVE_RANK ? 0 : o->rank) * sizeof(hsize_t) +
           padded(o->name);
}

/* ---- answers ---- */

int serve_bytes(struct sink *sink, struct reply *reply, const void *bytes, size_t size)
{
    reply->there = true, reply->size = size;
    if (sink->begin(sink, reply)) return -1;
    for (size_t done = 0; done < size;) {
        size_t most;
        void *to = sink->room(sink, &most);
        if (most > size - done) most = size - done;
        memcpy(to, (const char *)bytes + done, most);
        done += most;
        if (sink->put(sink, most)) return -1;
    }
    return 0;
}

static struct entry *find(const struct served *s, const char *path, struct why *why)
{
    for (int64_t k = 0; k < s->count; k++)
        if (!strcmp(s->entry[k].path, path)) return &s->entry[k];
    return why_set(why, EX_DATAERR, "%s: no such dataset", path), NULL;
}

static hid_t open_set(const struct served *s, const struct entry *e, struct why *why)
{
    if (e->set >= 0) return e->set;
    hid_t set = H5Dopen2(s->file, e->path, H5P_DEFAULT);
    if (set < 0) why_set(why, EX_DATAERR, "%s: no such dataset", e->path);
    return set;
}

/* A block of a dataset, in pieces that are whole in its last dimensions. */
static int put_block(hid_t set, hid_t type, int rank, const hsize_t *first, const hsize_t *count,
                     struct sink *sink)
{
    size_t most, element = H5Tget_size(type);
    hsize_t at[SERVE_RANK] = { 0 }, n[SERVE_RANK] = { 0 }, inner = 1, total = 1;
    for (int k = 0; k < rank; k++) n[k] = 1, total *= count[k];
    if (!total) return 0;
    void *to = sink->room(sink, &most);
    int k = rank - 1; // the dimension that is cut
    while (k > 0 && inner * count[k] <= most / element) n[k] = count[k], inner *= count[k--];
    hid_t space = H5Dget_space(set);
    herr_t e = 0;
    for (hsize_t done = 0; done < total && e >= 0;) {
        hsize_t from[SERVE_RANK], points = inner;
        if (done) to = sink->room(sink, &most);
        for (int i = 0; i < rank; i++) from[i] = first[i] + at[i];
        if (rank) {
            hsize_t fit = most / element / inner;
            n[k] = count[k] - at[k] < fit ? count[k] - at[k] : fit;
            points = inner * n[k];
            e = H5Sselect_hyperslab(space, H5S_SELECT_SET, from, NULL, n, NULL);
        }
        hid_t memory =
            rank ? H5Screate_simple(rank, n, NULL) : H5Screate(H5S_SCALAR); // same shape: quick
        if (e >= 0) e = H5Dread(set, type, memory, space, strict_transfer(), to);
        H5Sclose(memory);
        if (e >= 0 && sink->put(sink, (size_t)points * element)) e = -1;
        done += points;
        for (int i = k; i >= 0 && rank; i--) { // on to the next place, like a mileage counter
            at[i] += i == k ? n[k] : 1;
            if (at[i] < count[i]) break;
            at[i] = 0;
        }
    }
    H5Sclose(space);
    return e < 0 ? -1 : 0;
}

/* Is as much stored as is wanted of the dataset? What filters packed is not counted. */
static int check_stored(const struct entry *e, uint64_t bytes, struct why *why)
{
    if (bytes <= FREE_FILL || bytes - FREE_FILL <= e->stored) return 0;
    if (e->packed && e->stored && bytes / 1100 <= e->stored) return 0; // gzip packs 1032 to 1
    return why_set(why, EX_DATAERR, "%s: %llu bytes are said to be there, and %llu are stored",
                   e->path, (unsigned long long)bytes, (unsigned long long)e->stored);
}

static int answer_rows(struct served *s, const struct request *q, struct sink *sink,
                       struct why *why)
{
    const struct entry *e = find(s, q->path, why);
    if (!e) return why->status;
    const struct object *o = &e->object;
    if (!suits(o, q->type))
        return why_set(why, EX_DATAERR, "%s: %s are wanted, and it holds something else", q->path,
                       wanted(q->type));
    hsize_t first[SERVE_RANK] = { 0 }, count[SERVE_RANK], row = 1, rows = o->rank ? e->shape[0] : 1;
    for (uint32_t k = 0; k < o->rank; k++) {
        count[k] = e->shape[k];
        if (k) row *= count[k];
    }
    bool all = q->n < 0;
    if (!all && (!o->rank || q->start < 0 || rows < (hsize_t)q->start ||
                 rows - (hsize_t)q->start < (hsize_t)q->n || row != (hsize_t)q->width))
        return why_set(why, EX_DATAERR, "%s: not of %lld rows of %lld numbers", q->path,
                       (long long)(q->start + q->n), (long long)q->width);
    if (!all) first[0] = (hsize_t)q->start, count[0] = (hsize_t)q->n, rows = first[0] + count[0];
    if (check_stored(e, (all ? rows : count[0]) * row * o->size, why)) return why->status;
    hid_t set = open_set(s, e, why);
    if (set < 0) return why->status;
    struct reply reply = { .there = true };
    reply.size = (all ? rows : count[0]) * row * column_size(q->type);
    int bad = sink->begin(sink, &reply) ||
              put_block(set, column_native(q->type), (int)o->rank, first, count, sink);
    if (set != e->set) H5Dclose(set);
    return bad ? why_set(why, EX_DATAERR, "%s: cannot be read as %s (damaged?)", q->path,
                         wanted(q->type))
               : 0;
}

/* A scalar string of fixed or variable length as a new C string; of set and attr, one is -1. */
static char *text_of(hid_t set, hid_t attr, size_t *length, bool *no_memory)
{
    hid_t disk = set >= 0 ? H5Dget_type(set) : H5Aget_type(attr);
    hid_t space = set >= 0 ? H5Dget_space(set) : H5Aget_space(attr);
    char *out = NULL, *text = NULL;
    bool single = H5Tget_class(disk) == H5T_STRING && H5Sget_simple_extent_npoints(space) == 1;
    if (single && H5Tis_variable_str(disk) > 0) {
        hid_t type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, H5T_VARIABLE);
        H5Tset_cset(type, H5Tget_cset(disk));
        herr_t e = set >= 0 ? H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &text)
                            : H5Aread(attr, type, &text);
        if (e >= 0) *no_memory = !(out = strdup(text ? text : ""));
        H5free_memory(text);
        H5Tclose(type);
    } else if (single) {
        *no_memory = !(out = calloc(H5Tget_size(disk) + 1, 1));
        herr_t e = !out       ? 0
                   : set >= 0 ? H5Dread(set, disk, H5S_ALL, H5S_ALL, H5P_DEFAULT, out)
                              : H5Aread(attr, disk, out);
        if (e < 0) free(out), out = NULL;
    }
    if (out) *length = strlen(out);
    H5Sclose(space);
    H5Tclose(disk);
    return out;
}

static int answer_text(struct served *s, const struct request *q, struct sink *sink,
                       struct why *why)
{
    struct reply reply = { 0 };
    const char *path = *q->path ? q->path : "/";
    char *text = NULL;
    size_t length = 0;
    bool no_memory = false, is_text = true;
    if (q->name[0]) {
        hid_t attr = H5Aopen_by_name(s->file, path, q->name, H5P_DEFAULT, H5P_DEFAULT);
        if (attr < 0) return sink->begin(sink, &reply);
        is_text = H5Aget_storage_size(attr) <= MOST_ATTRIBUTE;
        if (is_text) text = text_of(-1, attr, &length, &no_memory);
        H5Aclose(attr);
    } else {
        struct why none = { 0 };
        const struct entry *e = find(s, q->path, &none);
        if (!e) return sink->begin(sink, &reply);
        is_text = e->object.kind == OBJECT_TEXT;
        if (is_text && check_stored(e, e->object.size, why)) return why->status;
        hid_t set = is_text ? open_set(s, e, why) : -1;
        if (set >= 0) text = text_of(set, -1, &length, &no_memory);
        if (set >= 0 && set != e->set) H5Dclose(set);
    }
    if (no_memory) why_set(why, EX_SOFTWARE, "%s: no memory", path);
    if (why->status) return free(text), why->status;
    if (!text)
        return why_set(why, EX_DATAERR, "%s%s%s: %s", path, q->name[0] ? "@" : "", q->name,
                       is_text ? "cannot be read as a text (damaged?)" : "a text is wanted");
    if (serve_bytes(sink, &reply, text, length)) why_set(why, EX_SOFTWARE, "%s: not sent", path);
    free(text);
    return why->status;
}

static int answer_attribute(struct served *s, const struct request *q, struct sink *sink,
                            struct why *why)
{
    const char *path = *q->path ? q->path : "/";
    hid_t attr = H5Aopen_by_name(s->file, path, q->name, H5P_DEFAULT, H5P_DEFAULT);
    if (attr < 0) return why_set(why, EX_DATAERR, "%s@%s: no such attribute", path, q->name);
    hid_t disk = H5Aget_type(attr), space = H5Aget_space(attr);
    hssize_t points = space < 0 ? -1 : H5Sget_simple_extent_npoints(space),
             want = q->n < 0 ? 1 : q->n;
    struct object o = { 0 };
    double numbers[16];
    struct reply reply = { 0 };
    if (disk >= 0) describe(disk, &o);
    if (!suits(&o, q->type))
        why_set(why, EX_DATAERR, "%s@%s: %s are wanted", path, q->name, wanted(q->type));
    else if (points != want || want > 16)
        why_set(why, EX_DATAERR, "%s@%s: %lld values, %lld are wanted", path, q->name,
                (long long)points, (long long)want);
    else if (want && H5Aread(attr, column_native(q->type), numbers) < 0)
        why_set(why, EX_DATAERR, "%s@%s: cannot be read", path, q->name);
    else if (serve_bytes(sink, &reply, numbers, (size_t)want * column_size(q->type)))
        why_set(why, EX_SOFTWARE, "%s: not sent", path);
    if (space >= 0) H5Sclose(space);
    if (disk >= 0) H5Tclose(disk);
    H5Aclose(attr);
    return why->status;
}

/* ---- for copies ---- */

/* The memory type of an object's elements; to be closed when it is a string. */
static hid_t memory_type(const struct object *o)
{
    if (o->class != 's') return h5_plain(o->class, o->size);
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, o->size);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    return type;
}

static int answer_raw(struct served *s, const struct request *q, struct sink *sink, struct why *why)
{
    const struct entry *e = find(s, q->path, why);
    if (!e) return why->status;
    const struct object *o = &e->object;
    hsize_t first[SERVE_RANK] = { 0 }, points = 1;
    for (uint32_t k = 0; k < o->rank && o->rank <= SERVE_RANK; k++) points *= e->shape[k];
    if (o->rank > SERVE_RANK || !o->size || o->size > SERVE_PIECE ||
        (o->kind != OBJECT_NUMBERS && o->kind != OBJECT_TEXT))
        return why_set(why, EX_DATAERR, "%s: holds something that cannot be copied", q->path);
    if (check_stored(e, points * o->size, why)) return why->status;
    hid_t set = open_set(s, e, why), type = memory_type(o);
    if (set < 0) return why->status;
    struct reply reply = { .there = true, .size = points * o->size };
    if (o->class == 's') H5Tset_cset(type, H5T_CSET_UTF8);
    hid_t disk = o->class == 's' ? H5Dget_type(set) : -1;
    if (disk >= 0) H5Tset_cset(type, H5Tget_cset(disk)), H5Tclose(disk);
    int bad =
        sink->begin(sink, &reply) || put_block(set, type, (int)o->rank, first, e->shape, sink);
    if (o->class == 's') H5Tclose(type);
    if (set != e->set) H5Dclose(set);
    return bad ? why_set(why, EX_DATAERR, "%s: cannot be read (damaged?)", q->path) : 0;
}

/* A sequence of objects that grows */
struct gathered {
    char *bytes;
    size_t size, room;
    const char *path; /* of the object whose attributes they are */
    bool group;       /* they go under "path@name" */
    struct why *why;
};

/* One more object at the end of the sequence */
static int append(struct gathered *g, const struct object *o, const hsize_t *shape,
                  const char *name, const void *data)
{
    size_t size = object_size(o) + padded(o->data);
    if (g->size + size > g->room) {
        size_t room = 2 * g->room + size + 4096;
        char *more = realloc(g->bytes, room);
        if (!more) return why_set(g->why, EX_SOFTWARE, "no memory for a list of objects");
        g->bytes = more, g->room = room;
    }
    if (!g->bytes) return 0; // nothing to add to nothing
    memset(g->bytes + g->size, 0, size);
    char *to = put_object(g->bytes + g->size, o, shape, name);
    if (o->data && data) memcpy(to, data, o->data);
    g->size += size;
    return 0;
}

/* One attribute: what it is, and its data. */
static int gather(struct gathered *g, const char *name, hid_t attr)
{
    struct object o = { 0 };
    hsize_t shape[H5S_MAX_RANK] = { 0 }, points = 1;
    hid_t disk = H5Aget_type(attr), space = H5Aget_space(attr);
    int rank = space < 0 ? -1 : H5Sget_simple_extent_dims(space, shape, NULL);
    char *text = NULL;
    void *data = NULL;
    size_t length = 0;
    bool no_memory = false;
    if (disk >= 0) describe(disk, &o);
    for (int k = 0; k < rank; k++) points *= shape[k];
    if (rank < 0 || rank > SERVE_RANK || points > MOST_ATTRIBUTE || o.kind == OBJECT_OTHER ||
        H5Sget_simple_extent_type(space) == H5S_NULL || points * o.size > MOST_ATTRIBUTE)
        o.kind = OBJECT_OTHER;
    o.rank = o.kind == OBJECT_OTHER ? 0 : (uint32_t)rank;
    if (o.kind == OBJECT_TEXT && points == 1) {
        text = text_of(-1, attr, &length, &no_memory);
        o.rank = 0, o.size = (uint32_t)length + 1, o.data = length + 1;
    } else if (o.kind == OBJECT_TEXT && !o.size) {
        o.kind = OBJECT_OTHER, o.rank = 0; // several strings of any length
    } else if (o.kind != OBJECT_OTHER) {
        hid_t type = memory_type(&o);
        if (o.class == 's') H5Tset_cset(type, H5Tget_cset(disk));
        o.data = points * o.size;
        data = calloc(o.data + 1, 1);
        no_memory = !data;
        if (data && o.data && H5Aread(attr, type, data) < 0) free(data), data = NULL;
        if (o.class == 's') H5Tclose(type);
    }
    if (space >= 0) H5Sclose(space);
    if (disk >= 0) H5Tclose(disk);
    const void *from = text ? text : data;
    if (!from && o.kind != OBJECT_OTHER) {
        return no_memory
                   ? why_set(g->why, EX_SOFTWARE, "no memory for attributes")
                   : why_set(g->why, EX_DATAERR, "%s@%s: cannot be read (damaged?)", g->path, name);
    }
    char under[SERVE_PATH + SERVE_NAME];
    snprintf(under, sizeof under, "%s@%s", g->path, name);
    if (g->group) name = under;
    o.name = (uint32_t)strlen(name) + 1, o.attribute = g->group;
    append(g, &o, shape, name, from);
    free(text), free(data);
    return g->why->status;
}

static herr_t gather_attribute(hid_t from, const char *name, const H5A_info_t *info, void *data)
{
    (void)info;
    struct gathered *g = data;
    hid_t attr = H5Aopen(from, name, H5P_DEFAULT);
    if (attr < 0)
        return why_set(g->why, EX_DATAERR, "%s@%s: cannot be opened (damaged?)", g->path, name), -1;
    int e = gather(g, name, attr);
    H5Aclose(attr);
    return e ? -1 : 0;
}

static int answer_attributes(struct served *s, const struct request *q, struct sink *sink,
                             struct why *why)
{
    struct gathered g = { .path = *q->path ? q->path : "/", .why = why };
    struct reply reply = { 0 };
    hid_t object = H5Oopen(s->file, g.path, H5P_DEFAULT);
    if (object < 0 ||
        H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, NULL, gather_attribute, &g) < 0)
        why_set(why, EX_DATAERR, "%s: attributes cannot be read (damaged?)", g.path);
    if (object >= 0) H5Oclose(object);
    if (!why->status && serve_bytes(sink, &reply, g.bytes ? g.bytes : "", g.size))
        why_set(why, EX_SOFTWARE, "%s: not sent", g.path);
    free(g.bytes);
    return why->status;
}

/* ---- the list of objects ---- */

/* The data of a small dataset, so that nobody needs to ask; NULL where that does not work out. */
static void *small_data(const struct served *s, const struct entry *e, struct object *o,
                        size_t most)
{
    struct why none = { 0 };
    hsize_t points = 1;
    size_t length = 0;
    bool no_memory;
    for (uint32_t k = 0; k < o->rank && o->rank <= SERVE_RANK; k++) points *= e->shape[k];
    if (o->rank > SERVE_RANK || (o->kind != OBJECT_NUMBERS && o->kind != OBJECT_TEXT) || e->set < 0)
        return NULL;
    if (!points || points > most || points * o->size > most ||
        (o->kind == OBJECT_TEXT && (o->rank || !o->size)) ||
        check_stored(e, points * o->size, &none))
        return NULL;
    if (o->kind == OBJECT_TEXT) {
        char *text = text_of(e->set, -1, &length, &no_memory);
        o->data = text ? length : 0;
        return text;
    }
    void *data = malloc(points * o->size + 1);
    if (!data ||
        H5Dread(e->set, h5_plain(o->class, o->size), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) {
        free(data);
        return NULL;
    }
    (void)s;
    o->data = points * o->size;
    return data;
}

static int add_group_attributes(struct served *s, const char *path, struct gathered *g)
{
    hid_t group = H5Gopen2(s->file, *path ? path : "/", H5P_DEFAULT);
    g->path = path, g->group = true;
    if (group < 0 || H5Aiterate2(group, H5_INDEX_NAME, H5_ITER_INC, NULL, gather_attribute, g) < 0)
        why_set(g->why, EX_DATAERR, "%s: attributes cannot be read (damaged?)", path);
    if (group >= 0) H5Gclose(group);
    return g->why->status;
}

void *serve_objects(struct served *s, size_t *size, struct why *why)
{
    struct gathered g = { .why = why };
    size_t sent = 0;
    for (int64_t k = 0; k < s->count && !why->status; k++) {
        const struct entry *e = &s->entry[k];
        struct object o = e->object;
        size_t most = e->owner ? SMALL_DATA : SMALL_LINKED;
        o.name = (uint32_t)strlen(e->path) + 1;
        void *data = sent < MOST_SENT ? small_data(s, e, &o, most) : NULL;
        append(&g, &o, e->shape, e->path, data);
        free(data);
        sent += o.data;
        if (o.kind == OBJECT_GROUP && !why->status && sent < MOST_SENT)
            add_group_attributes(s, e->path, &g);
    }
    *size = g.size;
    if (!why->status && !g.bytes) g.bytes = calloc(1, 1); // there is nothing in it
    if (!why->status && g.bytes) return g.bytes;
    why_set(why, EX_SOFTWARE, "no memory for a list of objects");
    free(g.bytes);
    return NULL;
}

int serve_answer(struct served *s, const struct request *q, struct sink *sink, struct why *why)
{
    switch (q->op) {
    case REQUEST_ROWS:
        return answer_rows(s, q, sink, why);
    case REQUEST_RAW:
        return answer_raw(s, q, sink, why);
    case REQUEST_TEXT:
        return answer_text(s, q, sink, why);
    case REQUEST_ATTRIBUTE:
        return answer_attribute(s, q, sink, why);
    case REQUEST_ATTRIBUTES:
        return answer_attributes(s, q, sink, why);
    default:
        return why_set(why, EX_SOFTWARE, "no such request");
    }
}
