/* nsd-move: the second half of the step. */
#include "cli.h"
#include "doc.h"
#include "sink.h"
#include "step.h"

static const struct cli_option *const tables[] = { NULL };

const struct cli_tool tool = {
    "nsd-move", "[FILE ...]",
    "Moves the bodies by the reactions: velocities, then positions. One step is\n"
    "nsd-detect | nsd-solve | nsd-move. Reads solved contacts, writes packings.",
    tables, "  nsd-gen 4 | nsd-detect | nsd-solve -m sal | nsd-move > one.h5\n"
};

int tool_main(int argc, char **argv)
{
    struct reader *in;
    struct sink *out;
    struct frame f = { 0 };
    struct why why = { 0 };
    bool more;
    if (sink_open(&out, NULL, SINK_STREAM, &why) || reader_open(&in, argc, argv, &why))
        die_why(&why);
    while (!reader_next(in, &f, &more, &why) && more) {
        const char *where = reader_where(in);
        if (f.foreign) die(EX_DATAERR, "%s: an FCLIB problem has no bodies", where);
        if (!f.detected) die(EX_DATAERR, "%s: no group /contacts", where);
        if (f.moved) die(EX_DATAERR, "%s: these contacts have moved the bodies already", where);
        if (!f.contacts.solved && f.contacts.n)
            die(EX_DATAERR, "%s: the contacts are not solved: nsd-solve comes before", where);
        if (step_move(&f.packing, &f.contacts, &why)) break;
        f.detected = false;
        f.stale = true;
        if (frame_note(&f, cli_history(), &why) || sink_frame(out, &f, &why)) break;
    }
    if (why.status || sink_close(out, &why)) die_why(&why);
    frame_free(&f);
    reader_close(in);
    return 0;
}
