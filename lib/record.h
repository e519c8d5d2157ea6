/*
 * record.h: a frame as the datasets of a document [nsd-format(5), layout.h], in three parts: what
 * all frames share, what belongs to this one, and the step that makes it count.
 */
#ifndef NSD_RECORD_H
#define NSD_RECORD_H

#include "series.h"

int record_static(struct series *, const struct frame *, struct why *);
int record_moment(struct series *, const struct frame *, struct why *);
/* /particles/all/position/step: last, for a reader takes a frame as there when its step is. */
int record_step(struct series *, const struct frame *, struct why *);

#endif
