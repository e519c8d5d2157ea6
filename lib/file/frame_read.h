/*
 * file/frame_read.h: frames out of the datasets of a document [nsd-format(5), state/fields.h]. The
 * inverse of file/frame_write.h.
 */
#pragma once

#include "file/contact_rows.h"
#include "file/frame.h"
#include "file/report_rows.h"

/* An open document, and what it holds of each moment */
struct frame_read {
    struct source *source;
    int64_t frames;  /* 1 for an FCLIB problem */
    int64_t *step;   /* [frames] of a document with a packing; else NULL */
    double *time;    /* [frames] s; else NULL */
    bool repeats[3]; /* the box's edges */
    struct contact_rows contacts;
    struct memory_rows memory;
    struct report_rows reports;
    struct distributed *distributed; /* who may take the bodies, else NULL; borrowed */
};

/* The source's document; it stays the source's. EX_DATAERR: there are no frames in it. */
int frame_read_open(struct frame_read *document, struct source *source, struct failure *failure);
/* Reads frame k into an empty frame. Everything read is checked (EX_DATAERR). */
int frame_read_moment(struct frame_read *document, int64_t k, struct frame *frame,
                      struct failure *failure);
void frame_read_close(struct frame_read *document);
