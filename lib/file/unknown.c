#include "file/unknown.h"

#include "base/array.h"
#include "file/element.h"
#include "file/source.h"
#include "state/body_columns.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A group, or a dataset and its data; with attributes */
struct unknown_item {
    struct object object;
    hsize_t shape[OBJECT_RANK];
    char *path;
    char *text; /* of a scalar text, else NULL */
    void *data; /* of any other dataset, else NULL */
    unsigned char *attributes;
    uint64_t attributes_size;
};

struct unknown {
    int owners;
    int64_t count, room;
    struct unknown_item *item;
};

/* Groups whose members are looked through, and the names in them that nsd uses */
static const struct {
    const char *group;
    const char *known[18];
} looked_through[] = {
    { "", { "h5md", "nsd", "particles", "walls", "contacts", "observables", "solution" } },
    { "/nsd",
      { "history", "scene", "material", "solver", "account", "flow", "cell", "shape", "law",
        "bonds", "breakage", "memory", "time_step", "outside", "names" } },
    { "/particles", { "all", "boundary" } },
    { "/particles/boundary",
      { "body", "load", "drive", "push", "mesh", "position", "orientation", "velocity",
        "angular_velocity", "step", "time", "sums" } },
    { "/particles/all", { "box" } }, // and body_columns[]
    { "/walls", { "plane", "load" } },
    { "/observables", { "solver" } },
};

enum { GROUPS = sizeof looked_through / sizeof looked_through[0] };

/* Is `path` one of the group's own members? Its name, or NULL. */
static const char *member(const char *group, const char *path)
{
    size_t n = strlen(group);
    if (strncmp(group, path, n) != 0 || path[n] != '/') return NULL;
    return strchr(path + n + 1, '/') ? NULL : path + n + 1;
}

/* Is this object unknown, and not merely inside of one that is? */
static bool is_unknown(const char *path)
{
    for (int g = 0; g < GROUPS; g++) {
        const char *name = member(looked_through[g].group, path);
        if (!name) continue;
        for (const char *const *k = looked_through[g].known; *k; k++)
            if (!strcmp(*k, name)) return false;
        for (const struct field *b = body_columns; b->name; b++)
            if (!strcmp(looked_through[g].group, "/particles/all") && !strcmp(b->name, name))
                return false;
        return true;
    }
    return false;
}

static int read_item(struct unknown_item *i, struct source *s, struct failure *failure)
{
    const struct object *o = &i->object;
    uint64_t size;
    if (o->kind == OBJECT_OTHER || o->rank > OBJECT_RANK ||
        (o->rank && o->kind != OBJECT_GROUP && !o->size))
        return failure_set(failure, EX_DATAERR,
                           "%s: neither numbers nor texts: it cannot be copied", i->path);
    i->attributes = source_attributes(s, i->path, &i->attributes_size, failure);
    if (o->kind == OBJECT_TEXT && !o->rank)
        i->text = source_text(s, i->path, NULL, failure);
    else if (o->kind != OBJECT_GROUP && !failure->status)
        i->data = source_raw(s, i->path, &size, failure);
    return failure->status;
}

static int unknown_add(struct unknown *u, const struct object *o, const char *path,
                       const uint64_t *shape, struct source *s, struct failure *failure)
{
    if (!array_grow(&u->item, &u->room, u->count + 1, sizeof *u->item))
        return failure_set(failure, EX_SOFTWARE, "no memory for a copy of %s", path);
    struct unknown_item *i = &u->item[u->count++];
    *i = (struct unknown_item){ .object = *o, .path = strdup(path) };
    if (!i->path) return failure_set(failure, EX_SOFTWARE, "no memory for a copy of %s", path);
    for (uint32_t k = 0; k < o->rank && o->rank <= OBJECT_RANK; k++) i->shape[k] = shape[k];
    return read_item(i, s, failure);
}

/* An object and all that is in it, which follows it in the walk; the first that does not. */
static int64_t add_tree(struct unknown *u, struct source *s, int64_t k, struct failure *failure)
{
    const char *path, *inner;
    const uint64_t *shape;
    const struct object *o = source_object(s, k, &path, &shape);
    size_t n = strlen(path);
    if (unknown_add(u, o, path, shape, s, failure)) return k;
    for (k++; (o = source_object(s, k, &inner, &shape)); k++) {
        if (o->attribute) continue;
        if (strncmp(inner, path, n) != 0 || inner[n] != '/') break;
        if (unknown_add(u, o, inner, shape, s, failure)) break;
    }
    return k;
}

int unknown_read(struct unknown **out, struct source *s, bool whole, struct failure *failure)
{
    struct unknown *u = *out = NULL;
    const char *path;
    const uint64_t *shape;
    for (int64_t k = 0; !failure->status && source_object(s, k, &path, &shape);) {
        char step[OBJECT_PATH + 8];
        const struct object *o = source_object(s, k, &path, &shape);
        snprintf(step, sizeof step, "%s/step", path);
        if (o->attribute || !is_unknown(path) || (!whole && source_has(s, step))) {
            k++;
            continue;
        }
        if (!u) *out = u = calloc(1, sizeof *u);
        if (!u) return failure_set(failure, EX_SOFTWARE, "no memory for a copy of %s", path);
        u->owners = 1;
        k = add_tree(u, s, k, failure);
    }
    return failure->status;
}

const char *unknown_timed(struct source *s)
{
    const char *path;
    const uint64_t *shape;
    for (int64_t k = 0; source_object(s, k, &path, &shape); k++) {
        char step[OBJECT_PATH + 8];
        const struct object *o = source_object(s, k, &path, &shape);
        snprintf(step, sizeof step, "%s/step", path);
        if (!o->attribute && is_unknown(path) && source_has(s, step)) return path;
    }
    return NULL;
}

struct unknown *unknown_share(struct unknown *u)
{
    if (u) u->owners++;
    return u;
}

void unknown_free(struct unknown *u)
{
    if (!u || --u->owners) return;
    for (int64_t k = 0; k < u->count; k++) {
        struct unknown_item *i = &u->item[k];
        free(i->path), free(i->text), free(i->data), free(i->attributes);
    }
    free(u->item);
    free(u);
}

static int write_attributes(const struct unknown_item *i, hid_t file, struct failure *failure)
{
    uint64_t at = 0;
    struct listed l;
    while (!failure->status && object_unpack(i->attributes, i->attributes_size, &at, &l)) {
        const struct object o = l.object;
        const char *name = l.path;
        if (o.kind == OBJECT_OTHER || !o.size)
            return failure_set(failure, EX_DATAERR,
                               "%s@%s: neither numbers nor texts: it cannot be copied", i->path,
                               name);
        hsize_t dims[OBJECT_RANK], points = 1;
        for (uint32_t k = 0; k < o.rank; k++) points *= dims[k] = l.shape[k];
        if (points * o.size != o.data)
            return failure_set(failure, EX_DATAERR, "%s@%s: of another size", i->path, name);
        if (o.kind == OBJECT_TEXT && !o.rank) {
            h5_attr_text(file, i->path, name, l.data, failure);
            continue;
        }
        hid_t type = element_type(&o);
        h5_attr(file, i->path, name, h5_array(type, (int)o.rank, dims, l.data), failure);
        if (o.class == 's') H5Tclose(type);
    }
    return failure->status;
}

static int write_item(const struct unknown_item *i, hid_t file, struct failure *failure)
{
    const struct object *o = &i->object;
    if (o->kind == OBJECT_GROUP) {
        if (h5_group(file, i->path, failure)) return failure->status;
    } else if (i->text) {
        if (h5_write_text(file, i->path, i->text, failure)) return failure->status;
    } else {
        hid_t type = element_type(o);
        h5_write(file, i->path, h5_array(type, (int)o->rank, i->shape, i->data), NULL, failure);
        if (o->class == 's') H5Tclose(type);
    }
    return failure->status ? failure->status : write_attributes(i, file, failure);
}

static bool is_problem(const char *path)
{
    return !strncmp(path, "/fclib_local", 12) || !strncmp(path, "/fclib_global", 13);
}

int unknown_write(const struct unknown *u, int64_t file, bool stale, struct failure *failure)
{
    for (int64_t k = 0; u && k < u->count && !failure->status; k++) {
        const struct unknown_item *i = &u->item[k];
        if ((stale && is_problem(i->path)) || h5_has(file, i->path)) continue;
        struct failure trouble = { 0 };
        if (write_item(i, file, &trouble)) // HDF5 writes not all that it reads
            failure_set(failure, trouble.status == EX_IOERR ? EX_DATAERR : trouble.status,
                        "%.200s: cannot be copied: %.150s", i->path, trouble.text);
    }
    return failure->status;
}
