/*
 * file/report_rows.h: the solver's reports in a document, /nsd/solver [nsd-format(5)]: a row for each
 * step that was solved.
 */
#pragma once

#include "file/tables.h"
#include "state/account.h"

/* The reports of a document that is read */
struct report_rows {
    struct source *source;
    const char *group; /* where they are */
    int64_t *solved;   /* [solves] the steps that they are on */
    int64_t solves;
    bool
        one_frame; /* the document has one frame: its one report is that, for nsd-solve reports on the
                       step that is still to be made */
    struct {
        struct report *row; /* [n] reports from `first` on, read at once: a question of the document
                               takes longer than its answer; or NULL */
        struct account *account; /* [n] */
        double *time;            /* [n] s */
        int64_t first, n;
    } ahead;
};

int report_rows_open(struct report_rows *rows, struct source *source, struct failure *failure);
void report_rows_close(struct report_rows *rows);
/* The report on the solve that led to this step, if there is one, and the account up to there */
int report_rows_read(struct report_rows *rows, int64_t step, struct report *report,
                     struct account *account, bool *there, struct failure *failure);

/* The next row; texts and history are written with the first. */
int report_rows_write(struct table_write *tables, const struct report *report,
                      struct failure *failure);

/*
 * The account of a run in a document, /nsd/account [nsd-format(5)]: a row for
 * each report, and a dataset for each row of account_watched[].
 */

/* For how many of n reports there is a row of all: a writer, or one that was killed, may have got no further. */
int64_t account_rows_count(const struct source *source, int64_t n);

/* Rows start .. start+n-1, into account[n]; what the document does not have is 0. Returns 0,
   EX_DATAERR or EX_SOFTWARE. */
int account_rows_read(struct source *source, int64_t start, int64_t n, struct account *account,
                      struct failure *failure);

/* The next row, after that of the report */
int account_rows_write(struct table_write *tables, const struct account *account,
                       struct failure *failure);
