/*
 * io/reader.h: documents in: streams and trajectories, one frame at a time [nsd-format(5)].
 *
 * A trajectory is a packed stream: reading either gives the same frames.
 */
#ifndef NSD_READER_H
#define NSD_READER_H

#include "base/range.h"
#include "io/frame.h"

struct reader;

/* files, one after another; none or "-": standard input. */
int reader_open(struct reader **, int files, char *const *file, struct why *);

/*
 * The next document: *frames moments are in it (1 for an FCLIB problem); -1 at the end. Everything
 * read from a file is checked before it is given out (EX_DATAERR).
 */
int reader_document(struct reader *, int64_t *frames, struct why *);
/* Moment k of that document; *f is freed first, and is the caller's to free. */
int reader_frame(struct reader *, int64_t k, struct frame *f, struct why *);

/* Is moment k of that document one of these steps? Told without reading it; an FCLIB problem, which has
   no steps, always is. */
bool reader_has(const struct reader *, int64_t k, const struct range *);

/* All in one: every frame of these steps (NULL: of all) in every document; *more is false at the end. */
int reader_next(struct reader *, const struct range *, struct frame *, bool *more, struct why *);
/* The very last frame of all, its document left open; *more is false where there is none. */
int reader_last(struct reader *, struct frame *, bool *more, struct why *);

/* "a.h5" or "a.h5: document 3": for messages about the frame in hand */
const char *reader_where(const struct reader *);
/* Is the file at `path` among these inputs? */
bool reader_reads(int files, char *const *file, const char *path);
void reader_close(struct reader *);

#endif
