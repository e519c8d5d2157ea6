/*
 * file/budget.h: the account of one document: what reading it has cost so far. Each answer of the process that
 * reads draws its bytes, in the type that is wanted; what costs more than its bytes draws the rest. A small
 * document may neither fill the memory nor keep a tool busy, however its parts refer to one another.
 */
#ifndef NSD_BUDGET_H
#define NSD_BUDGET_H

#include "base/failure.h"

#include <stdint.h>

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

/* Bytes that the datasets of a document of this size may hold; allowed: by the user, 0: not more than usual */
uint64_t budget_unpacked(uint64_t size, uint64_t allowed);

void budget_open(struct budget *budget, uint64_t size, uint64_t allowed);
/* Both return 0, or EX_DATAERR: it is too much for this document. Another frame is begun; */
int budget_frame(struct budget *budget, struct failure *failure);
int budget_draw(struct budget *budget, uint64_t bytes, struct failure *failure);

#endif
