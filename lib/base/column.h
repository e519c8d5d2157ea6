/*
 * base/column.h: columns: numbers of many things of one kind, a row of `width` numbers for each. A table of
 * columns says where a struct has them and what they are called in documents; it ends with a column without
 * a name.
 */
#ifndef NSD_COLUMN_H
#define NSD_COLUMN_H

#include <stddef.h>
#include <stdint.h>

/* Types of numbers that nsd keeps in documents */
enum column_type { COLUMN_F64, COLUMN_I64, COLUMN_I32, COLUMN_I8 };

struct column {
    const char *name, *units;
    enum column_type type;
    int width;     /* numbers in a row */
    size_t offset; /* in the struct: of the numbers, or of the pointer to them */
};

static inline size_t column_size(enum column_type t)
{
    return t == COLUMN_I8 ? 1 : t == COLUMN_I32 ? 4 : 8;
}
/* Bytes of a row */
static inline size_t column_bytes(const struct column *c)
{
    return (size_t)c->width * column_size(c->type);
}

/* The array that the struct's member of this column points to, and another one in its place */
void *column_array(const struct column *column, const void *structure);
void column_set_array(const struct column *column, void *structure, void *array);
/* The address of row i of that array */
void *column_row(const struct column *column, const void *structure, int64_t i);

/* n structs, and the columns that they have */
struct records {
    const struct column *columns;
    int64_t n;
    void *structs;
    size_t stride; /* bytes of a struct */
};
#define RECORDS(columns, n, structs)                                                               \
    ((struct records){ (columns), (n), (void *)(structs), sizeof *(structs) })

/* A column's numbers out of an array of n structs, and back into one. */
void column_gather(const struct column *column, int64_t n, const void *structs, size_t stride,
                   void *out);
void column_scatter(const struct column *column, int64_t n, const void *in, void *structs,
                    size_t stride);

#endif
