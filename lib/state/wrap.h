/*
 * state/wrap.h: a packing whose cell repeats is brought back into the cell. Bodies that have left it
 * are replaced by their images in it, with the velocity that images have, and edges that lean too
 * far by others of the same lattice. Nothing else changes: it is the same packing in other words.
 */
#ifndef NSD_WRAP_H
#define NSD_WRAP_H

#include "state/contact.h"
#include "state/packing.h"

/*
 * A step begins with it; bodies then stay where they are until the next, so that at the end of a step
 * they may lie outside of the cell by the step's way. The shifts of the contacts follow; their
 * points do not. s: NULL, there are none. Does nothing where nothing repeats.
 */
void packing_wrap(struct packing *p, struct contacts *s);

#endif
