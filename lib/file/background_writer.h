/*
 * file/background_writer.h: frames that a thread of its own writes, while the next step is made. The same frames in the same
 * order; that one could not be written is told when the next is handed over, or at the end.
 */
#pragma once

#include "file/writer.h"

struct background_writer;

/* Nobody else may use the writer, or libhdf5, until background_close. */
int background_open(struct background_writer **b, struct writer *writer, struct failure *failure);
/*
 * Writes one more frame, of which packing and contacts are copied and the rest stays as it is until
 * background_close. Waits for the one before. Returns what writer_frame returned of that.
 */
int background_frame(struct background_writer *b, const struct frame *frame,
                     struct failure *failure);
/* Waits for the last one, and frees; NULL: nothing. */
int background_close(struct background_writer *b, struct failure *failure);
