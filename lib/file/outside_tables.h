/*
 * file/outside_tables.h: what has acted from outside [state/outside.h] in a document: gravity, friction and the motion
 * of boundaries of frames in which they may differ, the forces of a step whose contacts are kept, those that last, and
 * what was answered. Frames in which nothing has acted have no row.
 */
#ifndef NSD_OUTSIDE_TABLES_H
#define NSD_OUTSIDE_TABLES_H

#include "file/source.h"
#include "file/frame.h"
#include "file/table_write.h"

/* Into a packing that has all else of its frame, its step too. Returns 0, EX_DATAERR or EX_SOFTWARE. */
int external_force_tables_read(struct source *source, struct packing *p, struct failure *failure);
/* A frame's part */
int external_force_tables_write(struct table_write *tables, const struct frame *frame, struct failure *failure);

#endif
