/*
 * file/stream.h: documents as bytes [nsd-format(5)]: the 64-byte header in front of each, and the
 * stream that they form when they follow one another. This module knows nothing of HDF5.
 */
#pragma once

#include "base/failure.h"
#include "file/crc.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    DOCUMENT_VERSION = 2,
    DOCUMENT_USERBLOCK = 512, /* bytes in front of HDF5's own; HDF5 allows no fewer */
    DOCUMENT_UNFINISHED = 1   /* flag: still being written, and reaches to the end of its file */
};

/*
 * Makes the header of a finished document of `length` bytes, user block included, where crc is the
 * checksum of the bytes after the user block. Length 0 makes the header of a document that is still
 * being written. The rest of the user block becomes zero.
 */
void document_header(unsigned char userblock[DOCUMENT_USERBLOCK], uint64_t length, uint32_t crc);

/* One whole document. Its bytes belong to the stream and last until the next call but one. */
struct image {
    const char *name;     /* of its file, or "standard input" */
    int64_t number;       /* its place in that file, from 1 */
    unsigned char *bytes; /* NULL: the stream has ended */
    size_t size;          /* bytes */
    size_t room; /* bytes that may be looked at: more than size where the file may grow into them */
    bool foreign;    /* an HDF5 file without our header */
    bool unfinished; /* no checksum vouches for it */
};

struct stream;

/*
 * The documents of these files, one file after another. No file, or the name "-", means standard
 * input. A file is opened when its turn comes.
 */
int stream_open(struct stream **stream, int files, char *const *file, struct failure *failure);
/*
 * Finds the next document. EX_NOINPUT: a file cannot be opened; EX_USAGE: it is a terminal;
 * EX_DATAERR: it is empty or not a document, truncated, damaged or of a newer version.
 */
int stream_next(struct stream *stream, struct image *image, struct failure *failure);
/* Bytes that the current document has by now: more than its size, if another program writes it */
size_t stream_grown(const struct stream *stream, const struct image *image);
/* Has anybody written to the file in hand since it was opened? */
bool stream_changed(const struct stream *stream);
/* Pages of a large file that have been read leave memory; when wanted they are read again. */
void stream_unload(const struct stream *stream);
/* The current document is no longer needed: the memory of a large one from a pipe is freed. */
void stream_release(struct stream *stream);
