/*
 * file/account_rows.h: the account of a run in a document, /nsd/account [nsd-format(5)]: a row for
 * each report, and a dataset for each row of account_watched[].
 */
#ifndef NSD_ACCOUNT_ROWS_H
#define NSD_ACCOUNT_ROWS_H

#include "file/table_read.h"
#include "file/table_write.h"
#include "state/account.h"

/* For how many of n reports there is a row of all: a writer, or one that was killed, may have got no further. */
int64_t account_rows_count(const struct source *source, int64_t n);

/* Rows start .. start+n-1, into account[n]; what the document does not have is 0. Returns 0,
   EX_DATAERR or EX_SOFTWARE. */
int account_rows_read(struct source *source, int64_t start, int64_t n, struct account *account,
                      struct failure *failure);

/* The next row, after that of the report */
int account_rows_write(struct table_write *tables, const struct account *account, struct failure *failure);

#endif
