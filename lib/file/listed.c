#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): qsort_r
#include "file/listed.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int child_by_path(const void *one, const void *other, void *objects)
{
    const struct listed *l = objects, *a = &l[*(const int64_t *)one],
                        *b = &l[*(const int64_t *)other];
    int order = (int)a->object.attribute - (int)b->object.attribute;
    if (!order) order = strcmp(a->path, b->path);
    return order ? order : (a > b) - (a < b);
}

static int sort(struct list *s, struct failure *failure)
{
    if (!(s->sorted = malloc(((size_t)s->count + 1) * sizeof *s->sorted)))
        return failure_set(failure, EX_SOFTWARE, "no memory for a list of objects");
    for (int64_t k = 0; k < s->count; k++) s->sorted[k] = k;
    qsort_r(s->sorted, (size_t)s->count, sizeof *s->sorted, child_by_path, s->object);
    return 0;
}

int list_open(struct list *s, unsigned char *bytes, uint64_t size, struct failure *failure)
{
    int64_t room = 0;
    struct listed l;
    *s = (struct list){ .bytes = bytes };
    for (uint64_t at = 0; at < size; s->count++) {
        if (s->count == room) {
            room = room ? 2 * room : 128;
            struct listed *more = realloc(s->object, (size_t)room * sizeof *more);
            if (!more) return failure_set(failure, EX_SOFTWARE, "no memory for a list of objects");
            s->object = more;
        }
        if (!object_unpack(bytes, size, &at, &l))
            return failure_set(failure, EX_DATAERR, "no list of objects");
        s->object[s->count] = l;
    }
    return sort(s, failure);
}

void list_free(struct list *s)
{
    free(s->bytes), free(s->object), free(s->sorted);
    *s = (struct list){ 0 };
}

/* The one of this path, PATH@NAME of an attribute */
static const struct listed *child_find(const struct list *s, const char *path, bool attribute)
{
    for (int64_t lo = 0, hi = s->count; lo < hi;) {
        int64_t k = lo + (hi - lo) / 2;
        const struct listed *l = &s->object[s->sorted[k]];
        int order = attribute - (int)l->object.attribute;
        if (!order) order = strcmp(path, l->path);
        if (!order) return l;
        *(order > 0 ? &lo : &hi) = order > 0 ? k + 1 : k;
    }
    return NULL;
}

const struct listed *list_find(const struct list *s, const char *path)
{
    return child_find(s, path, false);
}

const struct listed *list_attribute(const struct list *s, const char *path, const char *name)
{
    char whole[OBJECT_PATH + OBJECT_NAME];
    snprintf(whole, sizeof whole, "%s@%s", path, name);
    const struct listed *l = child_find(s, whole, true);
    return l && l->object.data ? l : NULL;
}

/* Number k of what came with the list, as an integer and as a real. */
static void plain_number(const struct listed *l, uint64_t k, int64_t *i, double *x)
{
    const char *at = (const char *)l->data + k * l->object.size;
    bool minus = l->object.class == 'i' && (at[l->object.size - 1] & 0x80);
    *i = minus ? -1 : 0;
    if (l->object.class == 'f') {
        float f;
        memcpy(l->object.size == 4 ? (void *)&f : (void *)x, at, l->object.size);
        if (l->object.size == 4) *x = (double)f;
        return;
    }
    memcpy(i, at, l->object.size); // little-endian, as column_native is in the file
    *x = l->object.class == 'u' ? (double)(uint64_t)*i : (double)*i;
}

bool listed_numbers(const struct listed *l, uint64_t first, uint64_t n, enum column_type type,
                    void *out)
{
    const struct object *o = &l->object;
    if (o->kind != OBJECT_NUMBERS || (o->class == 'f' && type != COLUMN_F64)) return false;
    if (n > UINT64_MAX / 32 || first > UINT64_MAX / 32 || (first + n) * o->size > o->data)
        return false;
    if ((o->class == 'f' && o->size == 8) ||
        (o->class == 'i' && type != COLUMN_F64 && column_size(type) == o->size)) {
        memcpy(out, (const char *)l->data + first * o->size, n * o->size);
        return true;
    }
    for (uint64_t k = 0; k < n; k++) {
        int64_t i;
        double x;
        plain_number(l, first + k, &i, &x);
        if (type == COLUMN_F64) ((double *)out)[k] = x;
        if (type == COLUMN_F64) continue;
        bool fits = !(o->class == 'u' && i < 0);
        if (type == COLUMN_I32) fits = fits && i >= INT32_MIN && i <= INT32_MAX;
        if (type == COLUMN_I8) fits = fits && i >= INT8_MIN && i <= INT8_MAX;
        if (!fits) return false;
        memcpy((char *)out + k * column_size(type), &i, column_size(type));
    }
    return true;
}
