/* nsd-cat: joins, cuts and thins streams and trajectories, and turns one into the other. */
#include "convert/vtk.h"
#include "file/reader.h"
#include "file/writer.h"
#include "run/cli.h"

#include <string.h>

static bool last, stream;
static const char *steps;
static int vtk;

static struct cli_choice vtk_choice(int k)
{
    static const struct cli_choice parts[] = {
        { "grains", "points: VTK 9.3, ParaView 5.12" },
        { "all", "also surfaces of shapes and walls: VTK 9.6, ParaView 6.1" },
    };
    return k < 2 ? parts[k] : (struct cli_choice){ 0 };
}

static const struct cli_option own[] = {
    { CLI_FLAG, 'l', "last", &last, .help = "process only the last frame" },
    { CLI_TEXT, 's', "frames", &steps, "A:B:K",
      .help = "process the frames of steps A to B, every K-th [all]" },
    { CLI_FLAG, 0, "stream", &stream, .help = "write one document per frame, also to a file" },
    { CLI_CHOICE, 0, "vtk", &vtk, .choice = vtk_choice, .silent = true,
      .help = "add /VTKHDF, with which ParaView opens the document [no]" },
    { 0 },
};
static const struct cli_option *const tables[] = { own, NULL };

const struct cli_tool tool = {
    "nsd-cat", "[FILE ...]",
    "Copies frames. To a file they become one trajectory, as nsd-step would have written it; to a\n"
    "pipe, one document per frame.",
    tables,
    "  nsd-cat --last out.h5 | nsd-detect > contacts.h5\n"
    "  nsd-cat --frames 0:1000:100 out.h5 > thin.h5\n"
    "  nsd-cat --vtk grains out.h5 > paraview.h5\n"
};

/* A trajectory says of the first of its reports alone how it was solved: a warning, once, where another was solved otherwise */
static void warn_of_other_solver(const struct report *r, const char *where)
{
    static struct report first;
    static bool any, warned;
    if (!any) memcpy(first.method, r->method, sizeof first.method);
    if (!any) first.criterion = r->criterion, first.eps = r->eps, any = true;
    bool same =
        !strcmp(first.method, r->method) && first.criterion == r->criterion && first.eps == r->eps;
    if (same || warned) return;
    warned = true;
    warn("%s: solved by -m %s --criterion %s --tolerance %g; the trajectory states -m %s "
         "--criterion %s "
         "--tolerance %g for all: --stream keeps each",
         where, r->method, criterion_name[r->criterion], r->eps, first.method,
         criterion_name[first.criterion], first.eps);
}

int tool_main(int argc, char **argv)
{
    struct reader *in;
    struct writer *out = NULL; // opened with the first frame
    struct frame f = { 0 };
    struct range range;
    struct failure failure = { 0 };
    bool more;
    int64_t copied = 0;
    if (!range_parse(&range, steps ? steps : ":")) die_usage("--frames: '%s' is not A:B:K", steps);
    if (last && steps) die_usage("--last and --frames exclude each other");
    if (reader_open(&in, argc, argv, &failure)) die_why(&failure);
    reader_copies(in);
    enum writer_kind kind = stream || last ? WRITER_STREAM : WRITER_COPY;
    while (
        !(last ? reader_last(in, &f, &more, &failure) : reader_find(in, &range, &more, &failure)) &&
        more) {
        bool whole = !last && reader_whole(in);
        if (!last && !whole && reader_take(in, &f, &failure)) break;
        if (!out && (writer_open(&out, cli_output(), kind, &failure) ||
                     (cli_given(&vtk) && writer_vtk(out, vtk ? &vtk_parts : NULL, &failure))))
            break;
        if (whole && writer_passes(out)) {
            if (writer_pass(out, in, &failure)) break;
        } else {
            if (whole && reader_take(in, &f, &failure)) break;
            if (f.reported && !stream && !last && !writer_passes(out))
                warn_of_other_solver(&f.report, reader_where(in));
            if (writer_frame(out, &f, &failure) == EX_DATAERR)
                die(EX_DATAERR, "%s: %s", reader_where(in), failure.text);
            if (failure.status) break;
        }
        copied++;
        progress("%lld frames", (long long)copied);
        if (last) break;
    }
    if (failure.status ||
        (!copied && failure_set(&failure, EX_DATAERR, "%s: no such frame", reader_where(in))) ||
        writer_close(out, &failure))
        die_why(&failure);
    frame_free(&f);
    reader_close(in);
    return 0;
}
