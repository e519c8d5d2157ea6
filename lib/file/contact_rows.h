/*
 * file/contact_rows.h: the contacts in a document, /contacts [nsd-format(5)]: a block of rows for each
 * frame that keeps its contacts.
 */
#pragma once

#include "file/tables.h"

/* The contacts of a document that is read */
struct contact_rows {
    struct source *source;
    int64_t *step;  /* [blocks] of the frames whose contacts are kept, */
    int64_t *start; /* [blocks] the first row of each, */
    int64_t *count; /* [blocks] and the number of rows */
    int64_t blocks;
};

int contact_rows_open(struct contact_rows *rows, struct source *source, struct failure *failure);
void contact_rows_close(struct contact_rows *rows);
/* The contacts of the frame's packing, if the document keeps them; checked (EX_DATAERR) */
int contact_rows_read(struct contact_rows *rows, struct frame *frame, struct failure *failure);

/* The frame's contacts, as the next block */
int contact_rows_write(struct table_write *tables, const struct frame *frame,
                       struct failure *failure);

/*
 * The reactions that the next step starts from, in a document, /nsd/memory [nsd-format(5)]: a
 * block of rows for each frame that has such a memory.
 */

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
