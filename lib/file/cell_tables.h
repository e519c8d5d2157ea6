/*
 * file/cell_tables.h: the cell in a document [nsd-format(5)]: H5MD's box with its edges over time, what
 * drives them, and the bodies' images.
 */
#pragma once

#include "file/source.h"
#include "file/tables.h"

/* Which edges of a document's box are periodic */
int cell_tables_open(struct source *source, bool repeats[3], struct failure *failure);
/* The cell of frame k, and the images; p has its bodies and its time. */
int cell_tables_read(struct source *source, int64_t k, const bool repeats[3], struct packing *p,
                     struct failure *failure);

/* What all frames share; where nothing is periodic the box has no edges. */
int cell_tables_write_box(hid_t file, const struct cell *c, struct failure *failure);
/* A frame's part: nothing where nothing repeats */
int cell_tables_write(struct table_write *tables, const struct packing *p, struct failure *failure);
