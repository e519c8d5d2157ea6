/*
 * sink.h: documents out [nsd-format(5)]: a stream of one document a frame, or a trajectory that
 * grows frame by frame in a regular file.
 */
#ifndef NSD_SINK_H
#define NSD_SINK_H

#include "frame.h"

struct sink;

enum sink_kind {
    SINK_STREAM,    /* one document a frame, each written when it is whole */
    SINK_TRAJECTORY /* one growing document where the output is a file that it may have for itself */
};

/*
 * To `path`, or to standard output when it is NULL. A trajectory on standard output needs an empty
 * regular file there; elsewhere, and under >>, it becomes a stream. EX_USAGE: standard output is a
 * terminal; EX_IOERR: it cannot be written.
 */
int sink_open(struct sink **, const char *path, enum sink_kind, struct why *);

/*
 * One more frame. A trajectory keeps the bodies, walls and parameters of its first frame, and wants
 * the same number of bodies of every other; each frame is on disk when this returns, and a reader
 * of the unfinished file sees whole frames only. Objects of frame->origin that nsd does not know
 * are copied. An FCLIB problem goes into a stream only.
 */
int sink_frame(struct sink *, const struct frame *, struct why *);

/* Ends the document: lengths, checksum, and every error that the file system held back. */
int sink_close(struct sink *, struct why *);

#endif
