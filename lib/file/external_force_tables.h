/*
 * file/external_force_tables.h: what has acted from outside [state/external_force.h] in a document: gravity, friction and the motion
 * of walls of frames in which they may differ, the forces of a step whose contacts are kept, those that last, and
 * what was answered. Frames in which nothing has acted have no row.
 */
#pragma once

#include "file/frame.h"
#include "file/source.h"
#include "file/tables.h"

/* Into a packing that has all else of its frame, its step too. Returns 0, EX_DATAERR or EX_SOFTWARE. */
int external_force_tables_read(struct source *source, struct packing *p, struct failure *failure);
/* A frame's part */
int external_force_tables_write(struct table_write *tables, const struct frame *frame,
                                struct failure *failure);

/* Forces and torques on single bodies in a document. */

/* Nothing where there is no such group. packing_check() looks at them. Each returns 0, EX_DATAERR or EX_SOFTWARE; to
   write, EX_IOERR. */
int pull_tables_read(struct source *source, struct packing *p, struct failure *failure);
int pull_tables_write(struct table_write *tables, const struct packing *p, struct failure *failure);
