/*
 * file/roster.h: the rows of a trajectory with inlets or outlets [nsd-format(5)]. A body has one row
 * for ever, in the order of coming; in the frames without it the row's id is -1 and its numbers are
 * NaN. Datasets of [frames][rows] grow in both directions, along the rows by whole chunks, so that
 * what is on disk of earlier frames stays as it is.
 */
#pragma once

#include "file/source.h"
#include "file/tables.h"

struct roster {
    int64_t rows, room; /* bodies that ever were; how many there is memory for */
    int32_t *id;        /* [rows] */
    char *fixed;        /* [rows][bytes] the numbers that do not move, one after another */
    size_t bytes;       /* of all of them */
    int64_t width;      /* rows that the datasets have */
};

/* The most rows that a trajectory can have that begins with this packing, and the rows of a chunk:
   functions of the packing, whoever writes it. */
void roster_bounds(const struct packing *p, int64_t *most, int64_t *chunk, struct failure *failure);

/*
 * row[p->n] = the rows of the packing's bodies; new ones are written to the tables of bodies. *row is
 * to be freed. EX_DATAERR: these are not the bodies that were there, or too many.
 */
int roster_enter(struct roster *r, struct table_write *s, const struct packing *p, int64_t **row,
                 struct failure *failure);
/* Ids and motion, as the next frame of their datasets */
int roster_write(struct roster *r, struct table_write *s, const struct packing *p,
                 const int64_t *row, struct failure *failure);
void roster_free(struct roster *r);

/* How many bodies frame k of a document has, and which rows they are; *row is to be freed. NULL: no
   body comes or goes, the frame has them all. */
int roster_find(struct source *source, int64_t k, int64_t **row, int64_t *n,
                struct failure *failure);
/* The bodies in these rows of frame k, into the packing's arrays of as many */
int roster_read(struct source *source, int64_t k, const int64_t *row, struct packing *p,
                struct failure *failure);

/*
 * file/roster.h: /nsd/flow of a document [nsd-format(5)]: how many bodies have come and
 * gone, and the events.
 */

/* A frame's part; nothing where bodies stay. */
int flow_write(struct table_write *tables, const struct packing *p, struct failure *failure);
/* After the first frame's step: the hard links to the step and time of the particles. */
int flow_link(struct table_write *tables, const struct packing *p, struct failure *failure);

/* What frame k says; nothing where there is no such group. */
int flow_tables_read(struct source *source, int64_t k, struct packing *p, struct failure *failure);
/* The number of the next body that is poured, where bodies were added besides; p has its step. */
int flow_tables_read_numbers(struct source *source, struct packing *p, struct failure *failure);
