/*
 * file/frame_write.h: a frame as the datasets of a document [nsd-format(5), state/fields.h], in three
 * parts: what all frames share, what belongs to this one, and the step that makes it count.
 */
#pragma once

#include "file/tables.h"

int frame_write_static(struct table_write *tables, const struct frame *frame,
                       struct failure *failure);
int frame_write_moment(struct table_write *tables, const struct frame *frame,
                       struct failure *failure);
/* /particles/all/position/step, to be written last: with its step a frame counts as there. */
int frame_write_step(struct table_write *tables, const struct frame *frame,
                     struct failure *failure);
