/*
 * io/table_read.h: tables of io/layout.h out of the datasets of a document. The inverse of
 * io/table_write.h.
 */
#ifndef NSD_TABLE_READ_H
#define NSD_TABLE_READ_H

#include "io/layout.h"
#include "io/source.h"

/*
 * Rows start .. start+n-1 of all columns of a table, from the datasets group/NAMEtail into n
 * structs. Returns 0, EX_DATAERR or EX_SOFTWARE.
 */
int table_read_columns(struct source *source, const char *group, const char *tail,
                       const struct column *column, int64_t start, int64_t n, void *structs,
                       size_t stride, struct why *why);

#endif
