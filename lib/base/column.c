#include "base/column.h"

#include <string.h>

void *column_array(const struct column *c, const void *structure)
{
    void *array;
    memcpy(&array, (const char *)structure + c->offset, sizeof array);
    return array;
}

void column_set_array(const struct column *c, void *structure, void *array)
{
    memcpy((char *)structure + c->offset, &array, sizeof array);
}

void *column_row(const struct column *c, const void *structure, int64_t i)
{
    return (char *)column_array(c, structure) + (size_t)i * column_bytes(c);
}

void column_gather(const struct column *c, int64_t n, const void *structs, size_t stride, void *out)
{
    size_t bytes = column_bytes(c);
    const char *from = (const char *)structs + c->offset;
    for (int64_t i = 0; i < n; i++) memcpy((char *)out + bytes * i, from + stride * i, bytes);
}

void column_scatter(const struct column *c, int64_t n, const void *in, void *structs, size_t stride)
{
    size_t bytes = column_bytes(c);
    char *to = (char *)structs + c->offset;
    for (int64_t i = 0; i < n; i++) memcpy(to + stride * i, (const char *)in + bytes * i, bytes);
}
