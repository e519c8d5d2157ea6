/*
 * file/h5.h: what nsd asks of libhdf5 to write single objects (datasets, texts, groups, attributes),
 * each failure with its reason; file/serve.h reads them. No other room knows HDF5. Object times are
 * never stored, so that the same data give the same bytes.
 *
 * `place` is an open file or group and `path` a name in it.
 */
#pragma once

#include "base/failure.h"
#include "base/field.h"
#include "file/object.h"

#include <hdf5.h>
#include <stdbool.h>
#include <string.h>

static inline hid_t column_native(enum column_type t)
{
    return t == COLUMN_F64   ? H5T_NATIVE_DOUBLE
           : t == COLUMN_I64 ? H5T_NATIVE_INT64
           : t == COLUMN_I32 ? H5T_NATIVE_INT32
                             : H5T_NATIVE_INT8;
}

/* The type of memory for plain numbers: class 'i' signed, 'u' unsigned, 'f' real, of size bytes. */
hid_t h5_plain(char class, size_t size);

/* Called in each thread before anything else of libhdf5: it shall print nothing, and close nothing by itself. */
void h5_start(void);

bool h5_has(hid_t place, const char *path);

/* What is written */
struct h5_data {
    hid_t type; /* of memory, such as H5T_NATIVE_DOUBLE */
    int rank;   /* 0: a scalar */
    hsize_t shape[OBJECT_RANK];
    const void *at;
};

static inline struct h5_data h5_scalar(hid_t type, const void *at)
{
    return (struct h5_data){ .type = type, .at = at };
}
static inline struct h5_data h5_vector(hid_t type, hsize_t n, const void *at)
{
    return (struct h5_data){ .type = type, .rank = 1, .shape = { n }, .at = at };
}
/* Of any shape[rank]; HDF5 refuses the rank -1, which stands for one that is too large. */
static inline struct h5_data h5_array(hid_t type, int rank, const hsize_t *shape, const void *at)
{
    struct h5_data d = { .type = type, .rank = rank <= OBJECT_RANK ? rank : -1, .at = at };
    if (d.rank > 0) memcpy(d.shape, shape, (size_t)d.rank * sizeof *shape);
    return d;
}

/* A new dataset of fixed shape, little-endian on disk, with @units unless that is NULL. data.at NULL: room is
   made for the numbers, and nothing is written there. */
int h5_write(hid_t place, const char *path, struct h5_data data, const char *units,
             struct failure *failure);
int h5_write_text(hid_t place, const char *path, const char *text, struct failure *failure);
/* Makes the group, and those above it, unless it is there. */
int h5_group(hid_t place, const char *path, struct failure *failure);

/* An attribute, in place of one of this name */
int h5_attr(hid_t place, const char *path, const char *name, struct h5_data data,
            struct failure *failure);
/* A text; EX_DATAERR: longer than HDF5 has room for */
int h5_attr_text(hid_t place, const char *path, const char *name, const char *text,
                 struct failure *failure);

/* A property list for new datasets, without object times. To be closed. */
hid_t h5_dataset_plist(void);
/* Datasets with this list get all of their place on the disk as they are made, or grow, and nothing into it. */
void h5_fill_later(hid_t plist);
