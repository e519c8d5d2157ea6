/*
 * io/frame_read.h: frames out of the datasets of a document [nsd-format(5), io/layout.h]. The
 * inverse of io/frame_write.h.
 */
#ifndef NSD_FRAME_READ_H
#define NSD_FRAME_READ_H

#include "io/frame.h"
#include "io/table_read.h"

/* An open document, and what it holds of each moment */
struct frame_read {
    struct source *source;
    int64_t frames;      /* 1 for an FCLIB problem */
    int64_t *step;       /* [frames] of a document with a packing; else NULL */
    double *time;        /* [frames] s; else NULL */
    const char *reports; /* the group of the solver's reports, */
    int64_t *solved;     /* [solves] the steps that they are on */
    int64_t solves;
    bool repeats[3]; /* the box's edges */
    struct {
        struct report *row; /* [n] reports from `first` on, read at once: a question of the document
                               takes longer than its answer; or NULL */
        double *time;       /* [n] s */
        int64_t first, n;
        int64_t last; /* the row that was wanted last; -1: none yet */
    } ahead;
    struct {
        int64_t *step;  /* [blocks] of the frames whose contacts are kept, */
        int64_t *start; /* [blocks] the first row of each, */
        int64_t *count; /* [blocks] and the number of rows */
        int64_t blocks;
        int64_t last; /* the block that was read last; -1: none yet */
    } contacts;
};

/* The source's document; it stays the source's. EX_DATAERR: there are no frames in it. */
int frame_read_open(struct frame_read *document, struct source *source, struct why *why);
/* Reads frame k into an empty frame. Everything read is checked (EX_DATAERR). */
int frame_read_moment(struct frame_read *document, int64_t k, struct frame *frame, struct why *why);
void frame_read_close(struct frame_read *document);

#endif
