/*
 * file/pair_law_tables.h: the laws beyond friction and restitution in a document, /nsd/law, and what lasts
 * of pairs by them, /nsd/bonds [nsd-format(5)].
 */
#pragma once

#include "file/source.h"
#include "file/tables.h"

/* The laws, and the bonds of frame k; nothing where there is no such group. packing_check() looks at
   the numbers. */
int pair_law_tables_read(struct source *source, int64_t k, struct packing *p,
                         struct failure *failure);

int pair_law_tables_write_static(hid_t file, const struct packing *p, struct failure *failure);
/* A frame's bonds; nothing where there are no laws */
int pair_law_tables_write(struct table_write *tables, const struct packing *p,
                          struct failure *failure);
