/* scene/mesh_bytes.h: numbers of binary files, of either byte order. */
#ifndef NSD_MESH_BYTES_H
#define NSD_MESH_BYTES_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum bytes_type {
    BYTES_I8,
    BYTES_U8,
    BYTES_I16,
    BYTES_U16,
    BYTES_I32,
    BYTES_U32,
    BYTES_F32,
    BYTES_F64,
    BYTES_TYPES
};
static const uint8_t bytes_size[BYTES_TYPES] = { 1, 1, 2, 2, 4, 4, 4, 8 };

/* Exact: a double has them all. */
static inline double bytes_number(const void *at, enum bytes_type type, bool big_endian)
{
    const unsigned char *byte = at;
    uint64_t bits = 0;
    float f;
    double d;
    for (int k = 0, n = bytes_size[type]; k < n; k++)
        bits |= (uint64_t)byte[big_endian ? n - 1 - k : k] << 8 * k;
    uint32_t low = (uint32_t)bits;
    memcpy(&f, &low, sizeof f), memcpy(&d, &bits, sizeof d);
    switch (type) {
    case BYTES_I8:
        return (int8_t)bits;
    case BYTES_I16:
        return (int16_t)bits;
    case BYTES_I32:
        return (int32_t)bits;
    case BYTES_F32:
        return (double)f;
    case BYTES_F64:
        return d;
    default:
        return (double)bits;
    }
}

#endif
