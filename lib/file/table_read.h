/*
 * file/table_read.h: tables of file/layout.h out of the datasets of a document. The inverse of
 * file/table_write.h.
 */
#ifndef NSD_TABLE_READ_H
#define NSD_TABLE_READ_H

#include "file/source.h"
#include "file/layout.h"

/* Rows of the datasets group/NAMEtail, from `start` on, into the records. Returns 0, EX_DATAERR or EX_SOFTWARE. */
int table_read_columns(struct source *source, const char *group, const char *tail, int64_t start,
                       struct records records, struct failure *failure);

/* The same of numbers all of which are finite */
int table_read_finite(struct source *source, const char *group, const char *tail, int64_t start,
                      struct records records, struct failure *failure);

/* Rows of a table: `count` from `start` on */
struct span {
    int64_t start, count;
};
/* A table of which each frame has a span, as group/start and group/count say */
struct table_spans {
    const char *group, *one; /* one of its datasets is group/one, */
    int rank;                /* of this many dimensions */
};
/* That of frame k. Returns 0, EX_DATAERR or EX_SOFTWARE. */
int table_read_span(struct source *source, struct table_spans table, int64_t k, struct span *span,
                    struct failure *failure);

/* A dataset of steps, *n of them; to be freed. NULL: not there, or no memory. */
int64_t *table_read_steps(struct source *source, const char *path, int64_t *n, struct failure *failure);
/* How many of n steps rise, from the first on: a killed writer may have made room for one without setting it. */
int64_t table_read_rising(const int64_t *steps, int64_t n);
/* The row of a step among n that rise; -1: none */
int64_t table_read_row(const int64_t *steps, int64_t n, int64_t step);
/* That of the step in the dataset of steps at `path`; -1: it has none, or does not exist */
int64_t table_read_row_at(struct source *source, const char *path, int64_t step, struct failure *failure);

#endif
