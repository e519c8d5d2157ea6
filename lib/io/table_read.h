/*
 * io/table_read.h: rows out of the datasets of a document. The inverse of io/table_write.h. A
 * dataset once opened stays open, because the next frame is read from it too.
 */
#ifndef NSD_TABLE_READ_H
#define NSD_TABLE_READ_H

#include "io/layout.h"

enum {
    OPEN_DATASETS = 64 /* at once; the tables of io/layout.h have fewer columns than that in all */
};

struct table_read {
    hid_t file;
    struct {
        char path[80];
        hid_t set;
        int rank;
        hsize_t shape[4];
    } open[OPEN_DATASETS];
    int count; /* of open datasets */
};

/*
 * Rows start .. start+n-1 of a dataset, converted to the column type. A row is `width` numbers, in
 * whatever further dimensions the dataset has them. Returns 0, EX_DATAERR or EX_SOFTWARE.
 */
int table_read_rows(struct table_read *tables, const char *path, enum column_type type,
                    int64_t start, int64_t n, int64_t width, void *out, struct why *why);

/* The same for all columns of a table, from the datasets group/NAMEtail into n structs. */
int table_read_columns(struct table_read *tables, const char *group, const char *tail,
                       const struct column *column, int64_t start, int64_t n, void *structs,
                       size_t stride, struct why *why);

/* Closes the datasets; the file stays open. */
void table_read_close(struct table_read *tables);

#endif
