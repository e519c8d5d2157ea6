/* scene/scene_clump.c: grains from the surfaces of files: hulls, clumps that fill them, and what clumps stand for
   [scene/scene_read.h]. */
#include "scene/scene_read.h"

#include "scene/clump_fit.h"
#include "scene/surface_parts.h"

#include <stdlib.h>
#include <string.h>

/* In place of the key "mesh" of the scene's JSON, what its file has: documents keep the scene, and name
   no files. */
static int rewrite(jnode o, const struct shape *s, struct scene *scene)
{
    json_t *vertices = json_array(), *faces = json_array();
    bool bad = false;
    for (int32_t i = 0; i < s->vertices; i++) {
        vec3 x = s->vertex[i];
        bad |= json_array_append_new(vertices, json_pack("[f, f, f]", x.x, x.y, x.z)) != 0;
    }
    for (int32_t f = 0; f < s->faces; f++) {
        json_t *face = json_array();
        for (int32_t i = s->first[f]; i < s->first[f + 1]; i++)
            bad |= json_array_append_new(face, json_integer(s->corner[i])) != 0;
        bad |= json_array_append_new(faces, face) != 0;
    }
    bad |= json_object_set_new(o.json, "vertices", vertices) != 0;
    bad |= json_object_set_new(o.json, "faces", faces) || json_object_del(o.json, "mesh");
    scene->rewritten = true;
    return bad ? failure_set(o.in->failure, EX_SOFTWARE, "no memory for the scene's text") : 0;
}

/* ---- a clump that has the moments of something else ---- */

/* Moments of inertia about the centre, of density 1, and back: second = tr(inertia)/2 1 - inertia */
static void turn_moments(double to[3][3], double of[3][3], double share)
{
    const double trace = of[0][0] + of[1][1] + of[2][2];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) to[i][j] = (i == j ? share * trace : 0) - of[i][j];
}

/* "inertia" of what a clump stands for, about its centre, m^5 */
static int read_inertia(jnode n, struct scene *scene, void *out)
{
    const struct key matrix = { .type = &key_matrix };
    struct solid *as = out;
    double inertia[3][3];
    if (keys_read_array(n, &matrix, scene, inertia)) return 1;
    turn_moments(as->second, inertia, 0.5);
    double(*S)[3] = as->second;
    const double minor = S[0][0] * S[1][1] - S[0][1] * S[1][0];
    const double det = S[0][0] * (S[1][1] * S[2][2] - S[1][2] * S[2][1]) -
                       S[0][1] * (S[1][0] * S[2][2] - S[1][2] * S[2][0]) +
                       S[0][2] * (S[1][0] * S[2][1] - S[1][1] * S[2][0]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < i; j++)
            if (S[i][j] != S[j][i]) return json_node_fault(n, "must be symmetric");
    return S[0][0] > 0 && minor > 0 && det > 0
               ? 0
               : json_node_fault(n, "is the inertia of no body: each principal moment must be less "
                                    "than the sum of the others");
}

static const struct key solid_key[] = {
    { "volume", &key_positive, offsetof(struct solid, volume), "m^3", REQUIRED, "1e-6", "Volume." },
    { "centre", &key_vector, offsetof(struct solid, centre), "m", REQUIRED, "[0, 0, 0]",
      "Centre of mass." },
    { "inertia", &key_matrix, 0, "m^5", REQUIRED, "[[1, 0, 0], ...]",
      "Inertia about the centre at density 1.", .read = read_inertia },
    { 0 },
};
const struct keys solid_keys = { "solid", solid_key };

/* The balls in place of the keys "mesh" and "clump", and how well they fit as a comment */
static int rewrite_clump(jnode o, const struct shape *s, const struct solid *of,
                         const struct clump_errors *e, struct scene *scene)
{
    json_t *balls = json_array(), *rows = json_array();
    double inertia[3][3];
    char fit[200];
    bool bad = false;
    double second[3][3];
    memcpy(second, of->second, sizeof second);
    turn_moments(inertia, second, 1);
    for (int32_t i = 0; i < s->vertices; i++)
        bad |=
            json_array_append_new(balls, json_pack("[f, f, f, f]", s->vertex[i].x, s->vertex[i].y,
                                                   s->vertex[i].z, s->ball[i])) != 0;
    for (int i = 0; i < 3; i++)
        bad |= json_array_append_new(
                   rows, json_pack("[f, f, f]", inertia[i][0], inertia[i][1], inertia[i][2])) != 0;
    json_t *solid = json_pack("{s:f, s:[f, f, f], s:o}", "volume", of->volume, "centre",
                              of->centre.x, of->centre.y, of->centre.z, "inertia", rows);
    snprintf(fit, sizeof fit,
             "%d balls fitted to a surface: volume %+.2g, distance %.2g of the radius around it, "
             "moments %.2g of their sum",
             (int)e->balls, e->volume, e->distance, e->moments);
    bad |= !solid || json_object_set_new(o.json, "balls", balls) ||
           json_object_set_new(o.json, "solid", solid) || json_object_del(o.json, "mesh") ||
           json_object_del(o.json, "clump") ||
           json_object_set_new(o.json, "comment", json_string(fit));
    scene->rewritten = true;
    return bad ? failure_set(o.in->failure, EX_SOFTWARE, "no memory for the scene's text") : 0;
}

/* How well the balls of shape NAME fit, for who tells it */
static int note_fit(jnode o, struct scene *scene, const struct clump_errors *e)
{
    struct scene_fit *more = realloc(scene->fit, (size_t)(scene->fits + 1) * sizeof *more);
    if (!more) return failure_set(o.in->failure, EX_SOFTWARE, "no memory for a shape");
    scene->fit = more;
    struct scene_fit *f = &more[scene->fits];
    *f = (struct scene_fit){ strdup(o.key ? o.key : ""), e->balls, e->volume, e->distance,
                             e->moments };
    if (!f->shape) return failure_set(o.in->failure, EX_SOFTWARE, "no memory for a shape");
    scene->fits++;
    return 0;
}

struct clump {
    int64_t balls;
    double error;
};

static const struct key clump_key[] = {
    { "balls", &key_integer, offsetof(struct clump, balls), "-", REQUIRED, "20",
      "Largest number of balls.", .least = 1, .most = CLUMP_BALLS_MOST },
    { "error", &key_share, offsetof(struct clump, error), "-", "0", "0.1",
      "Fewer balls are used if no point of the surface is farther from them than this, times the "
      "radius of its circumscribed ball." },
    { 0 },
};
const struct keys clump_keys = { "clump", clump_key };

/* "clump": balls in the surface of a mesh */
static int read_clump(jnode o, struct shape *s, const struct mesh *mesh, const char *file,
                      struct solid *as, struct scene *scene)
{
    jnode c = json_node_key(&o, "clump");
    struct clump wish = { 0 };
    struct clump_errors errors = { 0 };
    struct failure failure = { 0 };
    if (keys_read(c, &clump_keys, scene, &wish)) return 1;
    const struct clump_limits limits = { (int32_t)wish.balls, wish.error };
    clump_fit(s, as, mesh, &limits, &errors, &failure);
    if (failure.status == EX_DATAERR) return json_node_fault(c, "%s: %s", file, failure.text);
    if (failure.status) return failure_set(o.in->failure, failure.status, "%s", failure.text);
    if (rewrite_clump(o, s, as, &errors, scene) || note_fit(o, scene, &errors)) return 1;
    // as who reads the rewritten scene gets it
    return keys_read(json_node_key(&o, "solid"), &solid_keys, scene, as);
}

struct mesh_file {
    const char *file;
    double scale; /* m a unit of it */
    bool hull;
};

static const struct key grain_mesh_key[] = {
    { "file", &key_text, offsetof(struct mesh_file, file), "-", REQUIRED, "\"stone.stl\"",
      "Triangles, see Files of surfaces." },
    { "scale", &key_positive, offsetof(struct mesh_file, scale), "m", "1", "0.001",
      "Length of a unit of the file; 0.001 is for millimetres." },
    { "hull", &key_bool, offsetof(struct mesh_file, hull), "-", "false", "true",
      "Take the convex hull of the corners, regardless of the triangles." },
    { 0 },
};
const struct keys grain_mesh_keys = { "grain_mesh", grain_mesh_key };

/* A polyhedron, or a clump, from the triangles of a file */
int scene_read_grain_mesh(jnode m, struct scene *scene, void *out)
{
    struct shape *s = &((struct form *)out)->shape;
    struct solid *as = &((struct form *)out)->as;
    const jnode o = *m.up;
    struct mesh_file of = { 0 };
    bool by_hull = false;
    int32_t left_out = 0;
    struct mesh mesh = { 0 };
    struct failure failure = { 0 };
    if (keys_read(m, &grain_mesh_keys, scene, &of)) return 1;
    const char *name = of.file;
    const double scale = of.scale;
    const bool hull = of.hull;
    if (!scene->files) return json_node_fault(m, "no files are read for what is in a document");
    const bool clump = json_node_key(&o, "clump").json;
    if (clump && hull) return json_node_fault(m, "hull: a clump has none");
    if (clump && !scene->files->read_mesh(&mesh, scene->files, name, scale, &left_out, &failure)) {
        int bad = read_clump(o, s, &mesh, name, as, scene);
        mesh_free(&mesh);
        return bad;
    }
    if (!clump && !scene->files->read_mesh(&mesh, scene->files, name, scale, &left_out, &failure) &&
        mesh_shape(s, &mesh, hull, &by_hull, &failure) && failure.status == EX_DATAERR)
        json_node_fault(m, "%s: %s%s%s", name, failure.text,
                        left_out ? ", without the triangles of no area or repeated" : "",
                        by_hull ? " (\"hull\": true asks for less)" : "");
    else if (failure.status)
        json_node_fault(m, "%s", failure.text);
    if (failure.status) o.in->failure->status = failure.status;
    mesh_free(&mesh);
    return failure.status ? failure.status : rewrite(o, s, scene);
}
