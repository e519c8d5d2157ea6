/*
 * rows.h: rows of the datasets of a document that is read: the inverse of series.h. A dataset once
 * opened stays open, for the next frame is read from it too.
 */
#ifndef NSD_ROWS_H
#define NSD_ROWS_H

#include "layout.h"

enum { ROWS = 64 };

struct rows {
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
int rows_read(struct rows *, const char *path, enum column_type, int64_t start, int64_t n,
              int64_t width, void *out, struct why *);

/* The same of all of a table's columns at `where`, `tail` behind their names, into n structs. */
int rows_read_columns(struct rows *, const char *where, const char *tail, const struct column *,
                      int64_t start, int64_t n, void *structs, size_t stride, struct why *);

/* The file stays open. */
void rows_close(struct rows *);

#endif
