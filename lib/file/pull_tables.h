/* file/pull_tables.h: forces and torques on single bodies in a document. */
#ifndef NSD_PULL_TABLES_H
#define NSD_PULL_TABLES_H

#include "file/table_read.h"
#include "file/table_write.h"

/* Nothing where there is no such group. packing_check() looks at them. Each returns 0, EX_DATAERR or EX_SOFTWARE; to
   write, EX_IOERR. */
int pull_tables_read(struct source *source, struct packing *p, struct failure *failure);
int pull_tables_write(struct table_write *tables, const struct packing *p, struct failure *failure);

#endif
