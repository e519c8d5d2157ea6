/*
 * io/fclib.h: frictional contact problems in the FCLIB format, in and out (local and global, 2D and
 * 3D), as libfclib 3 reads and writes them. Nothing is believed: every length, index and number of a
 * file is checked. The names keep clear of libfclib's own, so that a program may link both.
 */
#ifndef NSD_FCLIB_H
#define NSD_FCLIB_H

#include "problem/condense.h"
#include "problem/delassus.h"
#include "problem/problem.h"

/*
 * local:   u = W r + q
 * global:  M v = H r + G lambda + f,  G^T v + b = 0,  u = H^T v + w; condensed to the local form
 */
struct fclib {
    bool global;
    struct delassus W;
    struct motion motion; /* global: (v, lambda) of r */
};

/* Is there a /fclib_local or /fclib_global? file is an hid_t of libhdf5. */
bool fclib_in(int64_t file);
int fclib_read(struct fclib *, int64_t file, struct why *);
/* r[n d] of the stored /solution, 0 where there is none. */
int fclib_load_solution(const struct fclib *, int64_t file, double *r, struct why *);
void fclib_free(struct fclib *);

/* /solution: u, r (and v, l of a global one); u, r [n d]. What stood there is replaced. */
int fclib_store_solution(const struct fclib *, int64_t file, const double *u, const double *r,
                         struct why *);

/* A packing's contact problem as /fclib_local or /fclib_global, and info. What stood there goes. */
int fclib_write_problem(const struct problem *, bool global, int64_t file, struct why *);

#endif
