/* run/objects.c: documents as groups and datasets, checked as the tools check them [file/source.h]. */
#include "base/json.h"
#include "file/child.h"
#include "run/run.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct nsd_document {
    pid_t maker; /* the process that may use it */
    struct source *source;
    char *path;
    bool there; /* a document of the file is open */
    void *data; /* numbers that were asked for */
    char *text; /* a text, or JSON */
};

/* What the functions of nsd.h that have a document begin with; NULL with the reason: it is none that may be used. */
static struct failure *document_why(const struct nsd_document *d, bool open)
{
    struct failure *failure = run_why_of_thread();
    if (!d)
        failure_set(failure, NSD_USAGE, "there is no document: it was closed, or never opened");
    else if (!process_owns(d->maker))
        failure_set(
            failure, NSD_USAGE,
            "%.200s: process %lld reads it, of which this one is a copy by fork(): open it here",
            d->path, (long long)d->maker);
    else if (open && !d->there)
        failure_set(failure, NSD_USAGE, "%.200s: nsd_next() comes first, or has found the end",
                    d->path);
    return failure->status ? NULL : failure;
}

static int objects_no_memory(struct failure *failure)
{
    return failure_set(failure, NSD_SOFTWARE, "no memory for a document");
}

int nsd_open(struct nsd_document **document, const char *path)
{
    struct failure *failure = run_why_of_thread();
    if (!document) return failure_set(failure, NSD_USAGE, "there is no place for the document");
    *document = NULL;
    if (!path || !*path || !strcmp(path, "-"))
        return failure_set(failure, NSD_USAGE,
                           "a document has a path; standard input is the program's");
    struct nsd_document *d = calloc(1, sizeof *d);
    if (!d || !(d->path = strdup(path))) return free(d), objects_no_memory(failure);
    d->maker = process_begin();
    process_lock();
    source_open(&d->source, 1, &d->path, failure);
    process_unlock();
    if (failure->status) nsd_shut(&d);
    *document = d;
    return failure->status;
}

void nsd_shut(struct nsd_document **document)
{
    struct nsd_document *d = document ? *document : NULL;
    if (!d) return;
    *document = NULL;
    if (!process_owns(d->maker))
        return; // another thread may have been reading as this process began
    process_lock();
    source_close(d->source);
    process_unlock();
    free(d->path), free(d->data), free(d->text);
    free(d);
}

int nsd_next(struct nsd_document *d, int *more)
{
    struct failure *failure = document_why(d, false);
    struct source_document found;
    if (!failure) return NSD_USAGE;
    if (!more) return failure_set(failure, NSD_USAGE, "there is no place for whether there is one");
    d->there = false;
    if (source_next(d->source, &found, &d->there, failure)) return failure->status;
    *more = d->there;
    return 0;
}

/* ---- what there is ---- */

/* Replaces the text by another one, or by JSON, which is freed. */
static int put_json(struct nsd_document *d, json_t *j, const char **json, struct failure *failure)
{
    char *text = failure->status ? NULL : json_text(j);
    json_decref(j);
    if (failure->status) return failure->status;
    if (!text) return objects_no_memory(failure);
    free(d->text);
    *json = d->text = text;
    return 0;
}

/* "group", "f8", "i4", "u1", "s" for text, "other" */
static json_t *type_of(const struct object *o)
{
    if (o->kind == OBJECT_GROUP) return json_string("group");
    if (o->kind == OBJECT_TEXT) return json_string("s");
    if (o->kind == OBJECT_OTHER) return json_string("other");
    return json_sprintf("%c%u", o->class, o->size);
}

int nsd_objects(struct nsd_document *d, const char **json)
{
    struct failure *failure = document_why(d, true);
    const struct object *o;
    const uint64_t *shape;
    const char *path;
    if (!failure) return NSD_USAGE;
    if (!json) return failure_set(failure, NSD_USAGE, "there is no place for JSON");
    json_t *all = json_object();
    if (!all) objects_no_memory(failure);
    for (int64_t k = 0; !failure->status && (o = source_object(d->source, k, &path, &shape)); k++) {
        json_t *sizes = json_array(), *known = json_string(path);
        bool good = sizes;
        for (uint32_t i = 0; good && i < o->rank && o->rank <= OBJECT_RANK; i++)
            good = !json_array_append_new(sizes, json_integer((json_int_t)shape[i]));
        if (o->attribute ||
            !known) // attributes are asked for; what is not UTF-8 has no name in JSON
            json_decref(sizes);
        else if (!good ||
                 json_object_set_new(all, path,
                                     json_pack("{s:o, s:o}", "type", type_of(o), "shape", sizes)))
            objects_no_memory(failure);
        json_decref(known);
    }
    return put_json(d, all, json, failure);
}

/* Number k of an attribute; null: it is not finite */
static json_t *objects_number_of(const struct listed *l, uint64_t k)
{
    double x = NAN;
    int64_t i = 0;
    if (l->object.class != 'f' && listed_numbers(l, k, 1, COLUMN_I64, &i)) return json_integer(i);
    if (!listed_numbers(l, k, 1, COLUMN_F64, &x) || !isfinite(x)) return json_null();
    return json_real(x);
}

/* A text of `most` bytes, or up to its zero; null: it is not UTF-8 */
static json_t *objects_text_of(const char *text, size_t most)
{
    json_t *j = json_stringn(text, strnlen(text, most));
    return j ? j : json_null();
}

/* A scalar, or the list of all its values in their order; NULL: no memory */
static json_t *objects_values_of(const struct listed *l)
{
    const struct object *o = &l->object;
    const bool text = o->kind == OBJECT_TEXT;
    if ((!text && o->kind != OBJECT_NUMBERS) || !o->size) return json_null();
    const uint64_t n = o->data / o->size;
    if (!o->rank)
        return !n     ? json_null()
               : text ? objects_text_of(l->data, o->data)
                      : objects_number_of(l, 0);
    json_t *all = json_array();
    for (uint64_t k = 0; all && k < n; k++) {
        const char *at = (const char *)l->data + k * o->size;
        if (json_array_append_new(all,
                                  text ? objects_text_of(at, o->size) : objects_number_of(l, k)))
            return json_decref(all), NULL;
    }
    return all;
}

int nsd_attributes(struct nsd_document *d, const char *path, const char **json)
{
    struct failure *failure = document_why(d, true);
    uint64_t size = 0, at = 0;
    struct listed l;
    if (!failure) return NSD_USAGE;
    if (!path || !json)
        return failure_set(failure, NSD_USAGE, "an object has a path, and JSON a place");
    if (*path && !source_has(d->source, path))
        return failure_set(failure, NSD_USAGE, "%.200s: there is no object '%.100s'",
                           source_where(d->source), path);
    unsigned char *bytes = source_attributes(d->source, path, &size, failure);
    json_t *all = bytes ? json_object() : NULL;
    if (bytes && !all) objects_no_memory(failure);
    while (all && !failure->status && object_unpack(bytes, size, &at, &l)) {
        json_t *known = json_string(l.path);
        if (known && json_object_set_new(all, l.path, objects_values_of(&l)))
            objects_no_memory(failure);
        json_decref(known);
    }
    free(bytes);
    return put_json(d, all, json, failure);
}

/* ---- numbers and texts ---- */

/* The dataset of that path; NULL with the reason */
static const struct object *objects_find(const struct nsd_document *d, const char *path,
                                         const uint64_t **shape, struct failure *failure)
{
    const struct object *o;
    const char *is;
    for (int64_t k = 0; (o = source_object(d->source, k, &is, shape)); k++)
        if (!o->attribute && !strcmp(is, path)) break;
    if (!o || o->kind == OBJECT_GROUP)
        failure_set(failure, NSD_USAGE, "%.200s: there is no dataset '%.100s'",
                    source_where(d->source), path);
    return failure->status ? NULL : o;
}

/* How numbers of a dataset are handed out, without a loss: 'd', 'l' (int64_t), 'i', 'b' */
static char type_for(const struct object *o, enum column_type *type)
{
    const bool sign = o->class == 'i';
    const uint32_t size = o->size;
    *type = o->class == 'f'         ? COLUMN_F64
            : size < 2 && sign      ? COLUMN_I8
            : size < (sign ? 5 : 4) ? COLUMN_I32
                                    : COLUMN_I64;
    return *type == COLUMN_F64 ? 'd' : *type == COLUMN_I8 ? 'b' : *type == COLUMN_I32 ? 'i' : 'l';
}

int nsd_rows(struct nsd_document *d, const char *path, int64_t first, int64_t n,
             struct nsd_array *out)
{
    struct failure *failure = document_why(d, true);
    const uint64_t *shape = NULL;
    enum column_type type;
    if (!failure) return NSD_USAGE;
    if (!out || out->size < sizeof *out)
        return failure_set(failure, NSD_USAGE, "an array's size is not that of struct nsd_array");
    const struct object *o = path ? objects_find(d, path, &shape, failure) : NULL;
    if (!o) return path ? failure->status : failure_set(failure, NSD_USAGE, "a dataset has a path");
    const int64_t rows = o->rank && o->rank <= OBJECT_RANK ? (int64_t)shape[0] : 1;
    int64_t width = 1, bytes;
    bool large = rows < 0;
    for (uint32_t k = 1; k < o->rank && o->rank <= OBJECT_RANK; k++)
        large |= __builtin_mul_overflow(width, (int64_t)shape[k], &width) || width < 0;
    const char letter = type_for(o, &type);
    if (o->kind != OBJECT_NUMBERS || o->rank > OBJECT_RANK || large)
        return failure_set(failure, NSD_DATA, "%.200s: %.100s: no numbers that can be read",
                           source_where(d->source), path);
    if (first < 0 || n < 0 || n > rows || first > rows - n)
        return failure_set(
            failure, NSD_DATA, "%.200s: %.100s: it has %lld rows, not %lld from %lld",
            source_where(d->source), path, (long long)rows, (long long)n, (long long)first);
    if (__builtin_mul_overflow(n, width, &bytes) || bytes > INT64_MAX / 32)
        return objects_no_memory(failure);
    if (source_frame(d->source, failure)) return failure->status;
    void *data = calloc((size_t)bytes + 1, field_size(type));
    if (!data) return objects_no_memory(failure);
    const struct slab slab = { type, first, n, width };
    int e = 0;
    if (bytes && o->rank) e = source_rows(d->source, path, slab, data, failure);
    if (bytes && !o->rank) e = source_read(d->source, path, type, 1, data, failure);
    if (e) return free(data), e;
    free(d->data);
    d->data = data;
    const int64_t size = (int64_t)field_size(type);
    *out = (struct nsd_array){ .size = out->size,
                               .data = data,
                               .unit = "",
                               .shape = { n, width },
                               .stride = { size * width, size },
                               .rank = o->rank > 1 ? 2 : 1,
                               .type = letter };
    return 0;
}

int nsd_text(struct nsd_document *d, const char *path, const char **text)
{
    struct failure *failure = document_why(d, true);
    const uint64_t *shape = NULL;
    if (!failure) return NSD_USAGE;
    if (!path || !text)
        return failure_set(failure, NSD_USAGE, "a dataset has a path, and a text a place");
    const struct object *o = objects_find(d, path, &shape, failure);
    if (!o || source_frame(d->source, failure)) return failure->status;
    char *found = o->rank ? source_lines(d->source, path, failure)
                          : source_text(d->source, path, NULL, failure);
    if (!found && !failure->status)
        failure_set(failure, NSD_DATA, "%.200s: %.100s: no text", source_where(d->source), path);
    if (failure->status) return free(found), failure->status;
    free(d->text);
    *text = d->text = found;
    return 0;
}
