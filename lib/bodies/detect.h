/*
 * bodies/detect.h: which bodies touch in the predicted position q + (1 - theta) dt qdot [globalmapapp1],
 * and the local frames there.
 */
#ifndef NSD_DETECT_H
#define NSD_DETECT_H

#include "bodies/contact.h"
#include "bodies/neighbours.h"

/*
 * Every pair of bodies, and of a body and a wall, whose predicted gap is at most `gap` (m) and of
 * which one can move. Ball-ball and ball-plane; in the plane disc-disc and disc-line.
 *
 * neighbours: kept from one step of these bodies to the next, to save the search; or NULL. The
 * contacts are the same.
 */
int detect_contacts(struct contacts *, const struct packing *, double gap, struct neighbours *,
                    struct why *);

#endif
