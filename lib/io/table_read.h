/*
 * io/table_read.h: rows of the datasets of a document that is read: the inverse of io/table_write.h. A dataset once
 * opened stays open, for the next frame is read from it too.
 */
#ifndef NSD_TABLE_READ_H
#define NSD_TABLE_READ_H

#include "io/layout.h"

enum { ROWS = 64 };

struct table_read {
    hid_t file;
    struct {
        char path[80];
        hid_t set;
        int rank;
        hsize_t shape[4];
    } open[ROWS];
    int count;
};

/*
 * Rows start .. start+n-1 of a dataset whose rows, of any further shape, are `width` numbers, converted
 * to the column type. Returns 0, EX_DATAERR or EX_SOFTWARE.
 */
int table_read_rows(struct table_read *, const char *path, enum column_type, int64_t start,
                    int64_t n, int64_t width, void *out, struct why *);

/* The same of all of a table's columns at `where`, `tail` behind their names, into n structs. */
int table_read_columns(struct table_read *, const char *where, const char *tail,
                       const struct column *, int64_t start, int64_t n, void *structs,
                       size_t stride, struct why *);

/* The file stays open. */
void table_read_close(struct table_read *);

#endif
