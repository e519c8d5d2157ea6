/*
 * run/document.h: documents in memory [nsd-format(5)].
 */
#pragma once

#include "file/frame.h"

#include <stddef.h>

/* The last frame of a document of these bytes, which needs no header of nsd's own: an HDF5 file. Read as files are, with bounds
   on time and memory. *frame is freed first. EX_DATAERR, where it is no document of a packing */
int document_read(struct frame *frame, const void *bytes, size_t size, struct failure *failure);
/* The document of a frame, in its own memory, to be freed; NULL: no memory */
char *document_write(const struct frame *frame, size_t *size, struct failure *failure);
/* The last frame of a file; the same */
int document_read_file(struct frame *frame, const char *path, struct failure *failure);
