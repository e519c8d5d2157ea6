#include "filter.h"

#include "cli.h"
#include "doc.h"
#include "sink.h"

void filter_run(int files, char *const *file, void (*each)(struct frame *, const char *where))
{
    struct reader *in;
    struct sink *out;
    struct frame f = { 0 };
    struct why why = { 0 };
    bool more;
    if (sink_open(&out, NULL, SINK_STREAM, &why) || reader_open(&in, files, file, &why))
        die_why(&why);
    while (!reader_next(in, NULL, &f, &more, &why) && more) {
        each(&f, reader_where(in));
        if (frame_note(&f, cli_history(), &why) || sink_frame(out, &f, &why)) break;
    }
    if (why.status || sink_close(out, &why)) die_why(&why);
    frame_free(&f);
    reader_close(in);
}

void filter_wants_packing(const struct frame *f, const char *where)
{
    if (!f->packed) die(EX_DATAERR, "%s: an FCLIB problem has no bodies", where);
}

void filter_wants_contacts(const struct frame *f, const char *where)
{
    filter_wants_packing(f, where);
    if (!f->detected) die(EX_DATAERR, "%s: no group /contacts: nsd-detect comes before", where);
    if (f->moved)
        die(EX_DATAERR,
            "%s: its contacts have moved the bodies already; nsd-detect the next step's", where);
}

void filter_wants_solution(const struct frame *f, const char *where)
{
    filter_wants_contacts(f, where);
    if (!f->contacts.found && f->contacts.n)
        die(EX_DATAERR, "%s: the contacts are not solved: nsd-solve comes before", where);
}
