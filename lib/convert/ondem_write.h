/*
 * convert/ondem_write.h: a packing in ON-DEM's exchange format [nsd-export(1)], by which DEM programs hand packings to each
 * other: one moment. /VTKHDF is a MultiBlockDataSet with the bodies as points, spheres in the block Points and the rest
 * in Others; /ONDEM has the scene, the materials and the contacts. What the format lacks is in /nsd as in a
 * document [nsd-format(5)], and in columns called nsd_...: shapes, the materials of pairs, the periodic cell.
 */
#ifndef NSD_ONDEM_WRITE_H
#define NSD_ONDEM_WRITE_H

#include "state/contact.h"
#include "state/packing.h"

#include <stddef.h>

/* The file as bytes, to be freed; contacts may be NULL. NULL: EX_SOFTWARE. */
void *ondem_write(const struct packing *p, const struct contacts *contacts, size_t *size,
                  struct failure *failure);

#endif
