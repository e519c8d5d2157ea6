#include "file/object.h"

#include <stdlib.h>
#include <string.h>

static uint64_t padded(uint64_t size)
{
    return (size + 7) / 8 * 8;
}

static unsigned char *put_object(unsigned char *to, const struct object *o, const void *shape,
                                 const char *name)
{
    size_t rank = o->rank > OBJECT_RANK ? 0 : o->rank;
    memcpy(to, o, sizeof *o), to += padded(sizeof *o);
    memcpy(to, shape, rank * sizeof(uint64_t)), to += rank * sizeof(uint64_t);
    memcpy(to, name, o->name), to += padded(o->name);
    return to;
}

static size_t object_size(const struct object *o)
{
    return padded(sizeof *o) + (o->rank > OBJECT_RANK ? 0 : o->rank) * sizeof(uint64_t) +
           padded(o->name);
}

int objects_add(struct objects *to, const struct object *o, const void *shape, const char *name,
                const void *data, struct failure *failure)
{
    size_t size = object_size(o) + padded(o->data);
    if (!to->bytes || to->size + size > to->room) {
        size_t room = 2 * to->room + size + 4096;
        unsigned char *more = realloc(to->bytes, room);
        if (!more) return failure_set(failure, EX_SOFTWARE, "no memory for a list of objects");
        to->bytes = more, to->room = room;
    }
    memset(to->bytes + to->size, 0, size);
    unsigned char *at = put_object(to->bytes + to->size, o, shape, name);
    if (o->data && data) memcpy(at, data, o->data);
    to->size += size;
    return 0;
}

/* Is it one that we may take numbers of? The process that sends it has met hostile bytes. */
static bool makes_sense(const struct object *o)
{
    bool power = o->size == 1 || o->size == 2 || o->size == 4 || o->size == 8;
    if (o->kind != OBJECT_NUMBERS) return o->kind <= OBJECT_OTHER && o->rank <= OBJECT_RANK + 1;
    return power && (o->class == 'i' || o->class == 'u' || (o->class == 'f' && o->size >= 4)) &&
           o->rank <= OBJECT_RANK + 1;
}

bool object_unpack(const unsigned char *bytes, uint64_t size, uint64_t *at, struct listed *to)
{
    struct object *o = &to->object;
    if (size - *at < padded(sizeof *o)) return false;
    memcpy(o, bytes + *at, sizeof *o);
    if (!makes_sense(o)) return false;
    uint64_t left = size - *at - padded(sizeof *o), rank = o->rank > OBJECT_RANK ? 0 : o->rank;
    uint64_t shapes = rank * sizeof *to->shape;
    if (shapes > left || padded(o->name) > left - shapes || !o->name || o->data > left ||
        padded(o->data) > left - shapes - padded(o->name))
        return false;
    const unsigned char *p = bytes + *at + padded(sizeof *o);
    to->shape = (const uint64_t *)(const void *)p; // all is padded to 8 bytes
    to->path = (const char *)p + shapes;
    to->data = p + shapes + padded(o->name);
    *at += padded(sizeof *o) + shapes + padded(o->name) + padded(o->data);
    return to->path[o->name - 1] == 0;
}
