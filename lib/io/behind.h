/*
 * io/behind.h: frames that a thread of its own writes, while the next step is made. The same frames in the same
 * order; that one could not be written is told when the next is handed over, or at the end.
 */
#ifndef NSD_BEHIND_H
#define NSD_BEHIND_H

#include "io/writer.h"

struct behind;

/* Nobody else may use the writer, or libhdf5, until behind_close. */
int behind_open(struct behind **behind, struct writer *writer, struct why *why);
/*
 * Writes one more frame, of which packing and contacts are copied and the rest stays as it is until
 * behind_close. Waits for the one before. Returns what writer_frame returned of that.
 */
int behind_frame(struct behind *behind, const struct frame *frame, struct why *why);
/* Waits for the last one, and frees; behind NULL: nothing. */
int behind_close(struct behind *behind, struct why *why);

#endif
