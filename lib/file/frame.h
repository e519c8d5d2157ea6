/*
 * file/frame.h: a frame is what a document says of one moment: a packing, its contacts, their
 * solution, and the report of the solve; or else a contact problem from elsewhere (FCLIB) and its
 * solution. Tools are functions from frames to frames.
 */
#pragma once

#include "file/fclib.h"
#include "file/unknown.h"
#include "state/account.h"

struct distributed;

struct frame {
    bool packed;   /* packing is valid, */
    bool detected; /* contacts are, */
    bool reported; /* report is */
    bool moved;    /* the contacts' reactions have led to this packing, not from it */
    bool forces;   /* reactions are written as forces in space, too */
    struct packing packing;
    struct distributed
        *distributed; /* who has its bodies [file/distributed.h], borrowed; NULL: the packing */
    struct contacts contacts;
    struct report report;
    struct account account; /* of the trajectory so far, by the runs that have made it */

    bool foreign; /* problem is valid, and there is no packing */
    struct fclib problem;
    double *u; /* [n d] m/s, of the problem's solution; NULL: not solved. r is problem.W.r */

    const struct problem *export; /* borrowed: to be written as an FCLIB problem, too; or NULL */
    bool export_global;           /* in global form */
    /* fclib_write_problem(): whoever exports nothing does not link it */
    int (*write_export)(const struct problem *p, bool global, int64_t file,
                        struct failure *failure);

    char *history;           /* a JSON line for each command, each ended by a newline; or NULL */
    struct unknown *unknown; /* what nsd does not know in the document it came from; or NULL */
    bool stale;              /* an FCLIB problem among it no longer belongs to this frame */
};

/* Frees what the frame owns and leaves it empty. */
void frame_free(struct frame *frame);
/* Adds a command's line to the history. */
int frame_note(struct frame *frame, const char *line, struct failure *failure);
