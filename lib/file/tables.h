/*
 * file/tables.h: tables of fields [base/field.h] out of the datasets of a document, and into them.
 */
#pragma once

#include "file/distributed.h"
#include "file/layout.h"
#include "file/source.h"

/* Rows of the datasets group/NAMEtail, from `start` on, into the records. Returns 0, EX_DATAERR or EX_SOFTWARE. */
int table_read_columns(struct source *source, const char *group, const char *tail, int64_t start,
                       struct records records, struct failure *failure);

/* The same of numbers all of which are finite */
int table_read_finite(struct source *source, const char *group, const char *tail, int64_t start,
                      struct records records, struct failure *failure);

/* Rows of a table: `count` from `start` on */
struct span {
    int64_t start, count;
};
/* A table of which each frame has a span, as group/start and group/count say */
struct table_spans {
    const char *group, *one; /* one of its datasets is group/one, */
    int rank;                /* of this many dimensions */
};
/* That of frame k. Returns 0, EX_DATAERR or EX_SOFTWARE. */
int table_read_span(struct source *source, struct table_spans table, int64_t k, struct span *span,
                    struct failure *failure);

/* Frame k of the datasets group/NAME/value [frames][n][width], into the records. Returns the same. */
int table_read_frame(struct source *source, const char *group, int64_t k, struct records records,
                     struct failure *failure);
/* A list that grows: its array, the number of rows and of those that there is memory for */
struct list_of {
    void *rows; /* where the pointer to them is */
    int64_t *n, *room;
};
/* The rows that frame k has in a table, into a new list of `rows`, whose number and array are not used. Returns the same. */
int table_read_list(struct source *source, struct table_spans table, int64_t k, struct list_of list,
                    struct records rows, struct failure *failure);

/* A dataset of steps, *n of them; to be freed. NULL: not there, or no memory. */
int64_t *table_read_steps(struct source *source, const char *path, int64_t *n,
                          struct failure *failure);
/* How many of n steps rise, from the first on: a killed writer may have made room for one without setting it. */
int64_t table_read_rising(const int64_t *steps, int64_t n);
/* The row of a step among n that rise; -1: none */
int64_t table_read_row(const int64_t *steps, int64_t n, int64_t step);
/* That of the step in the dataset of steps at `path`; -1: it has none, or does not exist */
int64_t table_read_row_at(struct source *source, const char *path, int64_t step,
                          struct failure *failure);

/*
 * The datasets of a document that is being written: in a stream each dataset is
 * written whole, in a trajectory it grows frame by frame.
 */

enum {
    GROWING_DATASETS = 192, /* at once; the tables of file/layout.h have fewer columns than that */
    CHUNK_FRAMES = 64,      /* rows a chunk of one number a frame: half a KiB of reals */
    CHUNK_CONTACTS = 256,   /* rows a chunk of contacts: 2 KiB of reals; few are left empty */
    CHUNK_BODIES = 8192     /* at most, a chunk of one frame of bodies: 192 KiB of positions */
};

struct table_write {
    hid_t file;
    bool growing; /* a trajectory */
    /* With inlets and outlets, its datasets of [frames][bodies]: the most bodies that they can have,
       and how many a chunk has; 0: as many as the first frame has, in chunks of CHUNK_BODIES */
    hsize_t most_bodies, chunk_bodies;
    struct roster *roster; /* the bodies then, else NULL; the writer's */
    /* Who has the bodies, else NULL; and the datasets that have been made for them, and are not filled */
    struct distributed *distributed;
    struct unfilled place[DISTRIBUTED_PLACES];
    int places;
    struct {
        char path[80];
        hid_t set;
    } open[GROWING_DATASETS]; /* datasets that grow stay open */
    int count;                /* of open datasets */
    int64_t contacts;         /* rows of /contacts so far */
    int64_t events;           /* rows of /nsd/flow/events so far */
    int64_t bonds;            /* rows of /nsd/bonds so far */
    int64_t memory;           /* rows of /nsd/memory so far */
    int32_t shapes;           /* of grains so far, the ball too, where more may come */
    int32_t first_id;         /* of the first frame, as /nsd/flow has it */
    bool at_rest;             /* no wall could move in the first frame */
    double sums_since;        /* s: of its sums of walls [file/wall_load_tables.h] */
    int64_t forces, words;    /* rows of /nsd/outside/body, bytes of /nsd/outside/answer so far */
    int64_t lasting;          /* rows of /nsd/outside/lasting/force so far */
};

/* Rows of a dataset */
struct dataset {
    const char *path;
    enum column_type type;
    int rank;
    const hsize_t *shape; /* [rank] */
    hsize_t chunk_rows;   /* where it grows */
    const void *data;  /* NULL: room is made for them on the disk, and nothing is written there */
    const char *units; /* or NULL */
};
/* Writes shape[0] rows: as a dataset of their own or, in a trajectory, at the end of the dataset that grows there. */
int table_write_rows(struct table_write *tables, struct dataset rows, struct failure *failure);
/* One number of the frame */
int table_write_number(struct table_write *tables, const char *path, enum column_type type,
                       const void *number, const char *units, struct failure *failure);
/* group/start and count: the rows of the frame in the tables of the group */
int table_write_span(struct table_write *tables, const char *group, int64_t start, int64_t count,
                     struct failure *failure);

/* The columns of bodies that all frames share, or the frame's values of those that move; their numbers follow
   where the bodies are distributed. */
int table_write_bodies(struct table_write *tables, bool moving, const struct packing *p,
                       struct failure *failure);

/* Does the dataset grow already? Answered without libhdf5, which would have to look the path up. */
bool table_write_grows(const struct table_write *tables, const char *path);

/* The records, into the datasets group/NAMEtail: [n], [n][width] or, of nine numbers, [n][3][3] */
int table_write_columns(struct table_write *tables, const char *group, const char *tail,
                        struct records records, hsize_t chunk_rows, struct failure *failure);

/* The frame's row of the datasets group/NAME/value [frames][n][width] */
int table_write_frame(struct table_write *tables, const char *group, struct records records,
                      hsize_t chunk_frames, struct failure *failure);
/* The rows that the frame has in the tables of a group, of which there are *so_far */
int table_write_list(struct table_write *tables, const char *group, int64_t *so_far,
                     struct records rows, struct failure *failure);
/* What all frames share, also of a trajectory: datasets of their own */
int table_write_once(struct table_write *tables, const char *group, struct records rows,
                     struct failure *failure);

/* Hard links WHERE/COLUMN/name to the dataset `from` for all columns */
int table_write_link(struct table_write *tables, const char *from, const char *name,
                     const char *where, const struct field *columns, struct failure *failure);
/* Writes WHERE/step and WHERE/time (s), and links them to all columns there. */
int table_write_clocks(struct table_write *tables, const char *where, const struct field *columns,
                       int64_t step, double time, struct failure *failure);

/* Closes the datasets; the file stays open. Returns -1 where something could not be written. */
int table_write_close(struct table_write *tables);
