/* nsd-view: draws the bodies, one picture or a series, as PNG. */
#include "cli/cli.h"
#include "cli/tool_filter.h"
#include "draw/view.h"
#include "io/reader.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int64_t step = -1, every, samples = 3, threads = 1;
static int colour = COLOUR_RADIUS;
static bool plain;
static const char *output, *range, *size, *camera = "30,15", *box, *background = "ffffff";

static struct cli_choice colour_choice(int k)
{
    return (struct cli_choice){ k < COLOUR_COUNT ? colour_name[k] : NULL, NULL };
}

static const struct cli_option own[] = {
    { CLI_INT, 's', "step", &step, "N", .max = 1e15,
      .help = "the frame of step N [the very last frame]" },
    { CLI_INT, 0, "every", &every, "K", .min = 1, .max = 1e15,
      .help = "a series: every K-th frame, numbered from 0 [one picture]" },
    { CLI_TEXT, 'o', "output", &output, "FILE", .silent = true,
      .help = "write to FILE; a series: 'f%05d.png' or so [standard output]" },
    { CLI_CHOICE, 'c', "colour", &colour, .choice = colour_choice,
      .help = "what a body's colour shows [radius]" },
    { CLI_TEXT, 0, "range", &range, "LO,HI",
      .help = "m or m/s at the ends of the palette [what there is; speeds from 0]" },
    { CLI_FLAG, 0, "plain", &plain, .help = "without the marks that show how bodies turn" },
    { CLI_TEXT, 0, "size", &size, "WxH", .help = "pixels [the longer side 900, the other to fit]" },
    { CLI_TEXT, 0, "camera", &camera, "AZ,EL",
      .help = "of balls: degrees about z and above the horizon [30,15]" },
    { CLI_TEXT, 0, "box", &box, "X0,X1,Y0,Y1[,Z0,Z1]",
      .help = "only bodies with their centre in this box (m) [all]" },
    { CLI_TEXT, 0, "background", &background, "RRGGBB", .help = "its colour [ffffff]" },
    { CLI_INT, 0, "samples", &samples, "N", .min = 1, .max = 8,
      .help = "a pixel is the mean of N x N samples [3]" },
    { CLI_INT, 'j', "threads", &threads, "N", .min = 1, .max = 1024, .silent = true,
      .help = "threads; they never change a picture [1]" },
    { 0 },
};
static const struct cli_option *const tables[] = { own, NULL };

const struct cli_tool tool = { "nsd-view", "[FILE ...]",
                               "Draws a packing as PNG: the last frame, another, or a series.",
                               tables,
                               "  nsd-gen 500 | nsd-view > balls.png\n"
                               "  nsd-view -c speed --every 10 -o 'film%05d.png' out.h5\n" };

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
    v->region = (struct region){ { x[0], x[2], x[4] }, { x[1], x[3], x[5] } };
}

static struct view view_of_options(void)
{
    struct view v = { .samples = (int)samples, .threads = (int)threads };
    double x[2];
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
    if (range && (colour == COLOUR_KIND || colour == COLOUR_ID))
        die_usage("--range: kind and id have none");
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

/* ---- pictures ---- */

/* Draws a frame into a file; NULL is standard output. */
static void draw(const struct view *v, const struct frame *f, const char *path)
{
    struct picture p;
    struct why why = { 0 };
    if (view_draw(v, &f->packing, &p, &why) || picture_write(&p, path, &why)) die_why(&why);
    picture_free(&p);
}

/* Makes what is shown include this frame. */
static void extend(struct view *v, const struct frame *f, const char *where)
{
    struct why why = { 0 };
    tool_wants_packing(f, where);
    if (v->boxed && f->packing.dim == 3 && v->region.lo.z == v->region.hi.z)
        die_usage("--box: wants Z0,Z1 too, for balls");
    if (view_extend(v, &f->packing, &why)) die(why.status, "%s: %s", where, why.text);
}

/* Finds the frame asked for; reads to the end, for the writer in the pipe must not be cut off. */
static void find(struct reader *in, struct frame *found)
{
    struct frame f = { 0 };
    struct why why = { 0 };
    bool more = false, any = false;
    const struct range only = { step, step, 1 };
    if (step < 0 && reader_last(in, found, &any, &why)) die_why(&why);
    while (step >= 0 && !reader_next(in, &only, &f, &more, &why) && more)
        if (f.packed) {
            frame_free(found);
            *found = f, f = (struct frame){ 0 }, any = true;
        }
    if (why.status) die_why(&why);
    if (!any) die(EX_DATAERR, "%s: no such frame", reader_where(in));
    frame_free(&f);
}

/* Draws every K-th frame; the first document's decide about the view of all. */
static void series(struct reader *in, int files, char *const *file, struct view *v)
{
    struct frame f = { 0 };
    struct why why = { 0 };
    int64_t frames, before = 0, drawn = 0;
    const char *number = conversion(output);
    size_t room = strlen(output) + 32;
    char *path = malloc(room);
    if (!path) die(EX_SOFTWARE, "no memory");
    while (!reader_document(in, &frames, &why) && frames >= 0) {
        int64_t first = (every - before % every) % every; // frames count on through documents
        bool fitted = v->started;
        for (int64_t k = first; !fitted && k < frames; k += every) {
            if (reader_frame(in, k, &f, &why)) die_why(&why);
            extend(v, &f, reader_where(in));
        }
        for (int64_t k = first; k < frames; k += every, drawn++) {
            if (reader_frame(in, k, &f, &why)) die_why(&why);
            tool_wants_packing(&f, reader_where(in));
            if (!fitted) view_fit(v, &f.packing);
            fitted = true;
            snprintf(path, room, "%.*s%0*lld%s", (int)(number - output), output, number[2] - '0',
                     (long long)drawn, number + 4);
            if (reader_reads(files, file, path)) die_usage("%s: is also the input", path);
            draw(v, &f, path);
            progress("%lld pictures", (long long)drawn + 1);
        }
        before += frames;
    }
    if (why.status) die_why(&why);
    if (!drawn) die(EX_DATAERR, "%s: no such frame", reader_where(in));
    progress_end();
    free(path);
    frame_free(&f);
}

/* A picture has no numbers in it, so stderr says what the ends of the palette mean. */
static void legend(const struct view *v)
{
    const struct paint *p = &v->paint;
    if (p->fixed || !(p->hi > p->lo)) return;
    bool speed = p->by == COLOUR_SPEED;
    warn("%s %.3g (violet) to %.3g (yellow) %s", speed ? "speed" : "radius", p->lo, p->hi,
         speed ? "m/s" : "m");
}

int tool_main(int argc, char **argv)
{
    struct reader *in;
    struct frame f = { 0 };
    struct why why = { 0 };
    struct view v = view_of_options();
    if (every && step >= 0) die_usage("--step and --every exclude each other");
    if (every && !output) die_usage("--every wants --output 'name%%05d.png'");
    if (!output && isatty(STDOUT_FILENO))
        die(EX_USAGE, "standard output is a terminal: a picture is binary, use > FILE or a pipe");
    if (reader_open(&in, argc, argv, &why)) die_why(&why);
    if (every) {
        series(in, argc, argv, &v);
    } else {
        if (output && reader_reads(argc, argv, output)) die_usage("%s: is also the input", output);
        find(in, &f);
        extend(&v, &f, reader_where(in));
        view_fit(&v, &f.packing);
        draw(&v, &f, output);
        frame_free(&f);
    }
    legend(&v);
    reader_close(in);
    return 0;
}
