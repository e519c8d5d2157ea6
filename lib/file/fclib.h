/*
 * file/fclib.h: frictional contact problems in the FCLIB format, in and out: local and global, in two
 * and three dimensions, as libfclib 3 reads and writes them. No file is trusted: every length,
 * index and number is checked. The names here differ from libfclib's own, so that one program may
 * link both. Problems are read from a source (file/source.h) and written to a `file`, an hid_t of
 * libhdf5.
 */
#pragma once

#include "solve/condense.h"
#include "solve/delassus.h"
#include "solve/problem.h"

/*
 * local:   u = W r + q
 * global:  M v = H r + G lambda + f,  G^T v + b = 0,  u = H^T v + w; condensed to the local form
 */
struct fclib {
    bool global;
    struct delassus W;
    struct motion motion; /* of a global one: (v, lambda) as a function of r */
};

struct source;

/* Does the document hold a problem, /fclib_local or /fclib_global? */
bool fclib_in(const struct source *source);
/* There is none: which other FCLIB group there is. Returns EX_DATAERR. */
int fclib_none(const struct source *source, struct failure *failure);
int fclib_read(struct fclib *problem, struct source *source, struct failure *failure);
/* r[n d] of the stored /solution; zeros where there is none. */
int fclib_load_solution(const struct fclib *problem, struct source *source, double *r,
                        struct failure *failure);
void fclib_free(struct fclib *problem);

/* Writes /solution: u and r [n d], of a global problem also v and l. Replaces what is there. */
int fclib_store_solution(const struct fclib *problem, int64_t file, const double *u,
                         const double *r, struct failure *failure);

/* Removes an object, if it is there. */
int fclib_remove(int64_t file, const char *path, struct failure *failure);
/* Writes a packing's contact problem with its info. Replaces any problem and solution there. */
int fclib_write_problem(const struct problem *problem, bool global, int64_t file,
                        struct failure *failure);
