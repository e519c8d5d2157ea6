/*
 * file/wall_load_tables.h: sums over steps of what bodies do to the faces of walls [state/wall_load.h] in a document; nothing
 * where none are kept.
 */
#pragma once

#include "file/source.h"
#include "file/tables.h"

/* Those of frame k, into a packing that has its walls. Returns 0, EX_DATAERR or EX_SOFTWARE. */
int sum_tables_read(struct source *source, int64_t k, struct packing *p, struct failure *failure);
/* What all frames share, and a frame's part */
int sum_tables_write_static(struct table_write *tables, const struct packing *p,
                            struct failure *failure);
int sum_tables_write(struct table_write *tables, const struct packing *p, struct failure *failure);
