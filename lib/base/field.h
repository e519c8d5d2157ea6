/*
 * base/field.h: fields: the description of one member of a struct, a row of `width` numbers: its name and unit, its type,
 * where the struct has it, when a document has it, and what must be true of it. A table of fields describes a kind
 * of thing; it ends with a field without a name. What is done with all members of a struct, and not with one that the
 * code knows, loops over its table: copy, compare, check, read, write, send.
 */
#pragma once

#include "base/failure.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Types of numbers that nsd keeps in documents */
enum column_type { COLUMN_F64, COLUMN_I64, COLUMN_I32, COLUMN_I8 };

enum field_trait {
    FIELD_MOVES = 1,    /* each frame of a document has its values, */
    FIELD_SAME = 2,     /* or all frames of a trajectory have the same, which are written once, */
    FIELD_STEERED = 4,  /* except in frames that a program has steered, which have their own */
    FIELD_OPTIONAL = 8, /* a document may lack it: the array is NULL, or the numbers are 0 */
    FIELD_BY_SETTINGS = 16 /* the array exists where the packing has shapes, or a periodic cell */
};

/* What must be true of the numbers */
enum field_range {
    FIELD_ANY,
    FIELD_FINITE,
    FIELD_POSITIVE,     /* and finite */
    FIELD_NOT_NEGATIVE, /* and finite */
    FIELD_FRACTION,     /* 0 .. 1 */
    FIELD_FLAG,         /* 0 or 1 */
    FIELD_UNIT          /* three numbers, a unit vector */
};

struct field {
    const char *name, *units;
    enum column_type type;
    int width;     /* numbers in a row */
    size_t offset; /* in the struct: of the numbers, or of the pointer to them */
    unsigned traits;
    enum field_range range;
    /* Does a document have it, and the fields after it that have the same predicate? Of what the table belongs to: a
       packing, a report. NULL: it does; or, where it is optional, if any row is not 0. */
    bool (*when)(const void *of);
    const char *key; /* in JSON; NULL: the name */
};
/* FIELD(owner, member, type, width, name, units, traits, .range = ..., .when = ..., .key = ...) */
#define FIELD(owner, member, kind, wide, called, unit, ...)                                        \
    {                                                                                              \
        .name = (called), .units = (unit), .type = COLUMN_##kind, .width = (wide),                 \
        .offset = offsetof(owner, member), .traits = __VA_ARGS__                                   \
    }

/* In JSON, exports and the Python module */
static inline const char *field_key(const struct field *f)
{
    return f->key ? f->key : f->name;
}
static inline size_t field_size(enum column_type t)
{
    return t == COLUMN_I8 ? 1 : t == COLUMN_I32 ? 4 : 8;
}
/* Bytes of a row */
static inline size_t field_bytes(const struct field *f)
{
    return (size_t)f->width * field_size(f->type);
}

/* The array that the struct's member of this field points to, and another one in its place */
void *field_array(const struct field *field, const void *structure);
void field_set_array(const struct field *field, void *structure, void *array);
/* The address of row i of that array */
void *field_row(const struct field *field, const void *structure, int64_t i);

/* n structs, and the fields that they have */
struct records {
    const struct field *fields;
    int64_t n;
    void *structs;
    size_t stride;  /* bytes of a struct */
    const void *of; /* what field->when asks; NULL: what is read tells whether it has a field */
};
#define RECORDS_OF(of, fields, n, structs)                                                         \
    ((struct records){ (fields), (n), (void *)(structs), sizeof *(structs), (of) })
#define RECORDS(fields, n, structs) RECORDS_OF(NULL, fields, n, structs)

/* A field's numbers out of an array of n structs, and back into one. */
void field_gather(const struct field *field, int64_t n, const void *structs, size_t stride,
                  void *out);
void field_scatter(const struct field *field, int64_t n, const void *in, void *structs,
                   size_t stride);

/* What is wrong with the numbers at x, of one row, or NULL: "must be positive and finite" */
const char *field_trouble(const struct field *field, const void *x);
/* Is nothing wrong with n rows, one after another? Fast; field_trouble() says what. */
bool field_fits(const struct field *field, const void *rows, int64_t n);
/* The same of structs: EX_DATAERR with the first row and field that has trouble: "WHAT 3: name must be ..." */
int records_check(struct records records, const char *what, struct failure *failure);
/* Are the rows at x and y the same numbers? No number is the same as no number. */
bool field_equal(const struct field *field, const void *x, const void *y);
/* Has a document that is written the field of these records? */
bool field_is_kept(const struct field *field, const struct records *records);
