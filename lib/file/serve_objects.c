/* file/serve.h: attributes, and the list of all objects. */
#include "file/serve.h"

#include "file/element.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
        return no_memory
                   ? failure_set(g->failure, EX_SOFTWARE, "no memory for attributes")
                   : failure_set(g->failure, EX_DATAERR, "%s@%s: cannot be read (damaged?)", g->path, name);
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
        return failure_set(g->failure, EX_DATAERR, "%s: more than %d attributes", g->path, MOST_ATTRIBUTES),
               -1;
    hid_t attr = H5Aopen(from, name, H5P_DEFAULT);
    if (attr < 0)
        return failure_set(g->failure, EX_DATAERR, "%s@%s: cannot be opened (damaged?)", g->path, name), -1;
    int e = serve_gather(g, name, attr);
    H5Aclose(attr);
    return e ? -1 : 0;
}

int serve_attributes(struct served *s, const struct request *q, struct sink *sink, struct failure *failure)
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
