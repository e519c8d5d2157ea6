/*
 * convert/ondem_read.h: packings in ON-DEM's exchange format [convert/ondem.h], by ours or another program: spheres,
 * boxes, clumps of spheres, and what /nsd describes: polyhedra, capsules; walls across an axis. What the scene that takes them
 * has itself is not read: contacts and the stiffnesses of materials.
 */
#ifndef NSD_ONDEM_READ_H
#define NSD_ONDEM_READ_H

#include "convert/imported.h"
#include "state/packing.h"

/* Does the file begin as HDF5 does? */
bool ondem_looks(int fd);
/* p = its bodies and walls; kinds are called as its materials are labelled, else by their number. Returns 0,
   EX_DATAERR or EX_SOFTWARE. */
int ondem_read(struct packing *p, const char *path, int dim, struct import_said *said,
               struct failure *failure);

#endif
