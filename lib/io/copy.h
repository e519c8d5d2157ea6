/* io/copy.h: a filter copies what it does not know. */
#ifndef NSD_COPY_H
#define NSD_COPY_H

#include "io/frame.h"

/*
 * Objects of frame->origin whose names nsd does not use, into the document `file` (an hid_t): beside
 * the root's, the particles', the walls' and the observables' own. Of an origin with several frames
 * only what does not depend on time. FCLIB problems come along unless frame->stale.
 */
int copy_unknown(int64_t file, const struct frame *, struct why *);
/* Is there anything that it would copy? */
bool copy_wanted(const struct frame *);

#endif
