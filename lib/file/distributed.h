/*
 * file/distributed.h: the bodies of a frame where several processes have them, each some, and none has all: who reads
 * a document hands their rows over, block after block, and who writes one has them written. The frame's
 * packing has everything else, and no body.
 */
#pragma once

#include "file/layout.h"

enum {
    DISTRIBUTED_PLACES = BODY_COLUMNS /* datasets of bodies, at most */
};

/* A dataset of all bodies that has been made, and no numbers in it */
struct unfilled {
    char path[80];
    const struct field *column;
    int64_t frame; /* its row [bodies][width]; -1: the dataset is [bodies] */
};

struct distributed {
    int64_t n; /* bodies of all processes, of the frame that was taken last */
    /* Shall the n bodies of a frame with these settings be taken? Else the packing has them. */
    bool (*wants)(struct distributed *e, const struct packing *settings, int64_t n);
    /* Bodies first .. first + block->n - 1, checked; blocks follow each other from 0 on. */
    int (*take)(struct distributed *e, const struct packing *block, int64_t first,
                struct failure *failure);
    /* Fills the datasets of `file`, which is open and flushed; path: where all processes find it, NULL where
       there is no such file. EX_IOERR: not written. */
    int (*give)(struct distributed *e, hid_t file, const char *path, const struct unfilled *place,
                int places, struct failure *failure);
};
