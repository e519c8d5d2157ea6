/* nsd-stat: numbers of frames: fraction, stress, forces, profiles, distributions; and fields. */
#include "base/output.h"
#include "convert/fields_file.h"
#include "file/reader.h"
#include "measure/measures.h"
#include "measure/photo.h"
#include "measure/silhouette.h"
#include "run/cli.h"
#include "run/tool_filter.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *names, *only, *box, *layers, *point, *plane, *tracer, *steps, *fields_to;
static const char *view, *window, *photo, *silhouette_to;
static bool list, tsv, last, grains;
static double width, spacing;
static struct asked asked = ASKED_DEFAULT;

static const char *usual_layers(const void *to)
{
    (void)to;
    return "20 along gravity";
}

static const struct cli_option own[] = {
    { CLI_TEXT, 'm', "measures", &names, "A,B,...",
      .help = "compute these measures, or all [the default ones]" },
    { CLI_FLAG, 0, "list", &list, .help = "list all measures with their numbers and units" },
    { CLI_FLAG, 'g', "grains", &grains,
      .help = "print the measure grains as a table, for nsd-view --values" },
    { CLI_FLAG, 't', "tsv", &tsv, .help = "print a table separated by tabs [JSON lines]" },
    { CLI_TEXT, 'b', "box", &box, "X0,X1,...",
      .help = "measure only in this box, m; 2D: four numbers [all]" },
    { CLI_TEXT, 0, "layers", &layers, "AXIS:N", .usual = usual_layers,
      .help = "make N layers along x, y, z, or shells r" },
    { CLI_TEXT, 0, "point", &point, "X,Y,Z",
      .help = "set the point of torques, shells and the plane, m [0,0,0]" },
    { CLI_TEXT, 0, "plane", &plane, "NX,NY,NZ",
      .help = "set the normal of the plane of flux through the point" },
    { CLI_ABOVE, 0, "radius", &asked.radius, "M",
      .help = "limit the plane to a disc of this radius, m [none]", .max = INFINITY },
    { CLI_INT, 0, "bins", &asked.bins, "N", .help = "set the number of bins of distributions [50]",
      .min = 1, .max = 1e6 },
    { CLI_ABOVE, 0, "distance", &asked.distance, "M",
      .help = "set the largest distance of pairs, m [3 mean diameters]", .max = 1e300 },
    { CLI_TEXT, 0, "only", &only, "NAME,...",
      .help = "measure only these walls, parts, groups, materials [all]" },
    { CLI_ABOVE, 0, "wear", &asked.wear, "K",
      .help = "set Archard's coefficient of all walls, 1/Pa [that of the scene]", .max = 1e300 },
    { CLI_TEXT, 0, "tracer", &tracer, "MATERIAL",
      .help =
          "measure mixing of this material, or of large bodies [material of the first, or large]" },
    { CLI_ABOVE, 0, "sample", &asked.sample, "M",
      .help = "set the edge of the samples of mixing, m [3 mean diameters]", .max = 1e300 },
    { CLI_TEXT, 0, "view", &view, "AXIS",
      .help = "project silhouettes along x, y or z [y, 2D: z]" },
    { CLI_TEXT, 0, "window", &window, "X0,X1,Z0,Z1",
      .help = "set the edges of their picture: left, right, lower, upper, m" },
    { CLI_INT, 0, "pixels", &asked.pixels, "N",
      .help = "set their pixels across [400, those of the photograph]", .min = 1,
      .max = PHOTO_MOST },
    { CLI_TEXT, 0, "photo", &photo, "FILE.png",
      .help = "compare silhouettes with a photograph, dark on a bright ground" },
    { CLI_TEXT, 0, "silhouette", &silhouette_to, "FILE.png",
      .help = "also write the silhouette of all frames, and what differs, as a picture" },
    { CLI_TEXT, 'f', "fields", &fields_to, "FILE",
      .help = "also write coarse-grained fields: FILE.h5 or 'f%05d.vti'" },
    { CLI_ABOVE, 0, "width", &width, "M",
      .help = "set the width w of their Gaussian, m [mean diameter]", .max = 1e300 },
    { CLI_ABOVE, 0, "spacing", &spacing, "M",
      .help = "set the spacing of their grid, m [mean diameter, <= 32 points]", .max = 1e300 },
    { CLI_FLAG, 'l', "last", &last, .help = "process only the last frame" },
    { CLI_TEXT, 's', "frames", &steps, "A:B:K",
      .help = "process the frames of steps A to B, every K-th [all]" },
    { 0 },
};
static const struct cli_option *const tables[] = { own, NULL };

const struct cli_tool tool = {
    "nsd-stat", "[FILE ...]",
    "Measures frames: one line of JSON per frame, in SI units, forces in N. An undefined value is\n"
    "null, and the object \"why\" gives the reason.",
    tables,
    "  nsd-stat out.h5 | jq -r '[.time, .fraction.fraction, .energy.kinetic] | @tsv'\n"
    "  nsd-stat --last -m profile --tsv out.h5 > profile.tsv\n"
    "  nsd-stat --last -f fields.vti out.h5\n"
};

/* ---- what is asked ---- */

static const struct measure *chosen[MOST_MEASURES + 1];

static void choose(const struct measure *m)
{
    int k = 0;
    while (chosen[k] && chosen[k] != m) k++;
    if (k < MOST_MEASURES) chosen[k] = m;
}

static void choose_named(const char *text)
{
    struct failure failure = { 0 };
    if (measured_choose(chosen, text, &failure)) die_usage("%s", failure.text);
}

static void choose_all(void)
{
    if (grains && names) die_usage("--grains and --measures exclude each other");
    if (grains) tsv = true, choose(measure_named("grains", 6));
    if (names) choose_named(names);
    for (int k = 0; !names && !grains && measure_at(k); k++)
        if (measure_at(k)->usual) choose(measure_at(k));
    bool any_list = false;
    for (int k = 0; chosen[k]; k++) any_list = any_list || chosen[k]->list;
    if (tsv && any_list && chosen[1])
        die_usage("--tsv: a table has one measure of many rows, or many of one row");
}

static void choose_silhouette(void)
{
    if (!window) die_usage("--silhouette: the picture has no edges: give --window");
    if (tsv) die_usage("--silhouette and --tsv exclude each other");
    choose(measure_named("silhouette", 10));
}

static void parse_one(const char *name, const char *text)
{
    struct failure failure = { 0 };
    if (text && asked_set(&asked, name, text, &failure)) die_usage("%s", failure.text);
}

static void parse(void)
{
    parse_one("layers", layers), parse_one("point", point);
    parse_one("plane", plane), parse_one("box", box), parse_one("only", only);
    parse_one("tracer", tracer);
    parse_one("view", view), parse_one("window", window), parse_one("photo", photo);
}

/* ---- output ---- */

static void show_list(void)
{
    for (int k = 0; measure_at(k); k++) {
        const struct measure *m = measure_at(k);
        printf("%s%s: %s%s\n", k ? "\n" : "", m->name, m->help,
               m->usual  ? " (default)"
               : m->list ? " (many rows)"
                         : "");
        for (const struct quantity *q = m->quantity; q->name; q++) {
            bool axes = q->width == 3 && strcmp(q->name, "principal");
            const char *kind = axes ? " x, y, z" : q->width == 9 ? " 3 x 3" : "";
            printf("  %-19s %-6s %s%s%s\n", q->name, strcmp(q->unit, "1") ? q->unit : "", q->help,
                   *q->help && *kind ? "," : "", kind);
        }
    }
}

static void head_tsv(void)
{
    fputs("step\ttime", stdout);
    for (int k = 0; chosen[k]; k++)
        table_names(stdout, chosen[k]->quantity, chosen[1] ? chosen[k]->name : NULL);
    putchar('\n');
}

static void show_tsv(const struct packing *p, const struct table *t)
{
    int64_t rows = chosen[0] && chosen[0]->list ? t[0].rows : 1;
    static bool said[MOST_MEASURES];
    for (int64_t i = 0; i < rows; i++) {
        printf("%" PRId64 "\t", p->step);
        print_number(stdout, p->t, "nan");
        for (int k = 0; chosen[k]; k++) table_numbers(stdout, &t[k], i);
        putchar('\n');
    }
    for (int k = 0; chosen[k]; k++)
        if (*t[k].null && !said[k]) {
            said[k] = true;
            warn("%s: step %" PRId64 ": %s", chosen[k]->name, p->step, t[k].null);
        }
}

/* ---- fields ---- */

static struct {
    struct fields fields;
    struct fields_file *file;
    int64_t frames;
} coarse;

static bool ends(const char *name, const char *ending)
{
    size_t n = strlen(name), m = strlen(ending);
    return n > m && !strcmp(name + n - m, ending);
}

/* The %0Nd, N from 1 to 9, of a series' name; NULL: it has no percent sign */
static const char *number_in(const char *name)
{
    const char *at = strchr(name, '%');
    if (!at) return NULL;
    if (at[1] != '0' || at[2] < '1' || at[2] > '9' || at[3] != 'd' || strchr(at + 1, '%'))
        die_usage("--fields: '%s' has not just one %%0Nd, N from 1 to 9", name);
    return at;
}

static void write_vti(const struct packing *p)
{
    const char *at = number_in(fields_to);
    char name[4096];
    if (!at && coarse.frames)
        die_usage("--fields: a .vti holds one frame: --last, or 'f%%05d.vti'");
    if (at)
        snprintf(name, sizeof name, "%.*s%0*lld%s", (int)(at - fields_to), fields_to, at[2] - '0',
                 (long long)coarse.frames, at + 4);
    else
        snprintf(name, sizeof name, "%s", fields_to);
    struct output file;
    struct failure failure = { 0 };
    FILE *out = output_stream(&file, name, &failure);
    if (out) vti_write(out, &coarse.fields, p->step, p->t);
    if (!out || output_stream_close(&file, out, &failure)) die_why(&failure);
}

static void add_fields(const struct snapshot *s, struct failure *failure)
{
    bool document = ends(fields_to, ".h5");
    // the grid of the first frame is that of all
    if (!coarse.frames && fields_init(&coarse.fields, s, width, spacing, failure)) return;
    if (fields_set(&coarse.fields, s, failure)) return;
    if (!document) {
        write_vti(s->p);
    } else {
        if (!coarse.frames &&
            fields_file_open(&coarse.file, fields_to, &coarse.fields, cli_history(), failure))
            return;
        if (fields_file_add(coarse.file, &coarse.fields, s->p->step, s->p->t, failure)) return;
    }
    coarse.frames++;
}

/* ---- frames ---- */

static struct frame_memory first, before;

/* Steps that have not converged: their reactions are no solution, nor is the motion that these make. */
static struct {
    double before;       /* of all that led to the frame before */
    double steps, first; /* that led to the frames; the first of them */
    int64_t frames;      /* whose own step is one */
} missed;

/* How many since the frame before; of another run all; NaN: not known */
static double count_missed(const struct frame *f)
{
    const struct account_entry *e = &f->account.worst[ACCOUNT_UNCONVERGED];
    if (!f->account.steps) return NAN;
    const double n = e->value - (e->value >= missed.before ? missed.before : 0);
    if (n > 0 && missed.steps == 0) missed.first = e->step;
    missed.before = e->value, missed.steps += n;
    missed.frames += f->reported && !f->report.converged;
    return n;
}

static void say_missed(int64_t frames)
{
    if (missed.steps > 0)
        warn("%.0f steps NOT CONVERGED, the first is step %.0f: their forces, and the motion by "
             "them, "
             "are no solution; of %lld frames %lld have such forces (key unconverged)",
             missed.steps, missed.first, (long long)frames, (long long)missed.frames);
}

static void show(const struct frame *f, const char *where, int64_t k, struct failure *failure)
{
    struct snapshot s;
    struct table t[MOST_MEASURES];
    tool_wants_packing(f, where);
    if (asked.boxed && f->packing.dim == 3 && !isfinite(asked.lo[2]))
        die_usage("--box: '%s' has four numbers, and the bodies are balls", box);
    snapshot_init(&s, &f->packing, f->detected ? &f->contacts : NULL, f->moved, &asked, failure);
    if (k) s.first = &first, s.before = &before;
    s.unconverged = count_missed(f), s.report = f->reported ? &f->report : NULL;
    if (fields_to && s.only.bodies)
        die(EX_DATAERR, "--only: fields are of all bodies, not of a group or material");
    if (measured_run(t, chosen, &s, failure)) {
        measured_free(t), snapshot_free(&s);
        return;
    }
    if (tsv) {
        show_tsv(s.p, t);
    } else {
        measured_json(stdout, &s, chosen, t);
        putchar('\n');
    }
    measured_free(t);
    if (fflush(stdout)) finish_stdout(); // a line is seen when its frame is there
    if (fields_to) add_fields(&s, failure);
    if (measured_remember(chosen) && !failure->status)
        measured_keep(chosen, &s, &first, &before, failure);
    snapshot_free(&s);
}

static void run(struct reader *in)
{
    struct frame f = { 0 };
    struct failure failure = { 0 };
    struct range range;
    bool more;
    int64_t k = 0;
    if (!range_parse(&range, steps ? steps : ":")) die_usage("--frames: '%s' is not A:B:K", steps);
    if (last && steps) die_usage("--last and --frames exclude each other");
    if (tsv) head_tsv();
    if (last && !reader_last(in, &f, &more, &failure) && more)
        show(&f, reader_where(in), k++, &failure);
    while (!last && !failure.status &&
           !reader_next(in, steps ? &range : NULL, &f, &more, &failure) && more) {
        show(&f, reader_where(in), k++, &failure);
        progress("%lld frames", (long long)k);
    }
    progress_end();
    if (coarse.file && !failure.status) fields_file_close(coarse.file, &failure);
    if (silhouette_to && before.cover && !failure.status)
        silhouette_write(silhouette_to, &before, &asked, &failure);
    if (failure.status) die_why(&failure);
    if (!k) die(EX_DATAERR, "%s: no such frame", reader_where(in));
    say_missed(k);
    frame_free(&f);
    frame_memory_free(&first), frame_memory_free(&before), fields_free(&coarse.fields);
}

int tool_main(int argc, char **argv)
{
    struct reader *in;
    struct failure failure = { 0 };
    if (list) {
        begin_stdout();
        show_list();
        finish_stdout();
        return 0;
    }
    parse();
    choose_all();
    if (silhouette_to) choose_silhouette();
    if (fields_to && !ends(fields_to, ".h5") && !ends(fields_to, ".vti"))
        die_usage("--fields: '%s' does not end in .h5 or .vti", fields_to);
    if (fields_to && ends(fields_to, ".vti")) number_in(fields_to);
    if (reader_open(&in, argc, argv, &failure)) die_why(&failure);
    if (fields_to && reader_reads(argc, argv, fields_to))
        die_usage("%s: is also the input", fields_to);
    if (silhouette_to &&
        (reader_reads(argc, argv, silhouette_to) || (photo && !strcmp(photo, silhouette_to))))
        die_usage("%s: is also the input", silhouette_to);
    begin_stdout();
    run(in);
    reader_close(in);
    finish_stdout();
    return 0;
}
