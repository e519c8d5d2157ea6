/*
 * detect.h: which bodies touch in the predicted position q + (1 - theta) dt qdot [globalmapapp1],
 * and the local frames there.
 */
#ifndef NSD_DETECT_H
#define NSD_DETECT_H

#include "contact.h"
#include "packing.h"

/*
 * Every pair of bodies, and of a body and a wall, whose predicted gap is at most `gap` (m) and of
 * which one can move. Ball-ball and ball-plane; in the plane disc-disc and disc-line.
 *
 * Cost is linear: bodies are sorted by size into levels of a factor of two, each level into the
 * cells of its own grid, and a body looks into the grids of its own and of larger sizes only.
 * Cells are hashed, so that a body far away costs nothing.
 */
int detect_contacts(struct contacts *, const struct packing *, double gap, struct why *);

#endif
