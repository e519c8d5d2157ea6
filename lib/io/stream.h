/*
 * io/stream.h: documents as bytes: the 64-byte header in front of each, and the stream that they make
 * back to back [nsd-format(5)]. Knows nothing of HDF5.
 */
#ifndef NSD_STREAM_H
#define NSD_STREAM_H

#include "base/why.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    DOCUMENT_VERSION = 1,
    DOCUMENT_USERBLOCK = 512, /* bytes before HDF5's own */
    DOCUMENT_UNFINISHED = 1   /* flag: still being written, to the end of its file */
};

/*
 * The header of a finished document (length bytes, user block included, crc that of the bytes after
 * the user block) or, with length 0, of one that is still being written. The rest is zeroed.
 */
void document_header(unsigned char userblock[DOCUMENT_USERBLOCK], uint64_t length, uint32_t crc);
uint32_t document_crc(uint32_t crc, const void *bytes, size_t size);

/* One document, whole; its bytes belong to the stream, until the next but one. */
struct image {
    const char *name;     /* of its file, "standard input" */
    int64_t number;       /* in its file, from 1 */
    unsigned char *bytes; /* NULL: the end */
    size_t size;
    bool foreign;    /* an HDF5 file without our header */
    bool unfinished; /* no checksum vouches for it */
};

struct stream;

/* files, one after another; none or "-": standard input. Opened when their turn comes. */
int stream_open(struct stream **, int files, char *const *file, struct why *);
/*
 * The next document. EX_NOINPUT: a file cannot be opened; EX_USAGE: it is a terminal; EX_DATAERR: not a
 * document, truncated, damaged, of a newer version, or nothing at all.
 */
int stream_next(struct stream *, struct image *, struct why *);
/* What has been read of a large file need not stay in memory; it is read again when wanted. */
void stream_rest(struct stream *);
/* The document in hand is done with: a pipe's takes no memory any longer. */
void stream_drop(struct stream *);
void stream_close(struct stream *);

#endif
