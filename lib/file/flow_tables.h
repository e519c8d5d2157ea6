/*
 * file/flow_tables.h: /nsd/flow of a document [nsd-format(5)]: how many bodies have come and
 * gone, and the events.
 */
#ifndef NSD_FLOW_TABLES_H
#define NSD_FLOW_TABLES_H

#include "file/source.h"
#include "file/table_write.h"

/* A frame's part; nothing where bodies stay. */
int flow_write(struct table_write *tables, const struct packing *p, struct failure *failure);
/* After the first frame's step: the hard links to the step and time of the particles. */
int flow_link(struct table_write *tables, const struct packing *p, struct failure *failure);

/* What frame k says; nothing where there is no such group. */
int flow_tables_read(struct source *source, int64_t k, struct packing *p, struct failure *failure);
/* The number of the next body that is poured, where bodies were added besides; p has its step. */
int flow_tables_read_numbers(struct source *source, struct packing *p, struct failure *failure);

#endif
