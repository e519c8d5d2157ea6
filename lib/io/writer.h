/*
 * io/writer.h: documents out [nsd-format(5)]: a stream of one document a frame, or a trajectory that
 * grows frame by frame in a regular file.
 */
#ifndef NSD_WRITER_H
#define NSD_WRITER_H

#include "io/frame.h"

struct writer;

enum writer_kind {
    WRITER_STREAM,    /* one document a frame, each written when it is whole */
    WRITER_TRAJECTORY /* one growing document where the output is a file that it may have for itself */
};

/*
 * To `path`, or to standard output when it is NULL. A trajectory on standard output needs an empty
 * regular file there; elsewhere, and under >>, it becomes a stream. EX_USAGE: standard output is a
 * terminal; EX_IOERR: it cannot be written.
 */
int writer_open(struct writer **, const char *path, enum writer_kind, struct why *);

/*
 * One more frame. A trajectory keeps the bodies, walls and parameters of its first frame, and wants
 * the same number of bodies of every other; each frame is on disk when this returns, and a reader
 * of the unfinished file sees whole frames only. Objects of frame->origin that nsd does not know
 * are copied. An FCLIB problem goes into a stream only.
 */
int writer_frame(struct writer *, const struct frame *, struct why *);

/* Ends the document: lengths, checksum, and every error that the file system held back. */
int writer_close(struct writer *, struct why *);

#endif
