/*
 * file/wall_tables.h: walls in a document [nsd-format(5)]: their shapes, meshes, loads and
 * drives, and where they are over time.
 */
#pragma once

#include "file/source.h"
#include "file/tables.h"

/* Those of frame k, whose time p has */
int wall_tables_read(struct source *source, int64_t k, struct packing *p, struct failure *failure);

/* Does any wall move? A trajectory whose first frame has none that does, and none that may, takes none later. */
bool wall_tables_move(const struct packing *p);
/* What all frames share */
int wall_tables_write_static(struct table_write *tables, const struct packing *p,
                             struct failure *failure);
/* A frame's part: nothing where nothing moves */
int wall_tables_write(struct table_write *tables, const struct packing *p, struct failure *failure);

/*
 * Names of walls, of parts of their surfaces and of groups of bodies [state/names.h] in a
 * document; nothing where there are none.
 */

/* Into a packing; packing_check() sees whether they are of its walls. Returns 0, EX_DATAERR or EX_SOFTWARE. */
int name_tables_read(struct source *source, struct packing *p, struct failure *failure);
/* What all frames share */
int name_tables_write(struct table_write *tables, const struct packing *p, struct failure *failure);

/* Signals in time, and the rows of their tables in group/row. Each returns 0, EX_DATAERR, EX_SOFTWARE or EX_IOERR. */
int signal_tables_read(struct source *source, const char *group, const struct field *fields,
                       struct drives *drives, struct failure *failure);
int signal_tables_write(struct table_write *tables, const char *group, const struct field *fields,
                        const struct drives *drives, const char *units, struct failure *failure);
