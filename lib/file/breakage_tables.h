/*
 * file/breakage_tables.h: how the grains of each kind break, and the account of those that have [nsd-format(5)]:
 * /nsd/breakage. Documents of grains that do not break have none.
 */
#pragma once

#include "file/source.h"
#include "file/tables.h"

/* Of frame k, behind its kinds */
int breakage_tables_read(struct source *source, int64_t k, struct packing *p,
                         struct failure *failure);
int breakage_tables_write_static(struct table_write *tables, const struct packing *p,
                                 struct failure *failure);
int breakage_tables_write(struct table_write *tables, const struct packing *p,
                          struct failure *failure);
/* After the first frame's step: their clock is that of the particles. */
int breakage_tables_link(struct table_write *tables, const struct packing *p,
                         struct failure *failure);
