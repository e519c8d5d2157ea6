/*
 * file/source.h: what is in the documents of a stream, read by a process of its own.
 *
 * libhdf5 crashes on damaged files, and worse is possible with files made to harm. So a child of the
 * tool opens the files and asks libhdf5 (file/server.h), with bounds on its memory and time, and hands
 * over plain numbers and texts. Whatever becomes of the child, the tool continues, and says which
 * document it was (EX_DATAERR).
 *
 * Paths are absolute; "" is the root.
 */
#pragma once

#include "file/h5.h"
#include "file/object.h"

struct source;

/* The documents of these files; no file, or the name "-", means standard input. */
int source_open(struct source **source, int files, char *const *file, struct failure *failure);
/* The same answers about one HDF5 file that this process has made itself, and trusts. */
int source_of_own(struct source **source, hid_t file, struct failure *failure);
void source_close(struct source *source);

/*
 * Bytes that a document's datasets may hold when unpacked, for all sources from now on; 0: 64 times
 * its size, at least 64 MiB.
 */
void source_limit(uint64_t bytes);

/* Which document it is */
struct source_document {
    const char *name; /* of its file, or "standard input" */
    int64_t number;   /* its place in that file, from 1 */
    bool foreign;     /* an HDF5 file without our header */
    bool unfinished;  /* no checksum vouches for it */
    uint64_t size;    /* bytes */
    bool plain;       /* its datasets are in one piece each, not in chunks */
};

/* Work on what is in the document that takes as long as so many bytes of it would. EX_DATAERR: too much */
int source_draw(struct source *source, uint64_t work, struct failure *failure);
/* Another frame of it is begun [file/served.h]. */
int source_frame(struct source *source, struct failure *failure);

/* How the pieces of a document go on; 0, or why not. */
typedef int (*source_sink)(void *to, const void *bytes, size_t size, struct failure *failure);

/* On to the next document; *more becomes false when there is none. */
int source_next(struct source *source, struct source_document *document, bool *more,
                struct failure *failure);
/* "a.h5" or "a.h5: document 3" */
const char *source_where(const struct source *source);
/* Pages of a large file that have been read leave memory. */
int source_unload(struct source *source, struct failure *failure);
/* All bytes of the document, as they came, to pour(to, ...) in pieces. */
int source_pour(struct source *source, source_sink pour, void *to, struct failure *failure);
/* The document is done with: it is closed, and a large one's memory freed. */
int source_release(struct source *source, struct failure *failure);

/* ---- what is in the document ---- */

bool source_has(const struct source *source, const char *path);
/* The shape of a dataset of numbers of at most 4 dimensions. Returns its rank, or -1. */
int source_shape(const struct source *source, const char *path, uint64_t shape[4]);
/* Object k of the document, in the order of a walk by names, and its path; NULL: there is none. */
const struct object *source_object(const struct source *source, int64_t k, const char **path,
                                   const uint64_t **shape);

/* Rows start .. start+n-1, converted to the type. A row is `width` numbers, in whatever further dimensions the dataset
   has them. */
struct slab {
    enum column_type type;
    int64_t start, n, width;
};

/* Of a dataset. EX_DATAERR where that is missing, of another shape or of something other than numbers that keep
   their value in this type. */
int source_rows(struct source *source, const char *path, struct slab rows, void *out,
                struct failure *failure);
/* Of row `row` of a dataset, itself rows. The same trouble */
int source_part(struct source *source, const char *path, int64_t row, struct slab rows, void *out,
                struct failure *failure);
/* A whole dataset of exactly `count` numbers. */
int source_read(struct source *source, const char *path, enum column_type type, uint64_t count,
                void *out, struct failure *failure);
/* The same of any size, told in *count. Returns memory to be freed, or NULL on failure. */
void *source_read_all(struct source *source, const char *path, enum column_type type,
                      uint64_t *count, struct failure *failure);
/* A scalar string, of an attribute unless name is NULL. NULL: there is none, or failure. */
char *source_text(struct source *source, const char *path, const char *name,
                  struct failure *failure);
/* A list of strings, each ended by a newline, of a dataset. NULL: there is none, or failure. */
char *source_lines(struct source *source, const char *path, struct failure *failure);
/* Numbers that are wanted, and where they go */
struct numbers {
    enum column_type type;
    int count; /* < 0: a scalar */
    void *to;
};
/* Those of an attribute */
int source_attribute(struct source *source, const char *path, const char *name,
                     struct numbers numbers, struct failure *failure);
/*
 * `count` strings of fixed length of an attribute, each cut to 15 bytes. False where there are
 * none, they are something else, or there is trouble.
 */
bool source_texts(struct source *source, const char *path, const char *name, int count,
                  char out[][16], struct failure *failure);
/* All of a dataset in its own plain type; to be freed. */
void *source_raw(struct source *source, const char *path, uint64_t *size, struct failure *failure);
/* All attributes of an object, as a sequence of struct object; to be freed. */
void *source_attributes(struct source *source, const char *path, uint64_t *size,
                        struct failure *failure);
