/*
 * file/object.h: an object of a document, told in plain numbers and names: what two processes know of it,
 * one of which asks libhdf5 (file/serve.h) and one does not (file/source.h); and sequences of them.
 */
#pragma once

#include "base/failure.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    OBJECT_RANK = 8,   /* most dimensions of a dataset that can be copied */
    OBJECT_PATH = 400, /* bytes of a path, its zero included */
    OBJECT_NAME = 256  /* bytes of an attribute's name */
};

/*
 * An object or an attribute, in a sequence of bytes: this, shape[rank], the name with its zero, and
 * data; each padded to 8 bytes.
 */
struct object {
    enum { OBJECT_GROUP, OBJECT_NUMBERS, OBJECT_TEXT, OBJECT_OTHER } kind;
    char class;     /* 'i' signed, 'u' unsigned, 'f' real, 's' string */
    uint32_t size;  /* bytes of an element */
    uint32_t rank;  /* 0: a scalar; OBJECT_RANK + 1: more than can be copied */
    uint32_t name;  /* bytes of the name, zero included */
    bool attribute; /* of a group, under the name "group@name" */
    uint64_t data;  /* bytes of data behind it; 0 where they are to be asked for */
};

/* One of a sequence, whose bytes are borrowed */
struct listed {
    struct object object;
    const uint64_t *shape; /* [object.rank] */
    const char *path;      /* of an attribute its name, in a list of objects "path@name" */
    const void *data;      /* [object.data] bytes, where they have come along */
};

/* A sequence of objects that grows; bytes to be freed */
struct objects {
    unsigned char *bytes;
    size_t size, room;
};

/* One more at the end: shape[rank] numbers of 8 bytes, and o->data bytes of data or NULL for zeros. */
int objects_add(struct objects *objects, const struct object *object, const void *shape,
                const char *name, const void *data, struct failure *failure);

/* The object at bytes[*at] of such a sequence; *at moves behind it. False at the end, and where the bytes are no such
   object. */
bool object_unpack(const unsigned char *bytes, uint64_t size, uint64_t *at, struct listed *to);
