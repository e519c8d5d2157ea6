/* nsd-cat: join, cut and thin streams and trajectories; stream a stream into a trajectory. */
#include "cli/cli.h"
#include "io/reader.h"
#include "io/writer.h"

static bool last, stream;
static const char *steps, *output;

static const struct cli_option own[] = {
    { CLI_FLAG, 'l', "last", &last, NULL, "only the very last frame", 0, 0, 0 },
    { CLI_TEXT, 's', "steps", &steps, "A:B:K", "only steps A to B, every K-th [all]", 0, 0, 0 },
    { CLI_FLAG, 0, "stream", &stream, NULL, "one document a frame, into a file too", 0, 0, 0 },
    { CLI_TEXT, 'o', "output", &output, "FILE", "where to [standard output]", 0, 0, true },
    { 0 },
};
static const struct cli_option *const tables[] = { own, NULL };

const struct cli_tool tool = {
    "nsd-cat", "[FILE ...]",
    "Copies frames. To a file they become one trajectory, the same as nsd-step would have written\n"
    "there; to a pipe, one document a frame.",
    tables,
    "  nsd-step -n 900 < a.h5 | nsd-cat --last | nsd-detect > contacts.h5\n"
    "  nsd-cat --steps 0:1000:100 out.h5 > thin.h5\n"
};

int tool_main(int argc, char **argv)
{
    struct reader *in;
    struct writer *out = NULL; // opened when there is something for it: a bad input costs no file
    struct frame f = { 0 };
    struct range range;
    struct why why = { 0 };
    bool more;
    int64_t copied = 0;
    if (!range_parse(&range, steps ? steps : ":")) die_usage("--steps: '%s' is not A:B:K", steps);
    if (last && steps) die_usage("--last and --steps exclude each other");
    if (reader_open(&in, argc, argv, &why)) die_why(&why);
    reader_copies(in);
    if (output && reader_reads(argc, argv, output)) die_usage("%s: is also the input", output);
    enum writer_kind kind = stream || last ? WRITER_STREAM : WRITER_TRAJECTORY;
    while (!(last ? reader_last(in, &f, &more, &why) : reader_next(in, &range, &f, &more, &why)) &&
           more) {
        if (!out && writer_open(&out, output, kind, &why)) break;
        if (writer_frame(out, &f, &why) == EX_DATAERR)
            die(EX_DATAERR, "%s: %s", reader_where(in), why.text);
        if (why.status) break;
        copied++;
        progress("%lld frames", (long long)copied);
        if (last) break;
    }
    if (why.status ||
        (!copied && why_set(&why, EX_DATAERR, "%s: no such frame", reader_where(in))) ||
        writer_close(out, &why))
        die_why(&why);
    frame_free(&f);
    reader_close(in);
    return 0;
}
