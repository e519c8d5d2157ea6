/*
 * file/shape_tables.h: the shapes of grains in a document [nsd-format(5)]: the table in /nsd/shape, and
 * the row of each body in /particles/all/shape. A document of balls has neither.
 */
#pragma once

#include "file/source.h"
#include "file/tables.h"

/* The table, checked; the bodies' rows are among the tables of bodies. */
int shape_tables_read(struct source *source, struct packing *p, struct failure *failure);
int shape_tables_write(hid_t file, const struct packing *p, struct failure *failure);
