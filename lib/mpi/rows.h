/*
 * mpi/rows.h: the bodies as files have them: in rows, of which each rank has a block, one rank after the
 * other. So they come from a document, before they are dealt (mpi/subdomain.h), and so they go into one.
 */
#pragma once

#include "file/distributed.h"
#include "file/layout.h"
#include "mpi/subdomain.h"

struct rows {
    struct comm *comm;
    int64_t all, first; /* bodies of the whole; the first row here */
    struct packing p;   /* the rows here, until they are dealt: bodies and nothing else */
    double mass,
        heavy; /* at the first: kg, the sum of masses along the rows; how many are above 0 */
};

/* Where rank k's block begins; of k = ranks: all */
static inline int64_t rows_begin(int64_t all, int ranks, int k)
{
    int64_t each = all / ranks, more = all % ranks;
    return each * k + (k < more ? k : more);
}

/* The first rank's block of rows, of a packing with `all` bodies, comes to those who have them; in the others it
   is not looked at. From row 0 on; what was there before is dropped then. Collective, as all that follows. */
void rows_take(struct rows *r, struct comm *t, const struct packing *block, int64_t first,
               int64_t all);
/* They become a part's own bodies, of which the first has all else in `settings`. */
void rows_deal(struct rows *r, struct subdomain *y, struct decomposition *space,
               const struct packing *settings);
void rows_free(struct rows *r);

/*
 * Bodies into the datasets of a document. Where libhdf5 is the one that knows MPI (libhdf5-openmpi)
 * and all ranks find the file, each writes its rows, all at once, into the place that the first has made for
 * them. Else the first rank writes them, block after block as the ranks send them.
 */

/* What is to be filled, of the first rank, as in struct distributed */
struct files_wish {
    hid_t file;
    const char *path;
    const struct unfilled *place; /* [places] */
    int places;
    bool gather; /* the first is to write */
};
/* Collective. y NULL: the bodies lie in the rows. Returns 0, or at the first EX_IOERR; EX_DATAERR: what no reader
   accepts. */
int files_fill(const struct rows *r, const struct subdomain *y, const struct files_wish *wish,
               struct failure *failure);
