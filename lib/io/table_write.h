/*
 * io/table_write.h: the datasets of a document that is written: those of one frame, each whole at once, or
 * those that grow frame by frame.
 */
#ifndef NSD_TABLE_WRITE_H
#define NSD_TABLE_WRITE_H

#include "io/layout.h"

enum { SERIES = 64, CHUNK_FRAMES = 64, CHUNK_CONTACTS = 256, CHUNK_BODIES = 8192 };

struct table_write {
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
int table_write_rows(struct table_write *, const char *path, enum column_type, int rank,
                     const hsize_t *shape, hsize_t chunk_rows, const void *data, const char *units,
                     struct why *);

/* Does it grow already? Asked instead of the file, which would have to look the path up. */
bool table_write_grows(const struct table_write *, const char *path);

/* All of a table's columns out of n structs, `tail` behind their names, at `where`. */
int table_write_columns(struct table_write *, const char *where, const char *tail,
                        const struct column *, int64_t n, const void *structs, size_t stride,
                        hsize_t chunk_rows, struct why *);

/* Returns 0, or -1 where something could not be written. The file stays open. */
int table_write_close(struct table_write *);

#endif
