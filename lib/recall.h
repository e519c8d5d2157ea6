/*
 * recall.h: frames out of the datasets of a document [nsd-format(5), layout.h]: the inverse of record.h.
 */
#ifndef NSD_RECALL_H
#define NSD_RECALL_H

#include "rows.h"

/* A document that is open, and what there is of each moment */
struct recall {
    struct rows rows; /* file -1: none is open */
    int64_t frames;   /* 1 of an FCLIB problem */
    int64_t *step;    /* [frames] of a packing's document, else NULL, */
    double *time;     /* [frames] */
    int64_t *solved;  /* [solves] steps that /observables/solver tells of */
    int64_t solves;
    struct {
        int64_t *step, *start, *count; /* [blocks] whose contacts /contacts has, and where */
        int64_t blocks;
    } contacts;
};

/* Takes the file over, to be closed even where this fails (EX_DATAERR). */
int recall_open(struct recall *, hid_t file, struct why *);
/* Moment k into a frame that is empty. All that is read is checked (EX_DATAERR). */
int recall_frame(struct recall *, int64_t k, struct frame *, struct why *);
void recall_close(struct recall *);

#endif
