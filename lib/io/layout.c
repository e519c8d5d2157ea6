#include "io/layout.h"

#include <string.h>

void *column_array(const struct column *c, const void *structure)
{
    void *array;
    memcpy(&array, (const char *)structure + c->offset, sizeof array);
    return array;
}

void column_gather(const struct column *c, int64_t n, const void *structs, size_t stride, void *out)
{
    size_t bytes = (size_t)c->width * column_size(c->type);
    const char *from = (const char *)structs + c->offset;
    for (int64_t i = 0; i < n; i++) memcpy((char *)out + bytes * i, from + stride * i, bytes);
}

void column_scatter(const struct column *c, int64_t n, const void *in, void *structs, size_t stride)
{
    size_t bytes = (size_t)c->width * column_size(c->type);
    char *to = (char *)structs + c->offset;
    for (int64_t i = 0; i < n; i++) memcpy(to + stride * i, (const char *)in + bytes * i, bytes);
}
