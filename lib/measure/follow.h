/*
 * measure/follow.h: since when bodies are in the region, and pairs touch, carried from frame to frame. Times are
 * those of frames, but those of bodies that were poured or removed, which are known.
 */
#pragma once

#include "measure/snapshot.h"

/* Marks the bodies to which measures keep. */
void follow_chosen(struct frame_memory *now, const struct snapshot *s);
/* now = what is remembered of this frame, with times out of s->before; to be freed by kept_free. pairs: those that
   touch as well, where the frame has contacts. Returns 0 or EX_SOFTWARE. */
int follow(struct frame_memory *now, const struct snapshot *s, bool pairs, struct failure *failure);
/* Is a kept body in the region? */
static inline bool follow_in(const struct frame_memory_body *b)
{
    return b->entered == b->entered; // else NaN
}
/* s: when the body of that id was removed since the frame before; the frame's time where that is not known */
double follow_removed(const struct snapshot *s, int32_t id);
