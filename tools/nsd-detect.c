/* nsd-detect: the contacts of packings. */
#include "cli.h"
#include "detect.h"
#include "doc.h"
#include "options.h"
#include "sink.h"

static int export = -1;

static const struct cli_option own[] = {
    { CLI_CHOICE, 0, "fclib", &export, "local|global",
      "write the contact problem in the FCLIB format too", 0, 0, 0 },
    { 0 },
};
static const struct cli_option *const tables[] = { options_detect, own, NULL };

const struct cli_tool tool = {
    "nsd-detect", "[FILE ...]",
    "Finds the contacts in the predicted position q + dt/2 qdot, with their frames and gaps.\n"
    "Reads packings (every frame of a trajectory), writes each with its contacts.",
    tables,
    "  nsd-gen 500 | nsd-step -n 900 | nsd-cat --last | nsd-detect > contacts.h5\n"
    "  nsd-detect --fclib=local < packing.h5 > problem.h5\n"
};

/* The contact problem that FCLIB shows; freed when the frame is written. */
static void add_problem(struct frame *f, struct problem *p)
{
    struct why why = { 0 };
    if (problem_prepare(p, &f->packing, &f->contacts, 0, 1, ORDER_NATURAL, &why)) die_why(&why);
    f->export = p;
    f->export_global = export == 1;
}

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
        struct problem problem = { 0 };
        if (f.foreign) die(EX_DATAERR, "%s: an FCLIB problem has no bodies", reader_where(in));
        options_theta(&f.packing, false);
        if (detect_contacts(&f.contacts, &f.packing, options.gap, &why)) break;
        f.detected = true, f.reported = f.moved = false;
        if (export >= 0) add_problem(&f, &problem);
        f.stale = true;
        if (frame_note(&f, cli_history(), &why) || sink_frame(out, &f, &why)) break;
        if (export >= 0) problem_free(&problem);
    }
    if (why.status || sink_close(out, &why)) die_why(&why);
    frame_free(&f);
    reader_close(in);
    return 0;
}
