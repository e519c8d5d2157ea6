/*
 * io/frame.h: what a document says of one moment: a packing, its contacts, their solution, and what the
 * solve reported; or a contact problem from elsewhere (FCLIB) and its solution. Tools are functions
 * from frames to frames.
 */
#ifndef NSD_FRAME_H
#define NSD_FRAME_H

#include "io/fclib.h"
#include "problem/report.h"

struct frame {
    bool packed, detected, reported; /* packing, contacts, report mean something */
    bool moved; /* the contacts' reactions have already moved the packing: they led to it */
    struct packing packing;
    struct contacts contacts;
    struct report report;

    bool foreign; /* problem means something, and there is no packing */
    struct fclib problem;
    double *u; /* [n d] of its solution, NULL without one; r is problem.W.r */

    struct problem *export; /* also written as an FCLIB problem; or NULL */
    bool export_global;

    char *history;  /* one JSON line a command, each ended by a newline; or NULL */
    int64_t origin; /* the HDF5 file it came from while that is open, for what we do not know */
    bool unchecked; /* no checksum vouches for that file */
    bool stale;     /* the origin's FCLIB problem no longer belongs to this frame */
};

void frame_free(struct frame *);
/* The history grows by a command's line. */
int frame_note(struct frame *, const char *line, struct why *);

#endif
