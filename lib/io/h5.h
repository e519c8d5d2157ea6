/*
 * io/h5.h: everything that nsd asks of libhdf5 about single objects (datasets, texts, groups,
 * attributes), each failure with its reason. The other modules of io/ use it; no other room knows
 * HDF5. Object times are never stored, so that the same data give the same bytes.
 *
 * `place` is an open file or group and `path` a name in it. `type` is a type of memory, such as
 * H5T_NATIVE_DOUBLE.
 */
#ifndef NSD_H5_H
#define NSD_H5_H

#include "base/why.h"

#include <hdf5.h>
#include <stdbool.h>

/* Called before anything else of libhdf5: it shall print nothing, and close nothing by itself. */
void h5_start(void);

bool h5_has(hid_t place, const char *path);

/* The shape of a dataset of at most 4 dimensions. Returns its rank, or -1. */
int h5_shape(hid_t place, const char *path, hsize_t shape[4]);

/*
 * Reads a whole dataset of exactly `count` numbers, converted to `type`, into out. EX_DATAERR, with
 * the path, where it is missing, has another size or holds something other than numbers.
 */
int h5_read(hid_t place, const char *path, hid_t type, hsize_t count, void *out, struct why *why);
/* The same for any size, told in *count. Returns memory to be freed, or NULL on failure. */
void *h5_read_all(hid_t place, const char *path, hid_t type, hsize_t *count, struct why *why);
/*
 * Makes a dataset of numbers or text, with its attributes, again at `path` of `to`. What is neither
 * number nor text is left out. This is for files that no checksum vouches for: H5Ocopy of libhdf5
 * 1.10 crashes on damaged ones.
 */
int h5_copy_plain(hid_t from, const char *name, hid_t to, const char *path, struct why *why);
/* A scalar string: a dataset, or the attribute "path@name" or "@name". To be freed; NULL: none. */
char *h5_read_text(hid_t place, const char *path);

/* A new dataset of fixed shape, little-endian on disk, with @units unless that is NULL. */
int h5_write(hid_t place, const char *path, hid_t type, int rank, const hsize_t *shape,
             const void *data, const char *units, struct why *why);
int h5_write_text(hid_t place, const char *path, const char *text, struct why *why);
/* Makes the group, and those above it, unless it is there. */
int h5_group(hid_t place, const char *path, struct why *why);

/* Attributes of `count` numbers; count < 0 stands for a scalar. */
int h5_attr(hid_t place, const char *path, const char *name, hid_t type, int count,
            const void *data, struct why *why);
int h5_attr_text(hid_t place, const char *path, const char *name, const char *text,
                 struct why *why);
int h5_attr_read(hid_t place, const char *path, const char *name, hid_t type, int count, void *out,
                 struct why *why);

/* A property list for new datasets, without object times. To be closed. */
hid_t h5_dataset_plist(void);

#endif
