/* scene/scene_parse.c: a scene from its JSON text; see scene/scene.h. */

#include "scene/scene.h"
#include "scene/scene_read.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *scene_alloc(jnode n, size_t count, size_t size)
{
    void *p = calloc(count ? count : 1, size);
    if (!p) failure_set(n.in->failure, EX_SOFTWARE, "no memory for the scene");
    return p;
}

int scene_read_later(jnode n, const struct key *k, struct scene *s, void *member)
{
    (void)n, (void)k, (void)s, (void)member;
    return 0;
}

/* The text without the blanks outside its strings. */
static char *compact(const char *text)
{
    char *out = malloc(strlen(text) + 1), *o = out;
    bool inside = false;
    for (const char *s = text; out && *s; s++) {
        if (!inside && strchr(" \t\r\n", *s)) continue;
        if (inside && *s == '\\')
            *o++ = *s++;
        else if (*s == '"')
            inside = !inside;
        *o++ = *s;
    }
    if (out) *o = 0;
    return out;
}

/* A number, or "auto" */
static int read_dt(jnode n, struct scene *s, void *dt)
{
    (void)s;
    if (!json_is_string(n.json)) return json_node_number(n, J_POSITIVE, dt);
    *(double *)dt = 0;
    return strcmp(json_string_value(n.json), "auto")
               ? json_node_fault(n, "needs a number of seconds, or \"auto\"")
               : 0;
}

static int read_dim(jnode n, struct scene *s, void *out)
{
    int64_t dim = 3;
    (void)out;
    if (json_node_integer(n, 2, 3, &dim)) return 1;
    s->dim = (int)dim;
    s->g = dim == 2 ? v3(0, -9.81, 0) : v3(0, 0, -9.81);
    return 0;
}

#define AT(member) offsetof(struct scene, member)
#define LIST(name, keys, help)                                                                     \
#name, &key_list, 0, "-", "none", "see below", help, .object = &scene_##keys##_keys,           \
                                                         .always = true, .read = scene_read_##name

static const struct key_type key_dim = { "2 or 3", "{'enum': [2, 3]}", NULL, NULL };
static const struct key_type key_dt = {
    "number or \"auto\"",
    "{'anyOf': [{'type': 'number', 'exclusiveMinimum': 0}, {'const': 'auto'}]}", NULL, NULL
};

/* In the order in which they are read: bodies refer to materials, names, shapes, the cell and the walls. */
static const struct key scene_key[] = {
    { "title", &key_text, AT(title), "-", "none", "\"A drum\"",
      "Title, shown in pictures and pages." },
    { "dim", &key_dim, 0, "-", "3", "2",
      "3: balls and solids in space. 2: discs and polygons in the plane z = 0, which rotate "
      "about z.",
      .always = true, .read = read_dim },
    { "dt", &key_dt, AT(dt), "s", "chosen", "5e-4",
      "Time step, which nsd-step makes of small ones. The default follows from the accelerations. "
      "\"auto\": the one that nsd-gen --check suggests for one solve per step.",
      .read = read_dt },
    { "theta", &key_share, AT(theta), "-", "0.5", "0.5",
      "Parameter of the theta-method, see nsd-methods(7)." },
    { "gravity", &key_vector, AT(g), "m/s^2", "9.81 down", "[0, 0, -9.81]",
      "Acceleration of gravity; the default acts along the last axis." },
    { "time", &key_number, AT(t), "s", "0", "0",
      "Time at which the scene begins. Drives and pours have the state of that time." },
    { "seed", &key_integer, AT(seed), "-", "1", "7", "Seed of the random numbers.",
      .most = UINT32_MAX },
    { "density", &key_positive, AT(density), "kg/m^3", "2500", "2600",
      "Density of every material without its own; in 2D in kg/m^2." },
    { "", &key_include, AT(common), .object = &scene_law_keys },
    { "materials", &key_map, 0, "-", "none", "{\"steel\": {}}",
      "Materials by name. The materials ball and wall always exist.",
      .object = &scene_material_keys, .always = true, .read = scene_read_materials },
    { LIST(pairs, pair, "Exceptions for pairs of materials.") },
    { "allow_overlap", &key_bool, AT(allow_overlap), "-", "false", "true",
      "Allow bodies to overlap at the start. Otherwise an overlap of more than a millionth of "
      "the smaller radius is an error; of a tenth for bodies that come from a document or a "
      "table." },
    { "shapes", &key_forms, 0, "-", "none", "see below",
      "Shapes of grains by name, see Shapes of grains.", .read = scene_read_shapes },
    { "cell", &key_cell, AT(cell), "-", "none", "see below",
      "Periodic cell, see Periodic cells. Default: the cell of the first document among the "
      "bodies, in its last state; null: none.",
      .always = true, .read = scene_read_cell },
    { LIST(walls, wall,
           "Walls, see Walls. Default: the walls of the first document among the bodies, in their "
           "last position.") },
    { "servo", &key_object, 0, "-", "none", "{\"walls\": \"box\"}",
      "Walls that move in proportion under one mean pressure, see Servo boxes.",
      .object = &scene_room_keys, .read = scene_read_room },
    { LIST(bodies, bodies, "Groups of bodies, see Groups of bodies.") },
    { "pour", &key_list, 0, "-", "none", "see below", "Inlets, see Inlets and outlets.",
      .object = &scene_pour_keys, .always = true, .read = scene_read_pours },
    { "remove", &key_list, 0, "-", "none", "see below", "Outlets.", .object = &scene_removal_keys,
      .always = true, .read = scene_read_removals },
    { LIST(forces, force, "Forces and torques on single bodies, see Forces on single bodies.") },
    { 0 },
};
const struct keys scene_keys = { "scene", scene_key };

int scene_parse(struct scene *s, const char *text, size_t length, struct scene_files *files,
                struct failure *failure)
{
    struct json_doc t;
    *s = (struct scene){ .dim = 3, .dt = NAN, .files = files };
    if (json_doc_parse(&t, text, length, failure)) return failure->status;
    int bad = keys_read(json_doc_root(&t), &scene_keys, s, s);
    s->files = NULL, s->title = NULL;
    if (!bad && !(s->text = s->rewritten ? json_dumps(t.root, JSON_COMPACT) : compact(t.text)))
        bad = failure_set(failure, EX_SOFTWARE, "no memory for the scene's text");
    json_doc_free(&t);
    if (bad) scene_free(s);
    return failure->status;
}

/* The paper's examples 2 and 3, and heaps of their proportions. */

int scene_paper(struct scene *s, int dim, int64_t n, struct failure *failure)
{
    char text[1000], y[64] = "";
    bool two = n == 4;
    double share = (double)n / 500;
    double columns = dim == 2 ? 25 * sqrt(share) : 6 * cbrt(share);
    double half = two ? 0.8e-3 : 0.525e-3 * fmax(1, round(columns)); // m, of the box
    if (dim == 3) snprintf(y, sizeof y, "\"y\": [-%.10g, %.10g], ", half, half);
    int length =
        snprintf(text, sizeof text,
                 "{ \"title\": \"Sedimentation of %lld %s%s\",\n"
                 "  \"comment\": \"The paper gives radii, mu and dt. The rest is ours.\",\n"
                 "  \"dim\": %d, \"dt\": %s, \"seed\": %d, \"gravity\": %s,\n"
                 "  \"density\": 2500, \"mu\": 0.3, \"e_n\": 0, \"e_t\": 0,\n"
                 "  \"bodies\": [{ \"count\": %lld, \"radius\": { \"uniform\": [%s, 5e-4] } }],\n"
                 "  \"walls\": [{ \"box\": { \"x\": [-%.10g, %.10g], %s\"%c\": [0, null] } }] }\n",
                 (long long)n, dim == 2 ? "disc" : "ball", n == 1 ? "" : "s", dim,
                 two ? "1e-4" : "5e-5", two ? 9 : 1, dim == 2 ? "[0, -9.81]" : "[0, 0, -9.81]",
                 (long long)n, two ? "4e-4" : "2.5e-4", half, half, y, dim == 2 ? 'y' : 'z');
    return scene_parse(s, text, (size_t)length, NULL, failure);
}
