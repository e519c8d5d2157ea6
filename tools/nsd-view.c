/* nsd-view: draws the bodies, one picture, a series or a film. */
#include "base/team.h"
#include "draw/film.h"
#include "draw/images.h"
#include "draw/overlay.h"
#include "draw/paint.h"
#include "draw/svg.h"
#include "file/reader.h"
#include "run/cli.h"
#include "run/tool_filter.h"
#include "state/selection.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct cli_every every; /* 0, 0: one picture */
static int64_t step = -1, samples = 3, threads = 1, follow = -1, rate = 25;
static int colour = COLOUR_RADIUS, walls;
static bool plain, bare, svg, strays;
static double perspective, pale;
static struct overlay over;
static const char *output, *range, *size, *camera = "30,15", *upwards, *box, *background = "ffffff",
                                          *cut, *only, *table, *wanted, *solid_names,
                                          *surface_range;
static int surface = SURFACE_NAME;
static struct solid_walls solid;

static struct cli_choice colour_choice(int k)
{
    if (k == COLOUR_COUNT) return (struct cli_choice){ NULL, NULL };
    const char *about = k == COLOUR_CONTACTS ? "number of contacts that push the body"
                        : k == COLOUR_FORCE  ? "sum of its normal forces, N"
                        : k == COLOUR_VALUE  ? "column of --values"
                                             : NULL;
    return (struct cli_choice){ colour_meaning[k].name, about };
}

enum { GLASS, LINES };

static struct cli_choice walls_choice(int k)
{
    static const struct cli_choice choices[] = { { "glass", "half transparent" },
                                                 { "lines", "edges and outlines only" },
                                                 { NULL, NULL } };
    return choices[k];
}

static struct cli_choice surface_choice(int k)
{
    if (k == SURFACE_COUNT) return (struct cli_choice){ NULL, NULL };
    return (struct cli_choice){ surface_meaning[k].name, surface_meaning[k].help };
}

static const struct cli_option own[] = {
    { CLI_INT, 's', "step", &step, "N", .max = 1e15,
      .help = "draw the frame of step N [last frame]" },
    { CLI_EVERY, 0, "every", &every, "K|T", .max = 1e15,
      .help = "draw every K-th frame, or one per time T: 0.1s, 5ms [one picture]" },
    { CLI_TEXT, 'o', "output", &output, "FILE", .silent = true,
      .help = "write to FILE; for a series 'f%05d.png' or film.mp4 [stdout]" },
    { CLI_INT, 0, "rate", &rate, "N", .min = 1, .max = 240,
      .help = "show N pictures per second in a film [25]" },
    { CLI_FLAG, 0, "svg", &svg, .help = "write SVG instead of PNG; 2D only" },
    { CLI_CHOICE, 'c', "colour", &colour, .choice = colour_choice,
      .help = "colour bodies by this quantity [radius]" },
    { CLI_TEXT, 0, "range", &range, "LO,HI",
      .help = "set the ends of the palette [all values; speeds from 0]" },
    { CLI_TEXT, 0, "values", &table, "FILE",
      .help = "read a table with the columns id, optionally step, and numbers" },
    { CLI_TEXT, 0, "column", &wanted, "NAME", .help = "show this column of --values [the last]" },
    { CLI_FLAG, 0, "network", &over.network,
      .help = "draw one line per pushing contact, its width by its force" },
    { CLI_FLAG, 0, "bonds", &over.bonds,
      .help = "draw bonds: green whole, red breaking, blue liquid" },
    { CLI_FLAG, 0, "contacts", &over.contacts,
      .help = "draw a dot at each contact, coloured by status" },
    { CLI_ABOVE, 0, "force", &over.force, "N", .min = 0, .max = 1e300,
      .help = "set the force of the widest line, N [largest of the frame]" },
    { CLI_REAL, 0, "pale", &pale, "P", .min = 0, .max = 1,
      .help = "mix bodies with the background, 0 to 1 [0; --network 0.6]" },
    { CLI_FLAG, 0, "bare", &bare, .help = "omit the legend of colours, size and time" },
    { CLI_FLAG, 0, "plain", &plain, .help = "omit the marks that show rotations" },
    { CLI_TEXT, 0, "size", &size, "WxH", .help = "set the size in pixels [longer side 900]" },
    { CLI_TEXT, 0, "camera", &camera, "AZ,EL",
      .help = "view from azimuth AZ and elevation EL, degrees; 3D [30,15]" },
    { CLI_TEXT, 0, "up", &upwards, "X,Y[,Z]",
      .help = "draw this direction upwards [against gravity; else z, in 2D y]" },
    { CLI_REAL, 0, "perspective", &perspective, "DEG", .min = 0, .max = 120,
      .help = "use perspective with this angle of view; 3D [0, none]" },
    { CLI_TEXT, 0, "clip", &cut, "NX,NY,NZ,D",
      .help = "cut away bodies beyond NX x + NY y + NZ z = D, m [nothing]" },
    { CLI_INT, 0, "follow", &follow, "ID", .min = 0, .max = INT32_MAX,
      .help = "keep the body with this id in its place in a series [none]" },
    { CLI_FLAG, 0, "strays", &strays, .help = "include outliers and far walls in the picture" },
    { CLI_TEXT, 0, "box", &box, "X0,X1,Y0,Y1[,Z0,Z1]",
      .help = "draw only bodies with their centre in this box, m [all]" },
    { CLI_TEXT, 0, "only", &only, "NAME,...",
      .help = "draw only bodies of these groups and materials [all]" },
    { CLI_CHOICE, 0, "walls", &walls, .choice = walls_choice,
      .help = "draw walls in this way [glass]" },
    { CLI_TEXT, 0, "solid", &solid_names, "NAME,...",
      .help = "draw these walls and parts solid, by name or number [none]" },
    { CLI_CHOICE, 0, "surface", &surface, .choice = surface_choice,
      .help = "colour solid walls by this; without --solid all are solid [name]" },
    { CLI_TEXT, 0, "surface-range", &surface_range, "LO,HI",
      .help = "set the ends of their palette [0, the largest of the frame]" },
    { CLI_TEXT, 0, "background", &background, "RRGGBB",
      .help = "set the background colour [ffffff]" },
    { CLI_INT, 0, "samples", &samples, "N", .min = 1, .max = 8,
      .help = "average N x N samples per pixel [3]" },
    { CLI_INT, 'j', "threads", &threads, "N", .min = 1, .max = 1024, .silent = true,
      .help = "use N threads; pictures do not depend on N [1]" },
    { 0 },
};
static const struct cli_option *const tables[] = { own, NULL };

const struct cli_tool tool = {
    "nsd-view", "[FILE ...]",
    "Draws a packing as PNG: the last frame or another one, a series, or a film.", tables,
    "  nsd-gen 500 | nsd-view > balls.png\n"
    "  nsd-view -c speed --every 10 -o 'film%05d.png' out.h5\n"
    "  nsd-view --every 1 --size 360x640 -o film.mp4 out.h5\n"
};

/* ---- what options say ---- */

/* Reads n finite numbers with commas between; false where text is anything else. */
static bool numbers(const char *text, int n, double *x)
{
    for (int i = 0; i < n; i++) {
        char *end;
        x[i] = strtod(text, &end);
        if (end == text || isspace((unsigned char)*text) || !isfinite(x[i])) return false;
        if (*end != (i < n - 1 ? ',' : 0)) return false;
        text = end + 1;
    }
    return true;
}

/* Reads a number of pixels that ends with `stop`, and moves text behind that. */
static bool pixels(const char **text, char stop, int *n)
{
    char *end;
    if (!isdigit((unsigned char)**text)) return false;
    long x = strtol(*text, &end, 10);
    *n = (int)x;
    bool good = x >= 16 && x <= 16384 && *end == stop;
    *text = end + 1;
    return good;
}

/* --box: four numbers in the plane, else six. */
static void set_box(struct view *v)
{
    double x[6] = { 0 };
    v->boxed = numbers(box, 6, x) || numbers(box, 4, x);
    for (int i = 0; i < 6; i++) v->boxed &= fabs(x[i]) < WALLS_FAR;
    if (!v->boxed || !(x[0] < x[1] && x[2] < x[3] && x[4] <= x[5]))
        die_usage("--box: '%s' is not X0,X1,Y0,Y1,Z0,Z1 (m), each first below the second", box);
    v->region = (struct extent){ { x[0], x[2], x[4] }, { x[1], x[3], x[5] } };
}

/* --clip: the plane's normal of any length, and the distance that goes with it. */
static void set_cut(struct view *v)
{
    double x[4];
    vec3 n;
    if (!numbers(cut, 4, x) || !((n = v3(x[0], x[1], x[2])), v3_norm(n) > 1e-150))
        die_usage("--clip: '%s' is not NX,NY,NZ,D with a normal that is not zero", cut);
    double length = v3_norm(n);
    v->cuts = true, v->cut = v3_scale(1 / length, n), v->cut_at = x[3] / length;
}

/* --up: two numbers or three, a direction. */
static vec3 up_of_option(void)
{
    double x[3] = { 0 };
    if (!upwards) return v3(0, 0, 0);
    bool good = numbers(upwards, 3, x) || ((x[2] = 0), numbers(upwards, 2, x));
    double length = v3_norm(v3(x[0], x[1], x[2]));
    if (!good || !(length > 1e-150 && length < 1e150))
        die_usage("--up: '%s' is not X,Y,Z, in 2D X,Y, a direction", upwards);
    return v3(x[0], x[1], x[2]);
}

static struct view view_of_options(void)
{
    struct view v = { .samples = (int)samples,
                      .threads = (int)threads,
                      .angle = perspective,
                      .up = up_of_option(),
                      .strays = strays,
                      .glass = walls == GLASS,
                      .follows = follow >= 0,
                      .follow = (int32_t)follow,
                      .pale = (float)(cli_given(&pale)                              ? pale
                                      : over.network || over.contacts || over.bonds ? 0.6
                                                                                    : 0) };
    double x[2];
    over.legend = !bare;
    if (table && !cli_given(&colour)) colour = COLOUR_VALUE;
    if ((colour == COLOUR_VALUE) != (table != NULL)) die_usage("-c value and --values go together");
    if (wanted && !table) die_usage("--column is of --values");
    if (svg && perspective > 0) die_usage("--svg: discs have no perspective");
    if (cut) set_cut(&v);
    paint_init(&v.paint, (enum colour)colour, plain);
    if (!numbers(camera, 2, x) || fabs(x[0]) > 360 || fabs(x[1]) > 90)
        die_usage("--camera: '%s' is not AZ,EL, from -360 to 360 and from -90 to 90", camera);
    v.azimuth = x[0], v.elevation = x[1];
    const char *s = size;
    if (size && !(pixels(&s, 'x', &v.width) && pixels(&s, 0, &v.height)))
        die_usage("--size: '%s' is not WxH, each from 16 to 16384", size);
    if (strlen(background) != 6 || strspn(background, "0123456789abcdefABCDEF") != 6)
        die_usage("--background: '%s' is not RRGGBB", background);
    v.background = rgb_of((unsigned)strtoul(background, NULL, 16));
    if (range && colour_meaning[colour].classes) die_usage("--range: material and id have none");
    if (range && (!numbers(range, 2, x) || !(x[0] < x[1])))
        die_usage("--range: '%s' is not LO,HI, the first below the second", range);
    if (range) v.paint.lo = x[0], v.paint.hi = x[1];
    v.paint.fixed = range;
    if (box) set_box(&v);
    return v;
}

/* Where the %0Nd (N from 1 to 9) of a series' name begins; there must be no other percent sign. */
static const char *conversion(const char *name)
{
    const char *p = strchr(name, '%');
    if (!p || p[1] != '0' || p[2] < '1' || p[2] > '9' || p[3] != 'd' || strchr(p + 1, '%'))
        die_usage("--output: '%s' has not just one %%0Nd, N from 1 to 9, for --every", name);
    return p;
}

/* ---- what colours show ---- */

static struct values values;
static double *shown; /* [bodies] of the frame at hand, where the colour is not of the body alone */

/* Where the cell repeats: the images that a picture shows, and their numbers */
static void add_images(struct view *v, struct frame *f)
{
    int64_t *of;
    struct failure failure = { 0 };
    if (images_append(&f->packing, &of, &failure)) die_why(&failure);
    if (of && colour_meaning[colour].given) {
        double *more = malloc((size_t)(f->packing.n + 1) * sizeof *more);
        if (!more) die(EX_SOFTWARE, "no memory for %lld bodies", (long long)f->packing.n);
        for (int64_t i = 0; i < f->packing.n; i++) more[i] = shown[of[i]];
        free(shown);
        v->paint.value = shown = more;
    }
    free(of);
}

/* The numbers of the bodies of a frame */
static void set_numbers(struct view *v, const struct frame *f, const char *where)
{
    if (!colour_meaning[colour].given) return;
    const struct contacts *s = f->detected ? &f->contacts : NULL;
    if (colour != COLOUR_VALUE && (!s || !s->found))
        die(EX_DATAERR, "%s: no forces of contacts (nsd-step --contacts keeps them)", where);
    free(shown);
    shown = malloc((size_t)(f->packing.n + 1) * sizeof *shown);
    if (!shown) die(EX_SOFTWARE, "no memory for %lld bodies", (long long)f->packing.n);
    values_of(shown, (enum colour)colour, &f->packing, s, &values);
    v->paint.value = shown;
}

static bool wants_solid(void)
{
    return solid_names || cli_given(&surface);
}

/* The solid walls of a frame */
static void set_solid(struct view *v, const struct frame *f, const char *where)
{
    struct failure failure = { 0 };
    double x[2] = { NAN, NAN };
    if (!wants_solid()) return;
    if (f->packing.dim == 2)
        die_usage("--solid, --surface: in the plane walls are lines, which are drawn as they are");
    if (surface_range && (!numbers(surface_range, 2, x) || !(x[0] < x[1])))
        die_usage("--surface-range: '%s' is not LO,HI, the first below the second", surface_range);
    solid_free(&solid);
    const struct solid_opt opt = { solid_names, (enum solid_by)surface, x[0], x[1], &v->paint };
    if (solid_init(&solid, &f->packing, &opt, &failure))
        die(failure.status, "%s: %s", where, failure.text);
    v->solid = over.solid = &solid;
}

/* Before a frame is seen or drawn */
/* The bodies of the frame that --only names */
static void set_only(struct view *v, const struct frame *f, const char *where)
{
    static struct selection chosen;
    struct failure failure = { 0 };
    selection_free(&chosen);
    if (!only) return;
    if (selection_init(&chosen, &f->packing, "--only", only, &failure))
        die(failure.status, "%s: %s", where, failure.text);
    if (!chosen.bodies)
        die(EX_DATAERR, "%s: --only: '%s' names walls, not bodies; --solid draws walls", where,
            only);
    v->only = &chosen;
}

static void set_values(struct view *v, struct frame *f, const char *where)
{
    tool_wants_packing(f, where);
    set_only(v, f, where);
    set_solid(v, f, where);
    set_numbers(v, f, where);
    add_images(v, f);
}

static void read_values(struct view *v)
{
    struct failure failure = { 0 };
    if (table && values_read(&values, table, wanted, &failure)) die_why(&failure);
    v->paint.name = values.name;
}

/* ---- pictures ---- */

static const struct contacts *contacts_of(const struct frame *f, const char *where)
{
    if (!over.network && !over.contacts) return NULL;
    if (!f->detected) die(EX_DATAERR, "%s: no contacts (nsd-step --contacts keeps them)", where);
    if (over.network && !f->contacts.found)
        die(EX_DATAERR, "%s: contacts without forces (nsd-solve finds them)", where);
    return &f->contacts;
}

/* Draws a frame into a file; NULL is standard output. */
static void draw(const struct view *v, const struct frame *f, const char *path, const char *where)
{
    struct picture p;
    struct failure failure = { 0 };
    const struct contacts *s = contacts_of(f, where);
    if (svg) {
        if (svg_draw(&over, v, &f->packing, s, path, &failure)) die_why(&failure);
        return;
    }
    if (overlay_draw(&over, v, &f->packing, s, &p, &failure) || picture_write(&p, path, &failure))
        die_why(&failure);
    picture_free(&p);
}

/* Makes what is shown include this frame. */
static void extend(struct view *v, struct frame *f, const char *where)
{
    struct failure failure = { 0 };
    set_values(v, f, where);
    if (v->boxed && f->packing.dim == 3 && v->region.lo.z == v->region.hi.z)
        die_usage("--box: needs Z0,Z1 too, for balls");
    if (f->packing.dim == 2 && v->up.z != 0) die_usage("--up: discs lie in the plane of x and y");
    if (view_extend(v, &f->packing, &failure)) die(failure.status, "%s: %s", where, failure.text);
}

enum { SMALL = 240 }; /* pixels: lower pictures have no room for words */

/* Fits the view to what it has been extended to; what the legend takes is not the view's. */
static void fit(struct view *v, const struct frame *f)
{
    int strip = overlay_strip(&over, v->width ? v->width : CAMERA_SIDE);
    if (v->height && v->height < SMALL)
        over.legend = false;
    else if (v->height)
        v->height -= strip;
    view_fit(v, &f->packing);
}

/* Finds the frame asked for; reads to the end, for the writer in the pipe must not be cut off. */
static void find(struct reader *in, struct frame *found)
{
    struct frame f = { 0 };
    struct failure failure = { 0 };
    bool more = false, any = false;
    const struct range one = { step, step, 1 };
    if (step < 0 && reader_last(in, found, &any, &failure)) die_why(&failure);
    while (step >= 0 && !reader_next(in, &one, &f, &more, &failure) && more)
        if (f.packed) {
            frame_free(found);
            *found = f, f = (struct frame){ 0 }, any = true;
        }
    if (failure.status) die_why(&failure);
    if (!any) die(EX_DATAERR, "%s: no such frame", reader_where(in));
    frame_free(&f);
}

/* ---- series ---- */

/* Where the pictures of a series go: into files whose names count, or into a film */
static struct {
    char *pattern, *path; /* of names; room for one of them */
    size_t room;
    const char *number; /* where the %0Nd of the pattern begins */
    struct film *film;
} series_out;

static void series_open(void)
{
    struct failure failure = { 0 };
    size_t room = strlen(output) + 40;
    bool film = film_name(output);
    series_out.room = room;
    series_out.pattern = malloc(room), series_out.path = malloc(room);
    if (!series_out.pattern || !series_out.path) die(EX_SOFTWARE, "no memory");
    strcpy(series_out.pattern, output);
    if (film && film_possible()) {
        if (film_open(&series_out.film, output, (int)rate, &failure)) die_why(&failure);
        return;
    }
    if (film) { // the pictures, and how to join them
        snprintf(series_out.pattern, room, "%.*s-%%05d.png", (int)(strrchr(output, '.') - output),
                 output);
        warn("no ffmpeg: pictures instead, which this joins where there is one:");
        warn("ffmpeg -framerate %lld -i '%s' -pix_fmt yuv420p '%s'", (long long)rate,
             series_out.pattern, output);
    }
    series_out.number = conversion(series_out.pattern);
}

static void series_add(const struct view *v, const struct frame *f, int64_t k, int files,
                       char *const *file, const char *where)
{
    struct failure failure = { 0 };
    if (series_out.film) {
        struct picture p;
        if (overlay_draw(&over, v, &f->packing, contacts_of(f, where), &p, &failure) ||
            film_add(series_out.film, &p, &failure))
            die_why(&failure);
        picture_free(&p);
        return;
    }
    const char *number = series_out.number;
    snprintf(series_out.path, series_out.room, "%.*s%0*lld%s", (int)(number - series_out.pattern),
             series_out.pattern, number[2] - '0', (long long)k, number + 4);
    if (reader_reads(files, file, series_out.path))
        die_usage("%s: is also the input", series_out.path);
    draw(v, f, series_out.path, where);
}

static void series_close(void)
{
    struct failure failure = { 0 };
    if (series_out.film && film_close(series_out.film, &failure)) die_why(&failure);
    free(series_out.pattern), free(series_out.path);
}

/* Reads frame k, the n-th of all documents, if --every wants it. */
static bool series_takes(struct reader *in, int64_t k, int64_t n, double *passed, struct frame *f)
{
    struct failure failure = { 0 };
    if (every.steps && n % every.steps) return false;
    if (reader_frame(in, k, f, &failure)) die_why(&failure);
    return every.steps || every_passed(&every, passed, f->packing.t);
}

/* Draws frames of all documents; the first document's decide about the view of all. */
static void series(struct reader *in, int files, char *const *file, struct view *v)
{
    struct frame f = { 0 };
    struct failure failure = { 0 };
    int64_t frames, before = 0, drawn = 0; // frames count on through documents
    double passed = NAN;
    series_open();
    while (!reader_document(in, &frames, &failure) && frames >= 0) {
        bool fitted = v->started;
        double looked = passed;
        for (int64_t k = 0; !fitted && k < frames; k++)
            if (series_takes(in, k, before + k, &looked, &f)) extend(v, &f, reader_where(in));
        for (int64_t k = 0; k < frames; k++) {
            if (!series_takes(in, k, before + k, &passed, &f)) continue;
            set_values(v, &f, reader_where(in));
            view_follow(v, &f.packing);
            if (!fitted) fit(v, &f);
            fitted = true;
            series_add(v, &f, drawn++, files, file, reader_where(in));
            progress("%lld pictures", (long long)drawn);
        }
        before += frames;
    }
    if (failure.status) die_why(&failure);
    if (!drawn) die(EX_DATAERR, "%s: no such frame", reader_where(in));
    progress_end();
    series_close();
    frame_free(&f);
}

/* A picture without a legend has no numbers in it, so stderr says what the ends of the palette mean. */
static void explain(const struct view *v)
{
    const struct paint *p = &v->paint;
    const struct colour_meaning *m = &colour_meaning[p->by];
    if (over.legend || p->fixed || !(p->hi > p->lo)) return;
    warn("%s %.3g (violet) to %.3g (yellow)%s%s", p->name ? p->name : m->name, p->lo, p->hi,
         *m->unit ? " " : "", m->unit);
}

int tool_main(int argc, char **argv)
{
    struct reader *in;
    struct frame f = { 0 };
    struct failure failure = { 0 };
    struct view v = view_of_options();
    const bool many = cli_given(&every);
    if (many && step >= 0) die_usage("--step and --every exclude each other");
    if (many && !output) die_usage("--every needs --output 'name%%05d.png'");
    if (svg && many && film_name(output)) die_usage("--svg: a film is of PNGs");
    if (!many && output && film_name(output)) die_usage("%s: a film needs --every", output);
    if (!output && isatty(STDOUT_FILENO))
        die(EX_USAGE, "standard output is a terminal: a picture is binary, use > FILE or a pipe");
    read_values(&v);
    if (reader_open(&in, argc, argv, &failure)) die_why(&failure);
    if (output && reader_reads(argc, argv, output)) die_usage("%s: is also the input", output);
    if (many) {
        if (!film_name(output)) conversion(output);
        series(in, argc, argv, &v);
    } else {
        find(in, &f);
        extend(&v, &f, reader_where(in));
        fit(&v, &f);
        draw(&v, &f, output, reader_where(in));
        frame_free(&f);
    }
    explain(&v);
    values_free(&values), free(shown);
    reader_close(in);
    return 0;
}
