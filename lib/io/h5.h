/*
 * io/h5.h: the few things that the documents (doc, recall, rows, record, series, copy, sink) and fclib
 * ask of libhdf5, with failures as reasons; nobody else knows HDF5. Object times are never stored, so
 * that the same data are the same bytes.
 */
#ifndef NSD_H5_H
#define NSD_H5_H

#include "base/why.h"

#include <hdf5.h>
#include <stdbool.h>

/* Once, before anything else of libhdf5: silence its error stack, leave closing to us. */
void h5_start(void);

bool h5_has(hid_t place, const char *path);

/* The dataset's shape, at most 4 deep. Returns its rank or -1. */
int h5_shape(hid_t place, const char *path, hsize_t shape[4]);

/*
 * A whole dataset of exactly `count` values into out, converted to `type` (H5T_NATIVE_DOUBLE, ...).
 * EX_DATAERR names the path when it is missing, of another class (numbers are wanted) or size.
 */
int h5_read(hid_t place, const char *path, hid_t type, hsize_t count, void *out, struct why *);
/* The same into fresh memory of any size; *count tells it. NULL on failure. */
void *h5_read_all(hid_t place, const char *path, hid_t type, hsize_t *count, struct why *);
/*
 * A dataset of numbers or a text with attributes that are the same, made again at `path` of `to`;
 * what is anything else stays away. For files that no checksum vouches for: where one is damaged,
 * H5Ocopy of libhdf5 1.10 crashes.
 */
int h5_copy_plain(hid_t from, const char *name, hid_t to, const char *path, struct why *);
/* A scalar string dataset, or the attribute "path@name" ("@name"); NULL without it. To be freed. */
char *h5_read_text(hid_t place, const char *path);

/* A new dataset of fixed shape, little-endian on disk (`type` native), with @units unless NULL. */
int h5_write(hid_t place, const char *path, hid_t type, int rank, const hsize_t *shape,
             const void *data, const char *units, struct why *);
int h5_write_text(hid_t place, const char *path, const char *text, struct why *);
int h5_group(hid_t place, const char *path, struct why *); /* made if it is not there */

/* Attributes: count < 0 writes a scalar. */
int h5_attr(hid_t place, const char *path, const char *name, hid_t type, int count, const void *,
            struct why *);
int h5_attr_text(hid_t place, const char *path, const char *name, const char *text, struct why *);
int h5_attr_read(hid_t place, const char *path, const char *name, hid_t type, int count, void *,
                 struct why *);

/* Creation property lists without object times. */
hid_t h5_dataset_plist(void);

#endif
