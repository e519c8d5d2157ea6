/*
 * file/memory_rows.h: the reactions that the next step starts from, in a document, /nsd/memory [nsd-format(5)]: a
 * block of rows for each frame that has such a memory.
 */
#ifndef NSD_MEMORY_ROWS_H
#define NSD_MEMORY_ROWS_H

#include "file/table_read.h"
#include "file/table_write.h"

/* The memories of a document that is read */
struct memory_rows {
    struct source *source;
    int64_t *step; /* [blocks] of the frames that have one */
    int64_t blocks;
};

int memory_rows_open(struct memory_rows *rows, struct source *source, struct failure *failure);
void memory_rows_close(struct memory_rows *rows);
/* That of the packing, whose bodies are there; checked (EX_DATAERR). Nothing where the frame has none */
int memory_rows_read(struct memory_rows *rows, struct packing *p, struct failure *failure);
/* The packing's, as the next block; nothing where solves do not start from it */
int memory_rows_write(struct table_write *tables, const struct packing *p, struct failure *failure);

#endif
