/* nsd-gen: builds a packing, the paper's N balls or what a scene says. */
#include "base/json.h"
#include "convert/import_file.h"
#include "convert/scene_file.h"
#include "file/report_json.h"
#include "file/writer.h"
#include "run/cli.h"
#include "scene/scene_build.h"
#include "scene/scene_carry.h"
#include "scene/scene_height.h"
#include "scene/schema.h"
#include "scene/size_table.h"
#include "scene/time_step.h"
#include "state/servo_box.h"

#include <errno.h>
#include <libgen.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FAR 4 /* times the suggested time step: a scene's own is said to be too long from there */

static int64_t dim = 3;
static bool check, schema, keys;
static const char *from;

static const struct cli_option own[] = {
    { CLI_INT, 'd', "dim", &dim, "2|3", .min = 2, .max = 3,
      .help = "with N, make balls (3) or discs (2) [3]" },
    { CLI_TEXT, 0, "from", &from, "FILE",
      .help = "read a LAMMPS, LIGGGHTS or Yade file instead of a scene" },
    { CLI_FLAG, 0, "check", &check,
      .help = "print a suitable time step, masses and sizes as JSON, no document" },
    { CLI_FLAG, 0, "schema", &schema, .help = "print the JSON Schema of scenes, no document" },
    { CLI_FLAG, 0, "keys", &keys, .help = "print all keys of scenes as a table, no document" },
    { 0 },
};
static const struct cli_option *const tables[] = { own, NULL };

const struct cli_tool tool = {
    "nsd-gen", "N | SCENE.json | - | --from FILE | --schema | --keys",
    "Builds a packing from a scene, or N balls of the sedimentation of the paper (500: its "
    "example\n"
    "3, 4: its example 2). Reads JSON, writes a document.",
    tables,
    "  nsd-gen 500 > balls.h5\n"
    "  nsd-gen scenes/column.json | nsd-step -n 1000 > out.h5\n"
    "  nsd-info --scene out.h5 | jq '.gravity = [3, 0, -9.81]' | nsd-gen - > tilted.h5\n"
    "  jq '.mu = 0.5' scenes/paper/example3.json | nsd-gen - > rough.h5\n"
    "  nsd-gen --from dump.liggghts | nsd-step -n 1000 > out.h5\n"
    "  nsd-gen --check scenes/drum.json | jq .dt\n"
    "  nsd-gen --keys | grep -i friction\n"
};

/* Reads the scene in a file, or in standard input (-), and sets the directory of its tables. */
static void read_scene(struct scene *s, const char *path, char **dir)
{
    bool standard = !strcmp(path, "-");
    const char *name = standard ? "standard input" : path;
    struct failure failure = { 0 };
    size_t n;
    FILE *f = standard ? stdin : fopen(path, "r");
    if (!f) die(EX_NOINPUT, "%s: %s", name, strerror(errno));
    char *text = scene_file_slurp(f, name, &n, &failure);
    if (!text) die_why(&failure);
    if (!standard) {
        fclose(f);
        char *copy = strdup(path);
        *dir = copy ? strdup(dirname(copy)) : NULL;
        free(copy);
    }
    scene_file_parse(s, text, n, name, *dir, &failure);
    free(text);
    if (failure.status) die_why(&failure);
}

/* "500", "1e6" and also "-5" are numbers, in range or not; all else is the name of a file. */
static bool is_number(const char *text, double *x)
{
    char *end;
    *x = strtod(text, &end);
    return end != text && !*end;
}

/* ---- the file of another program alone ---- */

/* A scene of the file alone, with the materials that it has */
static void scene_around(struct scene *s, struct packing *p, const char *path)
{
    struct failure failure = { 0 };
    json_t *materials = json_object();
    for (int32_t k = 0; k < p->materials && p->materials > 1; k++)
        json_object_set_new(materials, p->material_name[k], json_object());
    json_t *scene = json_pack("{s:s, s:o, s:[{s:s}]}", "dt", "auto", "kinds", materials, "bodies",
                              "import", path);
    char *text = scene ? json_dumps(scene, JSON_COMPACT) : NULL;
    if (!text) die(EX_DATAERR, "%s: a name that is no UTF-8", path);
    if (scene_parse(s, text, strlen(text), NULL, &failure)) die_why(&failure);
    free(text), json_decref(scene);
    s->bodies[0].document = p;
}

static void read_from(struct scene *s, const char *path)
{
    struct failure failure = { 0 };
    struct packing *p = calloc(1, sizeof *p);
    const struct import_wish wish = { .dim = (int)dim, .frame = -1 };
    if (!p) die(EX_SOFTWARE, "no memory for a packing");
    progress("reading %s", path);
    if (import_file(p, path, &wish, &failure)) die_why(&failure);
    progress_end();
    scene_around(s, p, path);
}

/* As a reason, for the name is out of a file */
static void say_left_out(const struct scene_mesh *m)
{
    struct failure failure = { 0 };
    failure_set(&failure, EX_DATAERR,
                "%s: left out: %d triangles that have no area, or the corners of another", m->file,
                m->left_out);
    if (m->left_out) warn("%s", failure.text);
}

static void say_fit(const struct scene_fit *f)
{
    struct failure failure = { 0 };
    failure_set(
        &failure, EX_DATAERR,
        "shape \"%s\": %d balls: volume %+.2g, distance %.2g of the radius around it, moments %.2g "
        "of their sum",
        f->shape, f->balls, f->volume, f->distance, f->moments);
    warn("%s", failure.text);
}

/* As a reason, for the name is out of a scene */
static void say_one_lost(const char *file, const char *what)
{
    struct failure failure = { 0 };
    failure_set(&failure, EX_DATAERR, "warning: %s: %s", file, what);
    warn("%s", failure.text);
}

static void say_lost(const struct scene_lost *lost)
{
    char text[160];
    snprintf(text, sizeof text,
             "%lld bonds or liquid bridges are lost: the scene has no law for these pairs, or "
             "other walls",
             (long long)lost->bonds);
    if (lost->bonds > 0) say_one_lost(lost->file, text);
    if (lost->sums) say_one_lost(lost->file, "the sums of its walls begin again from 0");
    if (lost->forces)
        say_one_lost(lost->file,
                     "the lasting forces of a program are lost: it has to set them again");
    if (lost->poured)
        say_one_lost(lost->file,
                     "the pours begin again from 0: \"poured\" continues them, as nsd-info "
                     "--scene prints it");
    if (lost->steered)
        say_one_lost(lost->file,
                     "a program changed gravity, friction or the motion of walls there: "
                     "here they are the scene's");
    snprintf(text, sizeof text, "dt, \"auto\", is chosen again: it was %g s", lost->dt);
    if (lost->dt > 0) say_one_lost(lost->file, text);
}

/* ---- what suits a scene ---- */

static json_t *limits_json(const struct time_step *t)
{
    json_t *list = json_array();
    for (int k = 0; k < LIMITS; k++) {
        const struct time_step_limit *l = &time_step_limit[k];
        if (!isfinite(t->dt[k])) continue;
        json_array_append_new(list,
                              json_pack("{s:s, s:o, s:s, s:o, s:s, s:s}", "limit", l->name, "dt",
                                        json_number(t->dt[k]), "rule", l->rule, "value",
                                        json_number(t->x[k]), "units", l->units, "of", l->of));
        warn("%-9s %-24s with r = %.3g m and %.3g %s, the %s: dt <= %.3g s", l->name, l->rule,
             t->radius, t->x[k], l->units, l->of, t->dt[k]);
    }
    return list;
}

/* A mass that yields, with the one that is suggested; k: of the wall, or of the cell's edge */
static void add_mass(json_t *list, const char *of, int k, double has, double mass, const char *rule)
{
    json_array_append_new(list, json_pack("{s:i, s:o, s:o, s:s}", of, k, "mass", json_number(mass),
                                          "has", json_number(has), "rule", rule));
    warn("%s %d: a mass of %.2g kg, %s; it has %.3g", of, k, mass, rule, has);
}

static json_t *masses_json(const struct packing *p)
{
    json_t *list = json_array();
    for (int32_t k = 0; k < p->walls; k++) {
        const struct wall *w = &p->wall[k];
        double lever = servo_box_has(w) && w->load.mass > 0 ? wall_lever(p, w, p->t) : 0;
        double has = lever != 0 ? w->load.mass / (lever * lever) : w->load.mass;
        double mass = w->load.way == LOAD_GLIDES || lever != 0 ? time_step_wall_mass(p, w) : 0;
        if (mass > 0) add_mass(list, "wall", k, has, mass, "one layer of the grains on it");
    }
    for (int k = 0; k < 3; k++) {
        double has = 0;
        for (int i = 0; i < 3; i++) has = fmax(has, p->cell.mass[k][i]);
        if (has > 0)
            add_mass(list, "edge", k, has, time_step_edge_mass(p), "3/(4 pi^2) of all grains");
    }
    double squares = 0;
    for (int k = 0; k < p->dim; k++) squares += v3_dot(p->cell.edge[k], p->cell.edge[k]);
    if (p->cell.size_mass > 0)
        add_mass(list, "size", 0, p->cell.size_mass / squares, time_step_edge_mass(p),
                 "3/(4 pi^2) of all grains");
    return list;
}

/* The heights that groups take, and those of their boxes, null where these are open */
static json_t *heights_json(const struct scene *s)
{
    json_t *list = json_array();
    for (int64_t g = 0; g < s->groups; g++) {
        double has, height = scene_height(s, g, &has);
        if (isnan(height)) continue;
        json_array_append_new(list, json_pack("{s:i, s:o, s:o}", "group", (int)g, "height",
                                              json_number(height), "box", json_number(has)));
        if (isfinite(has))
            warn("bodies[%lld]: a height of %.4g m, in a box of %.4g m", (long long)g, height, has);
        else
            warn("bodies[%lld]: a height of %.4g m, in a box that is open above", (long long)g,
                 height);
    }
    return list;
}

static json_t *fits_json(const struct scene *s)
{
    json_t *list = json_array();
    for (int32_t k = 0; k < s->fits; k++) {
        const struct scene_fit *f = &s->fit[k];
        json_array_append_new(list, json_pack("{s:s, s:i, s:o, s:o, s:o}", "shape", f->shape,
                                              "balls", f->balls, "volume", json_number(f->volume),
                                              "distance", json_number(f->distance), "moments",
                                              json_number(f->moments)));
    }
    return list;
}

/* ---- sizes of grains: those that were asked for beside those that were drawn ---- */

static json_t *quantiles_json(const struct size_table *t, enum size_share of)
{
    return json_pack("{s:o, s:o, s:o}", "d10", json_number(size_table_quantile(t, of, 0.1)), "d50",
                     json_number(size_table_quantile(t, of, 0.5)), "d90",
                     json_number(size_table_quantile(t, of, 0.9)));
}

static json_t *distribution_json(const struct size_table *t)
{
    return json_pack("{s:o, s:o, s:o}", "mean", json_number(t->mean), "mass",
                     quantiles_json(t, SIZE_BY_MASS), "number", quantiles_json(t, SIZE_BY_NUMBER));
}

/* Shares that pass sieves: those of the scene, else ten from the smallest size to the largest */
static json_t *passing_json(const struct scene_size *z, const struct size_table *asked,
                            const struct size_table *drawn, long long group)
{
    json_t *list = json_array();
    const int64_t sieves = z->law == SIZE_SIEVE ? z->segments : z->min < z->max ? 10 : 0;
    for (int64_t k = 0; k < sieves; k++) {
        const double d = 2 * (z->law == SIZE_SIEVE
                                  ? z->sieve[k].to
                                  : z->min + (double)(k + 1) / (double)sieves * (z->max - z->min));
        double share[2][SIZE_SHARES];
        for (int of = 0; of < SIZE_SHARES; of++)
            share[0][of] = size_table_below(asked, of, d),
            share[1][of] = size_table_below(drawn, of, d);
        json_array_append_new(list, json_pack("{s:o, s:[o, o], s:[o, o]}", "d", json_number(d),
                                              "mass", json_number(share[0][SIZE_BY_MASS]),
                                              json_number(share[1][SIZE_BY_MASS]), "number",
                                              json_number(share[0][SIZE_BY_NUMBER]),
                                              json_number(share[1][SIZE_BY_NUMBER])));
        warn("bodies[%lld]: below %.4g m: of the mass %.4f, drawn %.4f; of the number %.4f, drawn "
             "%.4f",
             group, d, share[0][SIZE_BY_MASS], share[1][SIZE_BY_MASS], share[0][SIZE_BY_NUMBER],
             share[1][SIZE_BY_NUMBER]);
    }
    return list;
}

static void add_sizes(json_t *list, const struct scene *s, int64_t g, const double *radius,
                      int64_t n)
{
    const struct scene_bodies *b = &s->bodies[g];
    struct size_table asked, drawn = { 0 };
    struct failure failure = { 0 };
    if (size_table_asked(&asked, &b->size, s->dim, &failure) ||
        size_table_drawn(&drawn, radius, n, s->dim, &failure))
        die_why(&failure);
    static const char *const of[SIZE_SHARES] = { "number", "mass" };
    warn("bodies[%lld]: %lld %s, mean diameter%s %.4g m, drawn %.4g", (long long)g, (long long)n,
         b->form.shape ? "shapes" : "grains", b->form.shape ? " of the balls around them" : "",
         asked.mean, drawn.mean);
    if (b->size.unit > 0 && b->size.law == SIZE_SIEVE)
        warn("bodies[%lld]: \"size\" scales the shape, whose ball has a diameter of %.4g m at size "
             "1; "
             "an aperture of its sieve is twice the size",
             (long long)g, 2 * b->size.unit);
    for (int k = b->size.min < b->size.max ? SIZE_SHARES - 1 : -1; k >= 0; k--)
        warn("bodies[%lld]: d10, d50, d90 by %s %.4g, %.4g, %.4g m, drawn %.4g, %.4g, %.4g",
             (long long)g, of[k], size_table_quantile(&asked, k, 0.1),
             size_table_quantile(&asked, k, 0.5), size_table_quantile(&asked, k, 0.9),
             size_table_quantile(&drawn, k, 0.1), size_table_quantile(&drawn, k, 0.5),
             size_table_quantile(&drawn, k, 0.9));
    json_t *j = json_pack("{s:i, s:I, s:o, s:o}", "group", (int)g, "count", (json_int_t)n, "asked",
                          distribution_json(&asked), "drawn", distribution_json(&drawn));
    json_object_set_new(j, "passing", passing_json(&b->size, &asked, &drawn, (long long)g));
    json_array_append_new(list, j);
    size_table_free(&asked), size_table_free(&drawn);
}

/* Of groups whose sizes are drawn */
static json_t *sizes_json(const struct scene *s, const struct packing *p)
{
    json_t *list = json_array();
    int64_t first = 0;
    for (int64_t g = 0; g < s->groups; first += s->built[g++]) {
        const enum scene_source source = s->bodies[g].from;
        if (s->built[g] > 0 &&
            (source == SCENE_LATTICE || source == SCENE_SHELVES || source == SCENE_RANDOM))
            add_sizes(list, s, g, p->radius + first, s->built[g]);
    }
    return list;
}

/* On standard output as a line of JSON; for people on standard error */
static void tell(const struct scene *s, const struct packing *p)
{
    struct time_step t;
    time_step_of(&t, s, p);
    json_t *limits = limits_json(&t), *masses = masses_json(p);
    json_t *j = json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "dt", json_number(t.best), "by",
                          t.by < 0 ? json_null() : json_string(time_step_limit[t.by].name), "scene",
                          s->dt == 0 ? json_string("auto") : json_real(p->dt), "radius",
                          json_number(t.radius), "limits", limits, "masses", masses);
    json_object_set_new(j, "heights", heights_json(s));
    json_object_set_new(j, "sizes", sizes_json(s, p));
    if (s->fits) json_object_set_new(j, "clumps", fits_json(s));
    json_object_set_new(j, "interval", json_number(t.interval));
    if (t.by < 0)
        warn("dt: nothing moves, so no time step can be suggested");
    else
        warn("dt = %.2g s is suggested for one solve per step, by %s; %g s for steps that are made "
             "of small ones",
             t.best, time_step_limit[t.by].name, t.interval);
    if (s->dt > FAR * t.best)
        warn("dt = %g s of the scene is %.2g times that of one solve per step: small steps, the "
             "default of nsd-step, "
             "do not need the suggestion; \"dt\": \"auto\" takes it",
             s->dt, s->dt / t.best);
    json_line(j);
    finish_stdout();
}

/* ---- the keys of scenes ---- */

static void print_key(const char *const field[7])
{
    for (int i = 0; i < 7; i++) printf("%s%c", field[i], i < 6 ? '\t' : '\n');
}

static int print_keys(void)
{
    struct failure failure = { 0 };
    begin_stdout();
    if (keys) {
        fputs("table\tkey\ttype\tunit\tdefault\texample\thelp\n", stdout);
        schema_lines(print_key);
    } else {
        json_t *j = schema_of_scenes(&failure);
        if (!j) die_why(&failure);
        char *text = json_dumps(j, JSON_INDENT(2));
        if (!text) die(EX_SOFTWARE, "no memory for the schema");
        puts(text);
        free(text), json_decref(j);
    }
    finish_stdout();
    return 0;
}

int tool_main(int argc, char **argv)
{
    struct scene scene;
    struct frame frame = { .packed = true };
    struct writer *out = NULL;
    struct failure failure = { 0 };
    char *dir = NULL;
    if ((schema || keys) && (argc || from || check || schema == keys))
        die_usage("--schema and --keys stand alone");
    if (schema || keys) return print_keys();
    if (from && argc) die_usage("--from takes the place of %s", argv[0]);
    if (!from && (argc != 1 || !*argv[0])) die_usage("one operand: a number of balls, or a scene");
    if (from && dim != 3)
        die_usage("--from has balls; discs are a scene's: \"dim\": 2, \"import\"");
    if (check) begin_stdout();
    if (!check && writer_open(&out, cli_output(), WRITER_STREAM, &failure)) die_why(&failure);
    double n;
    if (from)
        read_from(&scene, from);
    else if (is_number(argv[0], &n)) {
        if (!(n >= 0 && n <= INT32_MAX && n == floor(n)))
            die_usage("%s: not a number of balls (0 to %d)", argv[0], INT32_MAX);
        if (scene_paper(&scene, (int)dim, (int64_t)n, &failure)) die_why(&failure);
    } else {
        read_scene(&scene, argv[0], &dir);
    }
    for (int32_t k = 0; k < scene.meshes; k++) say_left_out(&scene.mesh_file[k]);
    for (int32_t k = 0; k < scene.fits; k++) say_fit(&scene.fit[k]);
    if (check && !(scene.built = calloc((size_t)scene.groups + 1, sizeof *scene.built)))
        die(EX_SOFTWARE, "no memory for the sizes of grains");
    if (scene_build(&frame.packing, &scene, dir, &failure)) die_why(&failure);
    const struct scene_lost lost = scene_lost(&frame.packing, &scene);
    if (lost.file) say_lost(&lost);
    if (check)
        tell(&scene, &frame.packing);
    else if (frame_note(&frame, cli_history(), &failure) || writer_frame(out, &frame, &failure) ||
             writer_close(out, &failure))
        die_why(&failure);
    free(dir), free(scene.built);
    scene_free(&scene);
    frame_free(&frame);
    return 0;
}
