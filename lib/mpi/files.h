/*
 * mpi/files.h: bodies into the datasets of a document. Where libhdf5 is the one that knows MPI (libhdf5-openmpi)
 * and all ranks find the file, each writes its rows, all at once, into the place that the first has made for
 * them. Else the first rank writes them, block after block as the ranks send them.
 */
#ifndef NSD_FILES_H
#define NSD_FILES_H

#include "file/distributed.h"
#include "mpi/rows.h"

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
/* Is libhdf5 the one that knows MPI? */
bool files_parallel(void);

#endif
