/*
 * file/name_tables.h: names of boundaries, of parts of their surfaces and of groups of bodies [state/names.h] in a
 * document; nothing where there are none.
 */
#ifndef NSD_NAME_TABLES_H
#define NSD_NAME_TABLES_H

#include "file/source.h"
#include "file/table_write.h"

/* Into a packing; packing_check() sees whether they are of its boundaries. Returns 0, EX_DATAERR or EX_SOFTWARE. */
int name_tables_read(struct source *source, struct packing *p, struct failure *failure);
/* What all frames share */
int name_tables_write(struct table_write *tables, const struct packing *p, struct failure *failure);

#endif
