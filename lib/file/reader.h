/*
 * file/reader.h: documents in [nsd-format(5)]: streams and trajectories, one frame at a time. A
 * trajectory is a packed stream, so that reading either gives the same frames.
 */
#pragma once

#include "base/option.h"
#include "file/frame.h"
#include "file/source.h"

struct reader;

/* The files are read one after another; no file, or the name "-", means standard input. */
int reader_open(struct reader **reader, int files, char *const *file, struct failure *failure);

/*
 * All readers from now on take documents whose datasets hold so many bytes when unpacked; 0: 64
 * times their size, at least 64 MiB.
 */
void reader_unpack(double bytes);
/* Frames shall bring along what nsd does not know in their documents, for a writer to copy. */
void reader_copies(struct reader *reader);

/* Bodies of frames may go to others [file/distributed.h]; NULL: they stay. */
void reader_hands_over(struct reader *reader, struct distributed *to);

/* Something in the open document that depends on time and that nsd does not know, so that frames
   do not bring it along: its path, or NULL. */
const char *reader_loses(const struct reader *reader);

/*
 * Opens the next document and tells in *frames how many it holds: 1 for an FCLIB problem, -1 when
 * there is no further document. All that is read from a file is checked first (EX_DATAERR).
 */
int reader_document(struct reader *reader, int64_t *frames, struct failure *failure);
/* Reads frame k of the open document. *frame is freed first; the caller frees it in the end. */
int reader_frame(struct reader *reader, int64_t k, struct frame *frame, struct failure *failure);

/*
 * Is frame k of the open document one of these steps? Answered without reading the frame. An FCLIB
 * problem has no step and is always one.
 */
bool reader_has(const struct reader *reader, int64_t k, const struct range *steps);

/*
 * Goes to the next frame of these steps (NULL: of all), across documents. *more becomes false when there
 * is none.
 */
int reader_find(struct reader *reader, const struct range *steps, bool *more,
                struct failure *failure);
/* Reads it. */
int reader_take(struct reader *reader, struct frame *frame, struct failure *failure);
/*
 * Or may it go on as it is, of a reader that copies? A document of nsd's own with one packing and nothing else, as
 * nsd writes it into a stream, and so large that it matters: a small one is decoded, and thereby checked, as fast.
 */
bool reader_whole(const struct reader *reader);
/* All bytes of its document, in pieces, to pour(to, ...); none of its numbers has been looked at. */
int reader_pour(struct reader *reader, source_sink pour, void *to, struct failure *failure);
/* Both: the next frame of these steps, and *more */
int reader_next(struct reader *reader, const struct range *steps, struct frame *frame, bool *more,
                struct failure *failure);
/* The very last frame of all documents; *more becomes false when there is no frame at all. */
int reader_last(struct reader *reader, struct frame *frame, bool *more, struct failure *failure);

/* "a.h5" or "a.h5: document 3": where the current frame comes from, for messages. */
const char *reader_where(const struct reader *reader);
/* Is the file at `path` one of these inputs? */
bool reader_reads(int files, char *const *file, const char *path);
void reader_close(struct reader *reader);
