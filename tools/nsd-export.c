/* nsd-export: frames as files of other programs: ParaView, OVITO, ASE, tables, triangles. */
#include "base/output.h"
#include "convert/format.h"
#include "convert/vtk.h"
#include "file/reader.h"
#include "run/cli.h"
#include "run/tool_filter.h"
#include "state/selection.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static int to, part = PART_GRAINS;
static const char *output, *steps, *only;
static struct selection chosen; /* of the frame at hand, by --only */
static bool last;
static int64_t detail = 2;

static struct cli_choice to_choice(int k)
{
    const struct format *f = format_at(k);
    return f ? (struct cli_choice){ f->name, f->help } : (struct cli_choice){ 0 };
}

static struct cli_choice part_choice(int k)
{
    return (struct cli_choice){ k < PART_COUNT ? part_name[k] : NULL, NULL };
}

static const struct cli_option own[] = {
    { CLI_CHOICE, 't', "to", &to, .choice = to_choice,
      .help = "write this format [by the suffix of -o; vtp in a directory]" },
    { CLI_CHOICE, 'p', "part", &part, .choice = part_choice,
      .help = "write this part of a frame [grains; in a directory all]" },
    { CLI_TEXT, 'o', "output", &output, "FILE",
      .help = "write a FILE, a series 'f%05d.vtp' or a directory 'DIR/' [stdout]" },
    { CLI_TEXT, 0, "only", &only, "NAME,...",
      .help = "export only these walls, parts, groups, materials [all]" },
    { CLI_FLAG, 'l', "last", &last, .help = "process only the last frame" },
    { CLI_TEXT, 's', "frames", &steps, "A:B:K",
      .help = "process the frames of steps A to B, every K-th [all]" },
    { CLI_INT, 0, "detail", &detail, "N",
      .help = "use 20 * 4^N triangles for round grains in STL, surfaces [2]", .max = 6 },
    { 0 },
};
static const struct cli_option *const tables[] = { own, NULL };

const struct cli_tool tool = { "nsd-export", "[FILE ...]",
                               "Writes frames as files of other programs: one file, one file per "
                               "frame, or a directory\n"
                               "with lists (.pvd) that ParaView plays. Units are SI, forces in N.",
                               tables,
                               "  nsd-export -o paraview/ out.h5\n"
                               "  nsd-export --part contacts -o 'forces%05d.vtp' out.h5\n"
                               "  nsd-export --to csv --last out.h5 > grains.csv\n" };

/* ---- one file ---- */

/* A file that is written: moments in it so far, and what its first had */
struct sheaf {
    FILE *out;
    struct output file; /* where that is no standard output */
    int64_t moments;
    bool contacts, solved, sums;
    const struct format *format; /* of the moments in it */
    void *kept;                  /* by that, until the end */
};

static void sheaf_open(struct sheaf *s, const char *name)
{
    struct failure failure = { 0 };
    *s = (struct sheaf){ .out = stdout };
    if (name && !(s->out = output_stream(&s->file, name, &failure))) die_why(&failure);
}

static void sheaf_close(struct sheaf *s)
{
    struct failure failure = { 0 };
    if (s->moments && s->format->end && s->format->end(s->out, s->kept, &failure))
        die_why(&failure);
    if (s->out == stdout)
        finish_stdout();
    else if (output_stream_close(&s->file, s->out, &failure))
        die_why(&failure);
    s->out = NULL;
}

static int64_t exported; /* frames */

/* Of a frame that is long to write */
static void show_rows(int64_t done, int64_t of)
{
    progress("%lld frames, and %.0f %% of one", (long long)exported,
             100 * (double)done / (double)of);
}

static void sheaf_add(struct sheaf *s, const struct format *format, enum part what,
                      const struct frame *f)
{
    struct failure failure = { 0 };
    struct export_frame m = { &f->packing, f->detected ? &f->contacts : NULL,
                              (int)detail, &s->kept,
                              &chosen,     show_rows };
    bool solved = m.contacts && m.contacts->found;
    if (s->moments && !format->joins)
        die_usage("a %s file holds one frame: --last, --frames, or a series -o 'f%%05d.%s'",
                  format->name, format->ending);
    // the columns of a table are those of its first frame
    if (s->moments && what != PART_CONTACTS && s->solved && !solved)
        die(EX_DATAERR, "step %lld: no solved contacts, and frames before it have them",
            (long long)f->packing.step);
    if (s->moments && what != PART_CONTACTS && !s->solved) m.contacts = NULL;
    if (s->moments && what == PART_WALLS && s->sums != (f->packing.sums.n > 0))
        die(EX_DATAERR, "step %lld: sums of walls in some frames of one table, and not in others",
            (long long)f->packing.step);
    if (s->moments && what == PART_CONTACTS && s->solved != solved)
        die(EX_DATAERR, "step %lld: contacts solved and unsolved in one table",
            (long long)f->packing.step);
    if (!s->moments) s->solved = solved, s->sums = f->packing.sums.n > 0, s->format = format;
    struct some_bodies some = { 0 };
    if (chosen.bodies && !format->parts) {
        if (some_bodies_init(&some, m.packing, &chosen, &failure)) die_why(&failure);
        m.packing = &some.packing, m.contacts = NULL; // those have numbers of all bodies
    }
    if (format->write(s->out, &m, what, !s->moments, &failure))
        die(failure.status, "step %lld: %s", (long long)f->packing.step, failure.text);
    some_bodies_free(&some);
    s->moments++;
}

/* ---- a file a frame ---- */

/* Where the %0Nd (N from 1 to 9) of a series' name is; NULL: the name has no percent sign. */
static const char *number_in(const char *name)
{
    const char *at = strchr(name, '%');
    if (!at) return NULL;
    if (at[1] != '0' || at[2] < '1' || at[2] > '9' || at[3] != 'd' || strchr(at + 1, '%'))
        die_usage("--output: '%s' has not just one %%0Nd, N from 1 to 9", name);
    return at;
}

static void *memory_of(size_t size)
{
    void *memory = calloc(size, 1);
    if (!memory) die(EX_SOFTWARE, "no memory");
    return memory;
}

/* The series' k-th name. To be freed. */
static char *name_at(const char *series, int64_t k)
{
    const char *at = number_in(series);
    size_t room = strlen(series) + 32;
    char *name = memory_of(room);
    snprintf(name, room, "%.*s%0*lld%s", (int)(at - series), series, at[2] - '0', (long long)k,
             at + 4);
    return name;
}

static void write_file(const char *name, const struct format *format, enum part what,
                       const struct frame *f)
{
    struct sheaf s;
    sheaf_open(&s, name);
    sheaf_add(&s, format, what, f);
    sheaf_close(&s);
}

/* ---- a directory: all parts, and for ParaView a list of each ---- */

static struct {
    struct pvd list[PART_COUNT];
    bool ours; /* no other program writes into it */
} directory;

static bool is_directory(const char *name)
{
    struct stat st;
    size_t n = strlen(name);
    return (n && name[n - 1] == '/') || (!stat(name, &st) && S_ISDIR(st.st_mode));
}

static void directory_make(const char *name)
{
    if (mkdir(name, 0777) && errno != EEXIST) die(EX_IOERR, "%s: %s", name, strerror(errno));
    if (directory.ours) return;
    const int fd = open(name, O_RDONLY | O_DIRECTORY | O_CLOEXEC); // and locked while the tool runs
    if (fd >= 0 && flock(fd, LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK)
        die(EX_IOERR, "%s: another program is writing into it", name);
    directory.ours = true;
}

/* Is there anything of this part? A packing has a cell, walls, contacts or shapes, or it has not. */
static bool has_part(const struct frame *f, enum part what)
{
    const bool has[PART_COUNT] = { true, f->detected, f->packing.walls > 0,
                                   cell_repeats(&f->packing.cell), f->packing.shape != NULL };
    return has[what];
}

static void directory_add(const struct format *format, enum part what, const struct frame *f,
                          int64_t k)
{
    struct failure failure = { 0 };
    size_t room = strlen(output) + 64;
    char *path = memory_of(room), name[64];
    directory_make(output);
    snprintf(name, sizeof name, "%s-%05lld.%s", part_name[what], (long long)k, format->ending);
    snprintf(path, room, "%s/%s", output, name);
    write_file(path, format, what, f);
    snprintf(path, room, "%s/%s.pvd", output, part_name[what]);
    if (format->collected && pvd_add(&directory.list[what], path, name, f->packing.t, &failure))
        die_why(&failure);
    free(path);
}

/* ---- all of it ---- */

/* What is made of the frames: one file, a series of files, or a directory of them */
enum target { TARGET_FILE, TARGET_SERIES, TARGET_DIRECTORY };

static struct sheaf single;
static bool shown; /* whether any frame had the part that was asked for */

/* What --only names, which the part has: grains are of bodies, walls of walls, contacts of either. */
static void choose(const struct packing *p, enum target target)
{
    struct failure failure = { 0 };
    if (selection_init(&chosen, p, "--only", only, &failure))
        die(failure.status, "step %lld: %s", (long long)p->step, failure.text);
    if (!only || (target == TARGET_DIRECTORY && !cli_given(&part))) return;
    if (part == PART_WALLS ? chosen.walls : part == PART_CONTACTS || chosen.bodies) return;
    die(EX_DATAERR, "--only: '%s' names %s; --part %s has no such names", only,
        chosen.walls ? "walls" : "bodies", part_name[part]);
}

static void export(const struct format *format, enum target target, const struct frame *f,
                   int64_t k)
{
    if (target == TARGET_DIRECTORY) {
        for (int what = 0; what < PART_COUNT; what++) {
            bool wanted = cli_given(&part) ? what == part : format->parts || what == PART_GRAINS;
            if (!wanted || !has_part(f, what)) continue;
            if (!strcmp(format->name, "stl") && what != PART_GRAINS && what != PART_WALLS) continue;
            directory_add(format, what, f, k);
            shown = true;
        }
        return;
    }
    if (!has_part(f, part)) return;
    shown = true;
    if (target == TARGET_FILE) {
        sheaf_add(&single, format, part, f);
        return;
    }
    char *name = name_at(output, k);
    write_file(name, format, part, f);
    free(name);
}

static void add_frame(const struct format *format, enum target target, const struct frame *f,
                      const char *where, int64_t k)
{
    tool_wants_packing(f, where);
    choose(&f->packing, target);
    export(format, target, f, k);
    selection_free(&chosen);
}

static enum target target_of(const struct format **format)
{
    bool in_directory = output && is_directory(output);
    bool given = cli_given(&to);
    *format = given ? format_at(to) : output && !in_directory ? format_of_name(output) : NULL;
    if (in_directory && !given) *format = format_at(0);
    if (!*format && output && strstr(output, ".vtkhdf"))
        die_usage(
            "%s: python3 -m nsd.ondem write FILE -o %s writes ON-DEM's format, and nsd-cat --vtk "
            "a document for ParaView",
            output, output);
    if (!*format) die_usage("no format: give --to FORMAT, or an --output with its suffix");
    if (!(*format)->parts && part != PART_GRAINS)
        die_usage("--part: %s has grains only", (*format)->name);
    if (only && part == PART_CELL) die_usage("--only: the cell has no names");
    if (in_directory) return TARGET_DIRECTORY;
    if (output && number_in(output)) return TARGET_SERIES;
    if (!output && (*format)->binary && isatty(STDOUT_FILENO))
        die_usage("standard output is a terminal: %s is binary, use -o or a pipe", (*format)->name);
    return TARGET_FILE;
}

static void run(struct reader *in, const struct format *format, enum target target)
{
    struct frame f = { 0 };
    struct failure failure = { 0 };
    struct range range;
    bool more;
    if (!range_parse(&range, steps ? steps : ":")) die_usage("--frames: '%s' is not A:B:K", steps);
    if (last && steps) die_usage("--last and --frames exclude each other");
    if (target == TARGET_FILE) sheaf_open(&single, output);
    int64_t k = 0;
    if (last && !reader_last(in, &f, &more, &failure) && more)
        add_frame(format, target, &f, reader_where(in), k++);
    while (!last && !reader_next(in, steps ? &range : NULL, &f, &more, &failure) && more) {
        add_frame(format, target, &f, reader_where(in), k++);
        exported = k;
        progress("%lld frames", (long long)k);
    }
    progress_end();
    if (failure.status) die_why(&failure);
    if (!k) die(EX_DATAERR, "%s: no such frame", reader_where(in));
    if (!shown)
        die(EX_DATAERR, "%s: no %s in any frame", reader_where(in),
            part == PART_CONTACTS ? "group /contacts" : part_name[part]);
    for (int what = 0; what < PART_COUNT; what++) pvd_free(&directory.list[what]);
    if (target == TARGET_FILE) sheaf_close(&single);
    frame_free(&f);
}

int tool_main(int argc, char **argv)
{
    struct reader *in;
    struct failure failure = { 0 };
    const struct format *format;
    enum target target = target_of(&format);
    if (reader_open(&in, argc, argv, &failure)) die_why(&failure);
    if (output && reader_reads(argc, argv, output)) die_usage("%s: is also the input", output);
    run(in, format, target);
    reader_close(in);
    return 0;
}
