#include "file/frame.h"

#include <stdlib.h>
#include <string.h>

void frame_free(struct frame *f)
{
    packing_free(&f->packing);
    contacts_free(&f->contacts);
    report_free(&f->report);
    if (f->foreign) fclib_free(&f->problem);
    unknown_free(f->unknown);
    free(f->u), free(f->history);
    *f = (struct frame){ 0 };
}

int frame_note(struct frame *f, const char *line, struct failure *failure)
{
    size_t had = f->history ? strlen(f->history) : 0, n = strlen(line);
    char *h = realloc(f->history, had + n + 2);
    if (!h) return failure_set(failure, EX_SOFTWARE, "no memory for the history");
    memcpy(h + had, line, n);
    memcpy(h + had + n, "\n", 2);
    f->history = h;
    return 0;
}
