#include "run/tool_filter.h"

#include "file/reader.h"
#include "file/writer.h"
#include "run/cli.h"

void tool_filter(int files, char *const *file, void (*each)(struct frame *, const char *where))
{
    struct reader *in;
    struct writer *out;
    struct frame f = { 0 };
    struct failure failure = { 0 };
    bool more;
    if (writer_open(&out, cli_output(), WRITER_STREAM, &failure) ||
        reader_open(&in, files, file, &failure))
        die_why(&failure);
    reader_copies(in);
    while (!reader_next(in, NULL, &f, &more, &failure) && more) {
        each(&f, reader_where(in));
        if (frame_note(&f, cli_history(), &failure) || writer_frame(out, &f, &failure)) break;
    }
    if (failure.status || writer_close(out, &failure)) die_why(&failure);
    frame_free(&f);
    reader_close(in);
}

void tool_wants_packing(const struct frame *f, const char *where)
{
    if (!f->packed) die(EX_DATAERR, "%s: an FCLIB problem has no bodies", where);
}

void tool_wants_contacts(const struct frame *f, const char *where)
{
    tool_wants_packing(f, where);
    if (!f->detected) die(EX_DATAERR, "%s: no group /contacts: nsd-detect comes before", where);
    if (f->moved)
        die(EX_DATAERR,
            "%s: its contacts have moved the bodies already; nsd-detect the next step's", where);
}

void tool_wants_solution(const struct frame *f, const char *where)
{
    tool_wants_contacts(f, where);
    if (!f->contacts.found && f->contacts.n)
        die(EX_DATAERR, "%s: the contacts are not solved: nsd-solve comes before", where);
}
