#include "file/serve.h"

#include "file/element.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A block of a dataset, in pieces that are whole in its last dimensions. */
static int serve_put_block(hid_t set, hid_t type, int rank, const hsize_t *first,
                           const hsize_t *count, struct sink *sink)
{
    size_t most, element = H5Tget_size(type);
    hsize_t at[OBJECT_RANK] = { 0 }, n[OBJECT_RANK] = { 0 }, inner = 1, total = 1;
    for (int k = 0; k < rank; k++) n[k] = 1, total *= count[k];
    if (!total) return 0;
    void *to = sink->room(sink, &most);
    int k = rank - 1; // the dimension that is cut
    while (k > 0 && inner * count[k] <= most / element) n[k] = count[k], inner *= count[k--];
    hid_t space = H5Dget_space(set);
    herr_t e = 0;
    for (hsize_t done = 0; done < total && e >= 0;) {
        hsize_t from[OBJECT_RANK], points = inner;
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
        if (e >= 0) e = H5Dread(set, type, memory, space, element_transfer(), to);
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

/* The numbers wanted: the dataset of a request, whose type suits it; else NULL and why */
static const struct served_entry *find_numbers(const struct served *s, const struct request *q,
                                               struct failure *failure)
{
    const struct served_entry *e = served_find(s, q->path, failure);
    if (!e || element_suits(&e->object, q->type)) return e;
    failure_set(failure, EX_DATAERR, "%s: %s are needed, and it holds something else", q->path,
                element_wanted(q->type));
    return NULL;
}

/* Block of a dataset that is asked for */
struct serve_block {
    hsize_t first[OBJECT_RANK], count[OBJECT_RANK];
    hsize_t stored; /* numbers of the dataset that have to be in the file */
};

static int answer_block(struct served *s, const struct served_entry *e, const struct request *q,
                        const struct serve_block *b, struct sink *sink, struct failure *failure)
{
    const struct object *o = &e->object;
    struct reply reply = { .there = true, .size = field_size(q->type) };
    for (uint32_t k = 0; k < o->rank; k++) reply.size *= b->count[k];
    if (served_stored(e, b->stored * o->size, failure)) return failure->status;
    hid_t set = served_set(s, e, failure);
    if (set < 0) return failure->status;
    if (set != e->set) reply.work = e->chunk;
    int bad = sink->begin(sink, &reply) ||
              serve_put_block(set, column_native(q->type), (int)o->rank, b->first, b->count, sink);
    if (set != e->set) H5Dclose(set);
    return bad ? failure_set(failure, EX_DATAERR, "%s: cannot be read as %s (damaged?)", q->path,
                             element_wanted(q->type))
               : 0;
}

static int answer_rows(struct served *s, const struct request *q, struct sink *sink,
                       struct failure *failure)
{
    const struct served_entry *e = find_numbers(s, q, failure);
    if (!e) return failure->status;
    const struct object *o = &e->object;
    struct serve_block b = { .first = { 0 } };
    hsize_t row = 1, rows = o->rank ? e->shape[0] : 1;
    for (uint32_t k = 0; k < o->rank; k++) {
        b.count[k] = e->shape[k];
        if (k) row *= b.count[k];
    }
    bool all = q->n < 0;
    if (!all && (!o->rank || q->start < 0 || rows < (hsize_t)q->start ||
                 rows - (hsize_t)q->start < (hsize_t)q->n || row != (hsize_t)q->width))
        return failure_set(failure, EX_DATAERR, "%s: not of %lld rows of %lld numbers", q->path,
                           (long long)(q->start + q->n), (long long)q->width);
    if (!all) b.first[0] = (hsize_t)q->start, b.count[0] = (hsize_t)q->n, rows = b.count[0];
    b.stored = rows * row;
    return answer_block(s, e, q, &b, sink, failure);
}

/* Of one row some rows of the dimension within it */
static int answer_part(struct served *s, const struct request *q, struct sink *sink,
                       struct failure *failure)
{
    const struct served_entry *e = find_numbers(s, q, failure);
    if (!e) return failure->status;
    const struct object *o = &e->object;
    struct serve_block b = { .first = { 0 } };
    hsize_t *first = b.first, *count = b.count, width = 1;
    for (uint32_t k = 0; k < o->rank; k++) {
        count[k] = e->shape[k];
        if (k > 1) width *= count[k];
    }
    if (o->rank < 2 || q->start < 0 || q->from < 0 || q->n < 0 || count[0] <= (hsize_t)q->start ||
        count[1] < (hsize_t)q->from || count[1] - (hsize_t)q->from < (hsize_t)q->n ||
        width != (hsize_t)q->width)
        return failure_set(failure, EX_DATAERR, "%s: has no such part", q->path);
    b.stored = count[1] * width;
    first[0] = (hsize_t)q->start, count[0] = 1;
    first[1] = (hsize_t)q->from, count[1] = (hsize_t)q->n;
    return answer_block(s, e, q, &b, sink, failure);
}

static int answer_text(struct served *s, const struct request *q, struct sink *sink,
                       struct failure *failure)
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
        if (is_text) text = element_text(-1, attr, &length, &no_memory);
        H5Aclose(attr);
    } else {
        struct failure none = { 0 };
        const struct served_entry *e = served_find(s, q->path, &none);
        if (!e) return sink->begin(sink, &reply);
        is_text = e->object.kind == OBJECT_TEXT;
        if (is_text && served_stored(e, e->object.size, failure)) return failure->status;
        hid_t set = is_text ? served_set(s, e, failure) : -1;
        if (set >= 0)
            text = q->n ? element_lines(set, &length, &no_memory)
                        : element_text(set, -1, &length, &no_memory);
        if (set >= 0 && set != e->set) H5Dclose(set);
    }
    if (no_memory) failure_set(failure, EX_SOFTWARE, "%s: no memory", path);
    if (failure->status) return free(text), failure->status;
    if (!text)
        return failure_set(failure, EX_DATAERR, "%s%s%s: %s", path, q->name[0] ? "@" : "", q->name,
                           is_text ? "cannot be read as a text (damaged?)" : "a text is needed");
    if (sink_bytes(sink, &reply, text, length))
        failure_set(failure, EX_SOFTWARE, "%s: not sent", path);
    free(text);
    return failure->status;
}

static int answer_attribute(struct served *s, const struct request *q, struct sink *sink,
                            struct failure *failure)
{
    const char *path = *q->path ? q->path : "/";
    hid_t attr = H5Aopen_by_name(s->file, path, q->name, H5P_DEFAULT, H5P_DEFAULT);
    if (attr < 0)
        return failure_set(failure, EX_DATAERR, "%s@%s: no such attribute", path, q->name);
    hid_t disk = H5Aget_type(attr), space = H5Aget_space(attr);
    hssize_t points = space < 0 ? -1 : H5Sget_simple_extent_npoints(space),
             want = q->n < 0 ? 1 : q->n;
    struct object o = { 0 };
    double numbers[16];
    struct reply reply = { 0 };
    if (disk >= 0) element_describe(disk, &o);
    if (!element_suits(&o, q->type))
        failure_set(failure, EX_DATAERR, "%s@%s: %s are needed", path, q->name,
                    element_wanted(q->type));
    else if (points != want || want > 16)
        failure_set(failure, EX_DATAERR, "%s@%s: %lld values, %lld are needed", path, q->name,
                    (long long)points, (long long)want);
    else if (want && H5Aread(attr, column_native(q->type), numbers) < 0)
        failure_set(failure, EX_DATAERR, "%s@%s: cannot be read", path, q->name);
    else if (sink_bytes(sink, &reply, numbers, (size_t)want * field_size(q->type)))
        failure_set(failure, EX_SOFTWARE, "%s: not sent", path);
    if (space >= 0) H5Sclose(space);
    if (disk >= 0) H5Tclose(disk);
    H5Aclose(attr);
    return failure->status;
}

static int answer_raw(struct served *s, const struct request *q, struct sink *sink,
                      struct failure *failure)
{
    const struct served_entry *e = served_find(s, q->path, failure);
    if (!e) return failure->status;
    const struct object *o = &e->object;
    hsize_t first[OBJECT_RANK] = { 0 }, points = 1;
    for (uint32_t k = 0; k < o->rank && o->rank <= OBJECT_RANK; k++) points *= e->shape[k];
    if (o->rank > OBJECT_RANK || !o->size || o->size > REQUEST_PIECE ||
        (o->kind != OBJECT_NUMBERS && o->kind != OBJECT_TEXT))
        return failure_set(failure, EX_DATAERR, "%s: holds something that cannot be copied",
                           q->path);
    if (served_stored(e, points * o->size, failure)) return failure->status;
    hid_t set = served_set(s, e, failure), type = element_type(o);
    if (set < 0) return failure->status;
    struct reply reply = { .there = true, .size = points * o->size };
    hid_t disk = o->class == 's' ? H5Dget_type(set) : -1;
    if (disk >= 0) H5Tset_cset(type, H5Tget_cset(disk)), H5Tclose(disk);
    int bad = sink->begin(sink, &reply) ||
              serve_put_block(set, type, (int)o->rank, first, e->shape, sink);
    if (o->class == 's') H5Tclose(type);
    if (set != e->set) H5Dclose(set);
    return bad ? failure_set(failure, EX_DATAERR, "%s: cannot be read (damaged?)", q->path) : 0;
}

int serve_answer(struct served *s, const struct request *q, struct sink *sink,
                 struct failure *failure)
{
    switch (q->op) {
    case REQUEST_ROWS:
        return answer_rows(s, q, sink, failure);
    case REQUEST_PART:
        return answer_part(s, q, sink, failure);
    case REQUEST_RAW:
        return answer_raw(s, q, sink, failure);
    case REQUEST_TEXT:
        return answer_text(s, q, sink, failure);
    case REQUEST_ATTRIBUTE:
        return answer_attribute(s, q, sink, failure);
    case REQUEST_ATTRIBUTES:
        return serve_attributes(s, q, sink, failure);
    default:
        return failure_set(failure, EX_SOFTWARE, "no such request");
    }
}

/* Attributes, and the list of all objects. */

enum {
    SMALL_DATA = 1 << 16,   /* bytes of a dataset that are sent with the list of objects; */
    SMALL_LINKED = 1 << 12, /* of one under a second name, for step and time have forty; */
    MOST_SENT = 1 << 20,    /* and in all */
    MOST_ATTRIBUTES = 1000  /* of an object: to copy n takes libhdf5 n^2 */
};

/* Objects that are gathered, and whose attributes they are */
struct serve_gathered {
    struct objects objects;
    const char *path; /* of the object whose attributes they are */
    bool group;       /* they go under "path@name" */
    int count;        /* that it has so far */
    struct failure *failure;
};

/* One attribute: what it is, and its data. */
static int serve_gather(struct serve_gathered *g, const char *name, hid_t attr)
{
    struct object o = { 0 };
    hsize_t shape[H5S_MAX_RANK] = { 0 }, points = 1;
    hid_t disk = H5Aget_type(attr), space = H5Aget_space(attr);
    int rank = space < 0 ? -1 : H5Sget_simple_extent_dims(space, shape, NULL);
    char *text = NULL;
    void *data = NULL;
    size_t length = 0;
    bool no_memory = false;
    if (disk >= 0) element_describe(disk, &o);
    for (int k = 0; k < rank; k++) points *= shape[k];
    if (rank < 0 || rank > OBJECT_RANK || points > MOST_ATTRIBUTE || o.kind == OBJECT_OTHER ||
        H5Sget_simple_extent_type(space) == H5S_NULL || points * o.size > MOST_ATTRIBUTE)
        o.kind = OBJECT_OTHER;
    o.rank = o.kind == OBJECT_OTHER ? 0 : (uint32_t)rank;
    if (o.kind == OBJECT_TEXT && points == 1) {
        text = element_text(-1, attr, &length, &no_memory);
        o.rank = 0, o.size = (uint32_t)length + 1, o.data = length + 1;
    } else if (o.kind == OBJECT_TEXT && !o.size) {
        o.kind = OBJECT_OTHER, o.rank = 0; // several strings of any length
    } else if (o.kind != OBJECT_OTHER) {
        hid_t type = element_type(&o);
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
    if (disk < 0 || space < 0 || (!from && o.kind != OBJECT_OTHER)) {
        free(text), free(data);
        return no_memory ? failure_set(g->failure, EX_SOFTWARE, "no memory for attributes")
                         : failure_set(g->failure, EX_DATAERR, "%s@%s: cannot be read (damaged?)",
                                       g->path, name);
    }
    char under[OBJECT_PATH + OBJECT_NAME];
    snprintf(under, sizeof under, "%s@%s", g->path, name);
    if (g->group) name = under;
    o.name = (uint32_t)strlen(name) + 1, o.attribute = g->group;
    objects_add(&g->objects, &o, shape, name, from, g->failure);
    free(text), free(data);
    return g->failure->status;
}

static herr_t gather_attribute(hid_t from, const char *name, const H5A_info_t *info, void *data)
{
    (void)info;
    struct serve_gathered *g = data;
    if (g->count++ == MOST_ATTRIBUTES)
        return failure_set(g->failure, EX_DATAERR, "%s: more than %d attributes", g->path,
                           MOST_ATTRIBUTES),
               -1;
    hid_t attr = H5Aopen(from, name, H5P_DEFAULT);
    if (attr < 0)
        return failure_set(g->failure, EX_DATAERR, "%s@%s: cannot be opened (damaged?)", g->path,
                           name),
               -1;
    int e = serve_gather(g, name, attr);
    H5Aclose(attr);
    return e ? -1 : 0;
}

int serve_attributes(struct served *s, const struct request *q, struct sink *sink,
                     struct failure *failure)
{
    struct serve_gathered g = { .path = *q->path ? q->path : "/", .failure = failure };
    struct reply reply = { 0 };
    hid_t object = H5Oopen(s->file, g.path, H5P_DEFAULT);
    if (object < 0 ||
        H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, NULL, gather_attribute, &g) < 0)
        failure_set(failure, EX_DATAERR, "%s: attributes cannot be read (damaged?)", g.path);
    if (object >= 0) H5Oclose(object);
    if (!failure->status &&
        sink_bytes(sink, &reply, g.objects.bytes ? (const void *)g.objects.bytes : "",
                   g.objects.size))
        failure_set(failure, EX_SOFTWARE, "%s: not sent", g.path);
    free(g.objects.bytes);
    return failure->status;
}

/* The data of a small dataset, so that nobody needs to ask; NULL where that does not work out. */
static void *small_data(const struct served *s, const struct served_entry *e, struct object *o,
                        size_t most)
{
    struct failure none = { 0 };
    hsize_t points = 1;
    size_t length = 0;
    bool no_memory;
    for (uint32_t k = 0; k < o->rank && o->rank <= OBJECT_RANK; k++) points *= e->shape[k];
    if (o->rank > OBJECT_RANK || (o->kind != OBJECT_NUMBERS && o->kind != OBJECT_TEXT) ||
        e->set < 0)
        return NULL;
    if (!points || points > most || points * o->size > most ||
        (o->kind == OBJECT_TEXT && (o->rank || !o->size)) ||
        served_stored(e, points * o->size, &none))
        return NULL;
    if (o->kind == OBJECT_TEXT) {
        char *text = element_text(e->set, -1, &length, &no_memory);
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

static int add_group_attributes(struct served *s, const char *path, struct serve_gathered *g)
{
    hid_t group = H5Gopen2(s->file, *path ? path : "/", H5P_DEFAULT);
    g->path = path, g->group = true, g->count = 0;
    if (group < 0 || H5Aiterate2(group, H5_INDEX_NAME, H5_ITER_INC, NULL, gather_attribute, g) < 0)
        failure_set(g->failure, EX_DATAERR, "%s: attributes cannot be read (damaged?)", path);
    if (group >= 0) H5Gclose(group);
    return g->failure->status;
}

void *serve_objects(struct served *s, size_t *size, struct failure *failure)
{
    struct serve_gathered g = { .failure = failure };
    size_t sent = 0;
    for (int64_t k = 0; k < s->count && !failure->status; k++) {
        const struct served_entry *e = &s->entry[k];
        struct object o = e->object;
        size_t most = e->owner ? SMALL_DATA : SMALL_LINKED;
        o.name = (uint32_t)strlen(e->path) + 1;
        void *data = sent < MOST_SENT ? small_data(s, e, &o, most) : NULL;
        objects_add(&g.objects, &o, e->shape, e->path, data, failure);
        free(data);
        sent += o.data;
        if (o.kind == OBJECT_GROUP && !failure->status && sent < MOST_SENT)
            add_group_attributes(s, e->path, &g);
    }
    *size = g.objects.size;
    void *bytes = g.objects.bytes;
    if (!failure->status && !bytes) bytes = calloc(1, 1); // there is nothing in it
    if (!failure->status && bytes) return bytes;
    failure_set(failure, EX_SOFTWARE, "no memory for a list of objects");
    free(bytes);
    return NULL;
}
