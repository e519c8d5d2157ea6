/*
 * file/served.h: an open document, all that is in it looked at before anything of it is believed. It
 * belongs to a process of its own (file/server.h), for no check of ours makes libhdf5 safe against
 * hostile bytes.
 *
 * A document is one file: links into others, data kept in others and filters from plugins are
 * refused. What a document does not store is not believed.
 */
#pragma once

#include "base/failure.h"
#include "file/h5.h"
#include "file/object.h"

#include <stdint.h>

/*
 * The account of one document: what reading it has cost so far. Each answer of the process that
 * reads draws its bytes, in the type that is wanted; what costs more than its bytes draws the rest. A small
 * document may neither fill the memory nor keep a tool busy, however its parts refer to one another.
 */

enum {
    BUDGET_LEAST =
        1 << 26, /* bytes that any document may be unpacked to, and of a frame be read: 64 MiB, */
    BUDGET_RATIO = 64,       /* or so many times its size: packed tables rarely reach 20 */
    BUDGET_ALL = 16,         /* in all so many times the least, */
    BUDGET_ALL_RATIO = 1000, /* and so many times its size: each frame reads again what all share */
    BUDGET_FRAME = 1 << 14   /* bytes that take as long as a frame in which there is nothing */
};

/* Bytes of answers, or work that takes as long: a byte is about a nanosecond */
struct budget {
    uint64_t size;               /* of the document */
    uint64_t frame, most_frame;  /* since the frame began, and at most */
    uint64_t all, most_document; /* since the document was opened */
};

void budget_open(struct budget *budget, uint64_t size, uint64_t allowed);
/* Both return 0, or EX_DATAERR: it is too much for this document. Another frame is begun; */
int budget_frame(struct budget *budget, struct failure *failure);
int budget_draw(struct budget *budget, uint64_t bytes, struct failure *failure);

/* What a walk has found under one name. */
struct served_entry {
    char *path;      /* absolute */
    haddr_t address; /* of the object in the file: several names may have one */
    hid_t set;       /* an open dataset, or -1 */
    bool owner;      /* it is closed here, not under another name */
    struct object object;
    hsize_t shape[OBJECT_RANK];
    uint64_t bytes;  /* that it holds */
    uint64_t stored; /* of them bytes that the file has, packed or not */
    uint64_t chunk;  /* bytes of an unpacked chunk, where it is packed */
    bool packed;     /* by a filter */
};

/* An open document */
struct served {
    hid_t file;                 /* -1: none */
    uint64_t size;              /* bytes of the document */
    uint64_t limit;             /* bytes that its datasets may hold in all, packed data unpacked */
    uint64_t unpacked;          /* bytes that they do hold */
    bool chunked;               /* some dataset is in chunks, as those of a trajectory are */
    int64_t count, room;        /* of entries */
    struct served_entry *entry; /* what is in it, in the order of a walk by names */
    int64_t *sorted;            /* [count] the entries by their paths */
};

/* Once in a process that serves: no plugins, no links into other files. */
void served_start(void);
/*
 * Takes the file over, to be closed by served_close even after a failure here, and looks at all that
 * is in it. limit 0: the usual one. EX_DATAERR: it is more than one file, or holds too much.
 */
int served_open(struct served *served, hid_t file, uint64_t size, uint64_t limit,
                struct failure *failure);
void served_close(struct served *served);

/* What is under this name; NULL: nothing. */
struct served_entry *served_find(const struct served *served, const char *path,
                                 struct failure *failure);
/* Its dataset, to be closed unless it is entry->set; -1 on failure. */
hid_t served_set(const struct served *served, const struct served_entry *entry,
                 struct failure *failure);
/* Is as much stored as is wanted of the dataset's first bytes? 0, or EX_DATAERR. */
int served_stored(const struct served_entry *entry, uint64_t bytes, struct failure *failure);
