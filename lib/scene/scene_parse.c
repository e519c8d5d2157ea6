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

static bool takes_documents(jnode bodies)
{
    bool any = false;
    for (size_t k = 0; k < json_array_size(bodies.json); k++)
        any = any || json_object_get(json_array_get(bodies.json, k), "document") ||
              json_object_get(json_array_get(bodies.json, k), "import");
    return any;
}

/* A number, or "auto" */
static int read_dt(jnode n, double *dt)
{
    if (!json_is_string(n.json)) return json_node_number(n, J_POSITIVE, dt);
    *dt = 0;
    return strcmp(json_string_value(n.json), "auto")
               ? json_node_fault(n, "needs a number of seconds, or \"auto\"")
               : 0;
}

static int scene_parse_read_scene(jnode o, struct scene *s)
{
    int64_t dim = 3, seed = 1;
    double density = 2500;
    bool boxed = false;
    const char *title;
    struct scene_law law = { 0 };
    struct scene_box box = { 0 };
    if (json_node_only(o, "title dim dt theta gravity seed density" EACH_PAIR_NUMBER(
                              PAIR_KEY) " kinds pairs time "
                                        "overlap bodies walls room forces pour remove cell shapes "
                                        "cohesion capillary rolling "
                                        "adhesion impact stiffness") ||
        json_node_need(&o, "dt") || json_node_text(json_node_key(&o, "title"), &title) ||
        json_node_integer(json_node_key(&o, "dim"), 2, 3, &dim) ||
        json_node_integer(json_node_key(&o, "seed"), 0, UINT32_MAX, &seed) ||
        read_dt(json_node_key(&o, "dt"), &s->dt) ||
        json_node_number(json_node_key(&o, "theta"), J_UNIT, &s->theta) ||
        json_node_number(json_node_key(&o, "density"), J_POSITIVE, &density) ||
        json_node_number(json_node_key(&o, "time"), J_ANY, &s->t) || scene_read_law(&o, &law) ||
        scene_read_laws(&o, s->t, &law.pair_law) ||
        json_node_bool(json_node_key(&o, "overlap"), &s->overlap))
        return 1;
    s->has_walls = json_node_key(&o, "walls").json;
    s->dim = (int)dim, s->seed = (uint64_t)seed;
    s->g = dim == 2 ? v3(0, -9.81, 0) : v3(0, 0, -9.81);
    if (json_node_vector(json_node_key(&o, "gravity"), s->dim, &s->g) ||
        scene_read_kinds(json_node_key(&o, "kinds"), s, density) ||
        scene_read_pairs(json_node_key(&o, "pairs"), s, law) ||
        scene_read_shapes(json_node_key(&o, "shapes"), s) ||
        scene_read_cell(json_node_key(&o, "cell"), s->dim, s->t,
                        takes_documents(json_node_key(&o, "bodies")), &s->cell) ||
        scene_read_walls(json_node_key(&o, "walls"), s, &box, &boxed) ||
        scene_read_room(json_node_key(&o, "room"), s) ||
        scene_read_bodies(json_node_key(&o, "bodies"), s, boxed ? &box : NULL) ||
        scene_read_pours(json_node_key(&o, "pour"), s) ||
        scene_read_removals(json_node_key(&o, "remove"), s) ||
        scene_read_forces(json_node_key(&o, "forces"), s))
        return 1;
    return 0;
}

int scene_parse(struct scene *s, const char *text, size_t length, struct scene_files *files,
                struct failure *failure)
{
    struct json_doc t;
    *s = (struct scene){ .theta = 0.5, .files = files };
    if (json_doc_parse(&t, text, length, failure)) return failure->status;
    int bad = scene_parse_read_scene(json_doc_root(&t), s);
    s->files = NULL;
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
