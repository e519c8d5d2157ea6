/* file/budget.c: what reading a document may cost [file/budget.h]. */
#include "file/budget.h"

uint64_t budget_unpacked(uint64_t size, uint64_t allowed)
{
    uint64_t usual = size > BUDGET_LEAST / BUDGET_RATIO ? size * BUDGET_RATIO : BUDGET_LEAST;
    return allowed > usual ? allowed : usual;
}

void budget_open(struct budget *b, uint64_t size, uint64_t allowed)
{
    *b = (struct budget){ .size = size, .most_frame = budget_unpacked(size, allowed) };
    b->most_document =
        BUDGET_ALL * (allowed > BUDGET_LEAST ? allowed : BUDGET_LEAST) + BUDGET_ALL_RATIO * size;
}

int budget_frame(struct budget *b, struct failure *failure)
{
    b->frame = 0;
    return budget_draw(b, BUDGET_FRAME, failure);
}

int budget_draw(struct budget *b, uint64_t bytes, struct failure *failure)
{
    uint64_t left = b->most_frame - b->frame, left_of_all = b->most_document - b->all;
    if (bytes <= left && bytes <= left_of_all) return b->frame += bytes, b->all += bytes, 0;
    return failure_set(
        failure, EX_DATAERR,
        bytes > left ? "a frame of it takes more than %llu MB of memory or work, and it "
                       "has %llu kB (--unpack allows more)"
                     : "its frames take more than %llu MB of work, and it has %llu kB "
                       "(--unpack allows more)",
        (unsigned long long)((bytes > left ? b->most_frame : b->most_document) / 1000000),
        (unsigned long long)(b->size / 1000 + 1));
}
