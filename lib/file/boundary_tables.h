/*
 * file/boundary_tables.h: boundaries in a document [nsd-format(5)]: their shapes, meshes, loads and
 * drives, and where they are over time.
 */
#ifndef NSD_BOUNDARY_TABLES_H
#define NSD_BOUNDARY_TABLES_H

#include "file/source.h"
#include "file/table_write.h"

/* Those of frame k, whose time p has */
int boundary_tables_read(struct source *source, int64_t k, struct packing *p, struct failure *failure);

/* Does any boundary move? A trajectory whose first frame has none that does, and none that may, takes none later. */
bool boundary_tables_move(const struct packing *p);
/* What all frames share */
int boundary_tables_write_static(struct table_write *tables, const struct packing *p,
                                 struct failure *failure);
/* A frame's part: nothing where nothing moves */
int boundary_tables_write(struct table_write *tables, const struct packing *p, struct failure *failure);

#endif
