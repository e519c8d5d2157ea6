/*
 * file/writer.h: documents out [nsd-format(5)]: a stream of one document for each frame, or a
 * trajectory that grows frame by frame in a regular file.
 */
#pragma once

#include "file/frame.h"
#include "file/reader.h"
#include "file/vtkhdf.h"

struct writer;

enum writer_kind {
    WRITER_STREAM, /* one document for each frame, written when it is whole; a file takes its place with all */
    WRITER_TRAJECTORY, /* one growing document, where the output is a regular file of its own */
    WRITER_COPY,       /* the same; the place of a file it takes when it is whole */
    WRITER_IN_PLACE /* the same; the place of the file that there is it takes when it is told to */
};

/*
 * Opens `path`, or standard output when that is NULL. A file at `path` stays as it is until the first frame is
 * whole [base/output.h]. A trajectory on standard output needs an
 * empty regular file there; elsewhere, and under >>, it becomes a stream. EX_USAGE: standard
 * output is a terminal; EX_IOERR: the output cannot be written.
 */
int writer_open(struct writer **writer, const char *path, enum writer_kind kind,
                struct failure *failure);

/*
 * A trajectory of WRITER_IN_PLACE takes its place now, in one stroke, and grows on. Killed before, it has left
 * the file as it was.
 */
int writer_take_place(struct writer *writer, struct failure *failure);

/*
 * Writes one more frame. A trajectory keeps the bodies, walls and parameters of its first frame and
 * demands the same bodies of every other. Its frame is on disk when this returns, and whoever reads
 * the unfinished file sees whole frames only. Objects of frame->origin that nsd does not know are
 * copied. FCLIB problems go into streams only.
 */
int writer_frame(struct writer *writer, const struct frame *frame, struct failure *failure);

/*
 * Before the first frame: from where the run begins. It is the output, where there is none yet, until there is a
 * frame, so that a run that is killed before leaves a document that another one can begin with.
 */
int writer_begin(struct writer *writer, const struct frame *frame, struct failure *failure);

/* Before the first frame: its documents have /VTKHDF [file/vtkhdf.h]; parts: NULL: with the grains alone. */
int writer_vtk(struct writer *writer, const struct vtkhdf_parts *parts, struct failure *failure);

/* Bytes of the file that is written; 0: it is none */
int64_t writer_size(const struct writer *writer);

/* Do frames become documents of their own? Then one that has come as such may go on as it is: */
bool writer_passes(const struct writer *writer);
/* the document that the reader has found, and of which reader_whole() is true. */
int writer_pass(struct writer *writer, struct reader *from, struct failure *failure);

/* Completes the document (lengths, checksum) and reports what the file system had held back. */
int writer_close(struct writer *writer, struct failure *failure);

/* In a new process by fork(), of the program of somebody else [base/output.h]: the descriptors of the open writers' files
   lead elsewhere, so that nothing that this process does, or libhdf5 as it ends, reaches the files. */
void writer_forget_all(void);

/* Frees a writer that has failed, or NULL: whole frames that have their place stay, as those of a killed writer do. */
void writer_drop(struct writer *writer);
