/* nsd-gen: builds a packing, the paper's N balls or what a scene says. */
#include "cli/cli.h"
#include "io/writer.h"
#include "scene/scene_build.h"

#include <errno.h>
#include <libgen.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int64_t dim = 3;

static const struct cli_option own[] = {
    { CLI_INT, 'd', "dim", &dim, "2|3", .min = 2, .max = 3,
      .help = "with N: 3 makes balls, 2 discs in the plane [3]" },
    { 0 },
};
static const struct cli_option *const tables[] = { own, NULL };

const struct cli_tool tool = {
    "nsd-gen", "N | SCENE.json | -",
    "Builds a packing: N balls of the paper's sedimentation (500: its example 3, 4: its example "
    "2),\n"
    "or what a scene says. Reads JSON, writes a document.",
    tables,
    "  nsd-gen 500 > balls.h5\n"
    "  nsd-gen scenes/column.json | nsd-step -n 1000 > out.h5\n"
    "  jq '.mu = 0.5' scenes/paper/example3.json | nsd-gen - > rough.h5\n"
};

/* All of a file, n bytes, to be freed; NULL when memory is short. */
static char *slurp(FILE *f, size_t *n)
{
    size_t room = 1 << 16;
    char *text = malloc(room);
    for (*n = 0; text;) {
        *n += fread(text + *n, 1, room - *n, f);
        if (*n < room) break;
        room *= 2;
        char *more = realloc(text, room);
        if (!more) free(text);
        text = more;
    }
    return text;
}

/* Reads the scene in a file, or in standard input (-), and sets the directory of its tables. */
static void read_scene(struct scene *s, const char *path, char **dir)
{
    bool standard = !strcmp(path, "-");
    const char *name = standard ? "standard input" : path;
    struct why why = { 0 };
    size_t n;
    FILE *f = standard ? stdin : fopen(path, "r");
    char *text = f ? slurp(f, &n) : NULL;
    if (!f || ferror(f)) die(EX_NOINPUT, "%s: %s", name, strerror(errno));
    if (!text) die(EX_SOFTWARE, "%s: no memory", name);
    if (scene_parse(s, text, n, &why)) die(why.status, "%s:%s", name, why.text);
    free(text);
    if (standard) return;
    fclose(f);
    char *copy = strdup(path);
    *dir = copy ? strdup(dirname(copy)) : NULL;
    free(copy);
}

/* "500", "1e6" and also "-5" are numbers, in range or not; all else is the name of a file. */
static bool is_number(const char *text, double *x)
{
    char *end;
    *x = strtod(text, &end);
    return end != text && !*end;
}

int tool_main(int argc, char **argv)
{
    struct scene scene;
    struct frame frame = { .packed = true };
    struct writer *out;
    struct why why = { 0 };
    char *dir = NULL;
    if (argc != 1 || !*argv[0]) die_usage("one operand: a number of balls, or a scene");
    if (writer_open(&out, NULL, WRITER_STREAM, &why)) die_why(&why);
    double n;
    if (is_number(argv[0], &n)) {
        if (!(n >= 0 && n <= INT32_MAX && n == floor(n)))
            die_usage("%s: not a number of balls (0 to %d)", argv[0], INT32_MAX);
        if (scene_paper(&scene, (int)dim, (int64_t)n, &why)) die_why(&why);
    } else {
        read_scene(&scene, argv[0], &dir);
    }
    if (scene_build(&frame.packing, &scene, dir, &why)) die_why(&why);
    if (frame_note(&frame, cli_history(), &why) || writer_frame(out, &frame, &why) ||
        writer_close(out, &why))
        die_why(&why);
    free(dir);
    scene_free(&scene);
    frame_free(&frame);
    return 0;
}
