#include "file/source.h"

#include "file/child.h"
#include "file/serve.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    LARGE = 1 << 26 /* bytes of a document worth giving back early, as in file/stream.c */
};

struct source {
    struct child *child; /* NULL: the file is our own */
    struct served own;
    char where[300], name[300];
    struct list list;     /* the document's objects */
    struct budget budget; /* of the document */
    bool large;           /* the document takes memory that is worth giving back */
};

static uint64_t limit;

void source_limit(uint64_t bytes)
{
    limit = bytes;
}

int source_open(struct source **out, int files, char *const *file, struct failure *failure)
{
    struct source *s = *out = calloc(1, sizeof *s);
    if (!s) return failure_set(failure, EX_SOFTWARE, "no memory");
    s->own.file = -1;
    return child_start(&s->child, files, file, limit, failure);
}

void source_close(struct source *s)
{
    if (!s) return;
    child_close(s->child);
    if (!s->child && (s->own.count || s->own.sorted)) s->own.file = -1, served_close(&s->own);
    list_free(&s->list);
    free(s);
}

const char *source_where(const struct source *s)
{
    return s->where;
}

static int source_ask(struct source *s, const struct request *q, struct taker *t,
                      struct failure *failure)
{
    void *given = t->out;
    int e;
    t->budget = s->child && q->op != REQUEST_NEXT ? &s->budget : NULL;
    taker_start(t, failure);
    if (!s->child)
        e = serve_answer(&s->own, q, &t->sink, failure);
    else if (child_lost(s->child))
        e = failure_set(failure, EX_DATAERR, "%s: no longer read", s->where);
    else
        e = child_ask(s->child, q, t, failure);
    if (e || failure->status) {
        if (!given) free(t->out), t->out = NULL;
        return failure->status ? failure->status : failure_set(failure, EX_SOFTWARE, "no answer");
    }
    return 0;
}

int source_of_own(struct source **out, hid_t file, struct failure *failure)
{
    struct source *s = *out = calloc(1, sizeof *s);
    size_t size = 0;
    hsize_t length = 0;
    if (!s) return failure_set(failure, EX_SOFTWARE, "no memory");
    s->own.file = -1;
    if (file < 0) return failure_set(failure, EX_DATAERR, "not a readable HDF5 file");
    H5Fget_filesize(file, &length);
    if (served_open(&s->own, file, length, limit, failure)) return failure->status;
    void *objects = serve_objects(&s->own, &size, failure);
    return objects ? list_open(&s->list, objects, size, failure) : failure->status;
}

int source_next(struct source *s, struct source_document *d, bool *more, struct failure *failure)
{
    struct request q = request_of(REQUEST_NEXT, "");
    struct taker t = { 0 };
    list_free(&s->list);
    *more = false;
    if (source_ask(s, &q, &t, failure)) return failure->status;
    if (!t.reply.there) return free(t.out), 0;
    snprintf(s->name, sizeof s->name, "%.290s", t.reply.text);
    snprintf(s->where, sizeof s->where, t.reply.number > 1 ? "%.250s: document %lld" : "%.250s",
             s->name, (long long)t.reply.number);
    *d = (struct source_document){ s->name,          t.reply.number,
                                   t.reply.foreign,  t.reply.unfinished,
                                   t.reply.document, t.reply.plain };
    *more = true;
    budget_open(&s->budget, t.reply.document, limit);
    s->large = t.reply.document > LARGE;
    return list_open(&s->list, t.out, t.size, failure);
}

bool source_has(const struct source *s, const char *path)
{
    return list_find(&s->list, path);
}

int source_shape(const struct source *s, const char *path, uint64_t shape[4])
{
    const struct listed *l = list_find(&s->list, path);
    if (!l || l->object.kind == OBJECT_GROUP || l->object.rank > 4) return -1;
    for (uint32_t k = 0; k < l->object.rank; k++) shape[k] = l->shape[k];
    return (int)l->object.rank;
}

const struct object *source_object(const struct source *s, int64_t k, const char **path,
                                   const uint64_t **shape)
{
    if (k >= s->list.count) return NULL;
    *path = s->list.object[k].path, *shape = s->list.object[k].shape;
    return &s->list.object[k].object;
}

int source_draw(struct source *s, uint64_t work, struct failure *failure)
{
    return s->child ? budget_draw(&s->budget, work, failure) : 0;
}

int source_frame(struct source *s, struct failure *failure)
{
    return s->child ? budget_frame(&s->budget, failure) : 0;
}

/* ---- requests ---- */

int source_unload(struct source *s, struct failure *failure)
{
    struct request q = request_of(REQUEST_UNLOAD, "");
    struct taker t = { .out = &q };
    return s->child && s->large ? source_ask(s, &q, &t, failure) : 0;
}

int source_release(struct source *s, struct failure *failure)
{
    struct request q = request_of(REQUEST_RELEASE, "");
    struct taker t = { .out = &q };
    list_free(&s->list);
    return s->child && s->large ? source_ask(s, &q, &t, failure) : 0;
}

int source_pour(struct source *s, source_sink pour, void *to, struct failure *failure)
{
    struct request q = request_of(REQUEST_IMAGE, "");
    struct taker t = { .pour = pour, .out = to };
    return source_ask(s, &q, &t, failure);
}

int source_rows(struct source *s, const char *path, struct slab rows, void *out,
                struct failure *failure)
{
    const enum column_type type = rows.type;
    const int64_t start = rows.start, n = rows.n, width = rows.width;
    struct request q = request_of(REQUEST_ROWS, path);
    struct taker t = { .out = out, .size = (uint64_t)(n * width) * field_size(type) };
    if (!t.size) t.out = &q; // nothing is written there
    const struct listed *l = list_find(&s->list, path);
    if (l && l->object.data && l->object.rank && start >= 0 && n >= 0 && width > 0) {
        uint64_t row = 1;
        for (uint32_t k = 1; k < l->object.rank; k++) row *= l->shape[k];
        if (row == (uint64_t)width && (uint64_t)start + (uint64_t)n <= l->shape[0] &&
            listed_numbers(l, (uint64_t)(start * width), (uint64_t)(n * width), type, out))
            return source_draw(s, t.size, failure);
    }
    q.type = type, q.start = start, q.n = n, q.width = width;
    return source_ask(s, &q, &t, failure);
}

int source_part(struct source *s, const char *path, int64_t row, struct slab rows, void *out,
                struct failure *failure)
{
    const enum column_type type = rows.type;
    const int64_t first = rows.start, n = rows.n, width = rows.width;
    struct request q = request_of(REQUEST_PART, path);
    struct taker t = { .out = out, .size = (uint64_t)(n * width) * field_size(type) };
    if (!t.size) t.out = &q; // nothing is written there
    const struct listed *l = list_find(&s->list, path);
    if (l && l->object.data && l->object.rank >= 2 && row >= 0 && first >= 0 && n >= 0) {
        uint64_t numbers = 1;
        for (uint32_t k = 2; k < l->object.rank; k++) numbers *= l->shape[k];
        uint64_t before = (uint64_t)row * l->shape[1] + (uint64_t)first;
        if (numbers == (uint64_t)width && (uint64_t)row < l->shape[0] &&
            (uint64_t)first + (uint64_t)n <= l->shape[1] &&
            listed_numbers(l, before * numbers, (uint64_t)n * numbers, type, out))
            return source_draw(s, t.size, failure);
    }
    q.type = type, q.start = row, q.from = first, q.n = n, q.width = width;
    return source_ask(s, &q, &t, failure);
}

void *source_read_all(struct source *s, const char *path, enum column_type type, uint64_t *count,
                      struct failure *failure)
{
    struct request q = request_of(REQUEST_ROWS, path);
    struct taker t = { 0 };
    q.type = type, q.n = -1;
    *count = 0;
    const struct listed *l = list_find(&s->list, path);
    if (l && l->object.data && l->object.size) {
        uint64_t n = l->object.data / l->object.size;
        if (source_draw(s, 8 * n, failure)) return NULL;
        void *out = calloc(n + 1, 8);
        if (!out) return failure_set(failure, EX_SOFTWARE, "%s: no memory", path), NULL;
        *count = n;
        if (listed_numbers(l, 0, n, type, out)) return out;
        free(out);
        *count = 0;
    }
    if (source_ask(s, &q, &t, failure)) return NULL;
    *count = t.size / field_size(type);
    return t.out;
}

int source_read(struct source *s, const char *path, enum column_type type, uint64_t count,
                void *out, struct failure *failure)
{
    uint64_t found;
    void *data = source_read_all(s, path, type, &found, failure);
    if (!data) return failure->status;
    if (found == count)
        memcpy(out, data, (size_t)count * field_size(type));
    else
        failure_set(failure, EX_DATAERR, "%s: %llu values, %llu are needed", path,
                    (unsigned long long)found, (unsigned long long)count);
    free(data);
    return failure->status;
}

char *source_text(struct source *s, const char *path, const char *name, struct failure *failure)
{
    struct request q = request_of(REQUEST_TEXT, path);
    struct taker t = { 0 };
    const struct listed *l =
        name ? list_attribute(&s->list, path, name) : list_find(&s->list, path);
    if (!name && !l) return NULL;
    if (l && l->object.kind == OBJECT_TEXT && !l->object.rank && l->object.data) {
        if (source_draw(s, l->object.data, failure)) return NULL;
        char *text = strndup(l->data, l->object.data);
        if (!text) failure_set(failure, EX_SOFTWARE, "%s: no memory", path);
        return text;
    }
    if (name) snprintf(q.name, sizeof q.name, "%s", name);
    if (source_ask(s, &q, &t, failure)) return NULL;
    if (!t.reply.there) free(t.out), t.out = NULL;
    return t.out;
}

char *source_lines(struct source *s, const char *path, struct failure *failure)
{
    struct request q = request_of(REQUEST_TEXT, path);
    struct taker t = { 0 };
    q.n = 1;
    if (!list_find(&s->list, path) || source_ask(s, &q, &t, failure)) return NULL;
    if (!t.reply.there) free(t.out), t.out = NULL;
    return t.out;
}

int source_attribute(struct source *s, const char *path, const char *name, struct numbers numbers,
                     struct failure *failure)
{
    struct request q = request_of(REQUEST_ATTRIBUTE, path);
    uint64_t n = numbers.count < 0 ? 1 : (uint64_t)numbers.count;
    struct taker t = { .out = numbers.to, .size = n * field_size(numbers.type) };
    q.type = numbers.type, q.n = numbers.count;
    const struct listed *l = list_attribute(&s->list, path, name);
    if (l && l->object.size && l->object.data / l->object.size == n &&
        listed_numbers(l, 0, n, numbers.type, numbers.to))
        return 0;
    snprintf(q.name, sizeof q.name, "%s", name);
    return source_ask(s, &q, &t, failure);
}

/* Cut into strings; false where it is something else. */
static bool cut_texts(const struct listed *l, int count, char out[][16])
{
    const struct object *o = &l->object;
    if (o->kind != OBJECT_TEXT || o->rank != 1 || l->shape[0] != (uint64_t)count || !o->size ||
        o->data != l->shape[0] * o->size)
        return false;
    for (int k = 0; k < count; k++)
        snprintf(out[k], sizeof out[k], "%.*s", (int)(o->size < 15 ? o->size : 15),
                 (const char *)l->data + (size_t)k * o->size);
    return true;
}

bool source_texts(struct source *s, const char *path, const char *name, int count, char out[][16],
                  struct failure *failure)
{
    const struct listed *known = list_attribute(&s->list, path, name);
    if (known) return cut_texts(known, count, out);
    if (!list_find(&s->list, path)) return false;
    uint64_t size = 0, at = 0;
    struct listed l;
    bool there = false;
    unsigned char *bytes =
        source_attributes(s, path, &size, failure); // the list was too long for it
    while (bytes && object_unpack(bytes, size, &at, &l))
        if (!strcmp(l.path, name)) there = cut_texts(&l, count, out);
    free(bytes);
    return there;
}

void *source_raw(struct source *s, const char *path, uint64_t *size, struct failure *failure)
{
    struct request q = request_of(REQUEST_RAW, path);
    struct taker t = { 0 };
    if (source_ask(s, &q, &t, failure)) return NULL;
    *size = t.size;
    return t.out;
}

void *source_attributes(struct source *s, const char *path, uint64_t *size, struct failure *failure)
{
    struct request q = request_of(REQUEST_ATTRIBUTES, path);
    struct taker t = { 0 };
    if (source_ask(s, &q, &t, failure)) return NULL;
    *size = t.size;
    return t.out;
}
