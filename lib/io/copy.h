/*
 * io/copy.h: what nsd does not know in a document it reads, a tool copies into what it writes.
 */
#ifndef NSD_COPY_H
#define NSD_COPY_H

#include "io/frame.h"

/*
 * Copies those objects of frame->origin whose names nsd does not use into the document `file` (an
 * hid_t): from the root and from the groups of particles, walls, observables and /nsd. Of an origin
 * with several frames, only what does not depend on time. FCLIB problems come along unless
 * frame->stale.
 */
int copy_unknown(int64_t file, const struct frame *frame, struct why *why);
/* Is there anything that copy_unknown would copy? */
bool copy_wanted(const struct frame *frame);

#endif
