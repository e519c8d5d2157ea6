/*
 * file/shape_tables.h: the shapes of grains in a document [nsd-format(5)]: the table in /nsd/shape, and
 * the row of each body in /particles/all/shape. A document of balls has neither.
 */
#pragma once

#include "file/source.h"
#include "file/tables.h"

/* The table of frame k, checked; the bodies' rows are among the tables of bodies. */
int shape_tables_read(struct source *source, int64_t k, struct packing *p, struct failure *failure);
/* All of it; or, where grains break, whose fragments have new shapes, with each frame the rows that are new */
int shape_tables_write_static(struct table_write *tables, const struct packing *p,
                              struct failure *failure);
int shape_tables_write(struct table_write *tables, const struct packing *p,
                       struct failure *failure);
