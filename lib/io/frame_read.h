/*
 * io/frame_read.h: frames out of the datasets of a document [nsd-format(5), io/layout.h]: the inverse of io/frame_write.h.
 */
#ifndef NSD_FRAME_READ_H
#define NSD_FRAME_READ_H

#include "io/table_read.h"

/* A document that is open, and what there is of each moment */
struct frame_read {
    struct table_read rows; /* file -1: none is open */
    int64_t frames;         /* 1 of an FCLIB problem */
    int64_t *step;          /* [frames] of a packing's document, else NULL, */
    double *time;           /* [frames] */
    int64_t *solved;        /* [solves] steps that /observables/solver tells of */
    int64_t solves;
    struct {
        int64_t *step, *start, *count; /* [blocks] whose contacts /contacts has, and where */
        int64_t blocks;
    } contacts;
};

/* Takes the file over, to be closed even where this fails (EX_DATAERR). */
int frame_read_open(struct frame_read *, hid_t file, struct why *);
/* Moment k into a frame that is empty. All that is read is checked (EX_DATAERR). */
int frame_read_moment(struct frame_read *, int64_t k, struct frame *, struct why *);
void frame_read_close(struct frame_read *);

#endif
