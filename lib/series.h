/*
 * series.h: the datasets of a document that is written: those of one frame, each whole at once, or
 * those that grow frame by frame.
 */
#ifndef NSD_SERIES_H
#define NSD_SERIES_H

#include "layout.h"

enum { SERIES = 64, CHUNK_FRAMES = 64, CHUNK_CONTACTS = 256, CHUNK_BODIES = 8192 };

struct series {
    hid_t file;
    bool growing;
    struct {
        char path[80];
        hid_t set;
    } open[SERIES]; /* those that grow are kept open */
    int count;
    int64_t contacts; /* rows of /contacts so far */
};

/*
 * shape[0] rows of data: a dataset of their own or, where the file grows, at the end of what is
 * there, in chunks of chunk_rows.
 */
int series_put(struct series *, const char *path, enum column_type, int rank, const hsize_t *shape,
               hsize_t chunk_rows, const void *data, const char *units, struct why *);

/* Does it grow already? Asked instead of the file, which would have to look the path up. */
bool series_grows(const struct series *, const char *path);

/* All of a table's columns out of n structs, `tail` behind their names, at `where`. */
int series_put_columns(struct series *, const char *where, const char *tail, const struct column *,
                       int64_t n, const void *structs, size_t stride, hsize_t chunk_rows,
                       struct why *);

/* Returns 0, or -1 where something could not be written. The file stays open. */
int series_close(struct series *);

#endif
