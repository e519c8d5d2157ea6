/* scene/scene_solids.c: "shapes" of grains from their JSON, and the shape of a group. */
#include "scene/clump_fit.h"
#include "scene/hull.h"
#include "scene/scene_read.h"
#include "scene/surface_parts.h"
#include "shape/solid.h"

#include <stdlib.h>
#include <string.h>

enum {
    SIDES_MOST = 256,      /* of a regular polygon */
    POINTS_MOST = 1 << 20, /* of a hull */
    SEGMENTS_MOST = 31     /* of a superquadric between two of its axes: 4 n^2 + 2 corners */
};

/* A box by its faces, corners from -a/2 to a/2 */
static int make_box(struct shape *s, int dim, vec3 sides, struct failure *failure)
{
    static const int32_t face[6][4] = { { 0, 4, 6, 2 }, { 1, 3, 7, 5 }, { 0, 1, 5, 4 },
                                        { 2, 6, 7, 3 }, { 0, 2, 3, 1 }, { 4, 5, 7, 6 } };
    static const int32_t loop[4] = { 0, 1, 3, 2 };
    if (shape_alloc(s, dim == 2 ? 4 : 8, dim == 2 ? 1 : 6, dim == 2 ? 4 : 24, failure))
        return failure->status;
    for (int32_t i = 0; i < s->vertices; i++)
        s->vertex[i] = v3((i & 1 ? 0.5 : -0.5) * sides.x, (i & 2 ? 0.5 : -0.5) * sides.y,
                          dim == 2 ? 0 : (i & 4 ? 0.5 : -0.5) * sides.z);
    for (int32_t i = 0; i < s->corners; i++) s->corner[i] = dim == 2 ? loop[i] : face[i / 4][i % 4];
    for (int32_t f = 0; f <= s->faces; f++) s->first[f] = 4 * f;
    return 0;
}

static int scene_solids_read_box(jnode o, struct shape *s, int dim)
{
    jnode box = json_node_key(&o, "box");
    vec3 a = v3(1, 1, 1);
    if (json_node_vector(box, dim, &a)) return 1;
    if (!(a.x > 0 && a.y > 0 && (dim == 2 || a.z > 0)))
        return json_node_fault(box, "its sides must be positive");
    return make_box(s, dim, a, o.in->failure);
}

static int read_capsule(jnode o, struct shape *s)
{
    double length = 0;
    jnode c = json_node_key(&o, "capsule");
    if (json_node_only(c, "length radius") || json_node_need(&c, "length radius") ||
        json_node_number(json_node_key(&c, "length"), J_POSITIVE, &length) ||
        json_node_number(json_node_key(&c, "radius"), J_POSITIVE, &s->round))
        return 1;
    double round = s->round;
    if (shape_alloc(s, 2, 0, 0, o.in->failure)) return 1;
    s->form = SHAPE_CAPSULE, s->round = round;
    s->vertex[0] = v3(-length / 2, 0, 0), s->vertex[1] = v3(length / 2, 0, 0);
    return 0;
}

/* A ball of a clump: [x, y, z, r], in the plane [x, y, r] */
static int read_ball(jnode n, int dim, vec3 *x, double *r)
{
    size_t length;
    double of[4] = { 0 };
    if (json_node_array(n, &length)) return 1;
    if (length != (size_t)dim + 1)
        return json_node_fault(n, "needs %d numbers, its centre and its radius", dim + 1);
    for (size_t k = 0; k < length; k++) {
        jnode number = json_node_item(&n, k);
        if (json_node_number(number, k + 1 < length ? J_ANY : J_POSITIVE, &of[k])) return 1;
    }
    *x = v3(of[0], of[1], dim == 2 ? 0 : of[2]), *r = of[dim];
    return 0;
}

static int read_balls(jnode o, struct shape *s, int dim)
{
    size_t n;
    jnode balls = json_node_key(&o, "balls");
    if (json_node_array(balls, &n)) return 1;
    if (n < 1 || n > SHAPE_VERTICES_MOST)
        return json_node_fault(balls, "needs 1 to %d balls", SHAPE_VERTICES_MOST);
    if (shape_alloc(s, (int32_t)n, 0, 0, o.in->failure)) return 1;
    s->form = SHAPE_CLUMP;
    for (size_t i = 0; i < n; i++)
        if (read_ball(json_node_item(&balls, i), dim, &s->vertex[i], &s->ball[i])) return 1;
    return 0;
}

/* A list of points; to be freed. NULL: a fault */
static vec3 *read_points(jnode list, int dim, size_t least, size_t most, size_t *n)
{
    if (json_node_array(list, n)) return NULL;
    if (*n < least || *n > most) {
        json_node_fault(list, "needs %zu to %zu points", least, most);
        return NULL;
    }
    vec3 *x = scene_alloc(list, *n, sizeof *x);
    for (size_t i = 0; x && i < *n; i++)
        if (json_node_vector(json_node_item(&list, i), dim, &x[i])) {
            free(x);
            return NULL;
        }
    return x;
}

static int read_hull(jnode o, struct shape *s, int dim)
{
    size_t n;
    jnode points = json_node_key(&o, "points");
    vec3 *x = read_points(points, dim, (size_t)dim + 1, POINTS_MOST, &n);
    struct failure failure = { 0 };
    if (!x) return 1;
    hull_of_points(s, dim, (int64_t)n, x, &failure);
    free(x);
    if (failure.status == EX_DATAERR) return json_node_fault(points, "%s", failure.text);
    return failure.status ? failure_set(o.in->failure, failure.status, "%s", failure.text) : 0;
}

static int scene_solids_read_polygon(jnode o, struct shape *s)
{
    size_t n;
    vec3 *x = read_points(json_node_key(&o, "polygon"), 2, 3, SHAPE_VERTICES_MOST, &n);
    int bad = !x || shape_alloc(s, (int32_t)n, 1, (int32_t)n, o.in->failure);
    for (size_t i = 0; !bad && i < n; i++) s->vertex[i] = x[i], s->corner[i] = (int32_t)i;
    if (!bad) s->first[1] = (int32_t)n;
    free(x);
    return bad;
}

/* The corners of a face */
static int scene_solids_read_face(jnode face, struct shape *s, size_t room)
{
    size_t n;
    if (json_node_array(face, &n)) return 1;
    if (n < 3) return json_node_fault(face, "a face has three corners or more");
    if ((size_t)s->corners + n > room) return json_node_fault(face, "too many corners");
    for (size_t k = 0; k < n; k++) {
        int64_t v = 0;
        if (json_node_integer(json_node_item(&face, k), 0, s->vertices - 1, &v)) return 1;
        s->corner[s->corners++] = (int32_t)v;
    }
    s->first[++s->faces] = s->corners;
    return 0;
}

/* A polyhedron as it is given: nothing is mended. */
static int read_polyhedron(jnode o, struct shape *s)
{
    size_t n, faces;
    jnode list = json_node_key(&o, "faces");
    if (json_node_need(&o, "faces") || json_node_array(list, &faces)) return 1;
    vec3 *x = read_points(json_node_key(&o, "vertices"), 3, 4, SHAPE_VERTICES_MOST, &n);
    if (!x) return 1;
    size_t room = 6 * n; // a closed surface has no more
    int bad = shape_alloc(s, (int32_t)n, 2 * (int32_t)n, (int32_t)room, o.in->failure);
    for (size_t i = 0; !bad && i < n; i++) s->vertex[i] = x[i];
    free(x);
    s->faces = s->corners = 0;
    if (!bad && (faces < 4 || faces > 2 * n))
        return json_node_fault(list, "%zu faces close no body of %zu vertices", faces, n);
    for (size_t f = 0; !bad && f < faces; f++)
        bad = scene_solids_read_face(json_node_item(&list, f), s, room);
    return bad;
}

/* A regular polygon in the plane; in space a prism of them along z */
static int read_regular(jnode o, struct shape *s, int dim)
{
    int64_t sides = 0;
    double radius = 0, height = 0;
    jnode r = json_node_key(&o, "regular");
    const char *keys = dim == 2 ? "sides radius" : "sides radius height";
    if (json_node_only(r, keys) || json_node_need(&r, keys) ||
        json_node_integer(json_node_key(&r, "sides"), 3, SIDES_MOST, &sides) ||
        json_node_number(json_node_key(&r, "radius"), J_POSITIVE, &radius) ||
        json_node_number(json_node_key(&r, "height"), J_POSITIVE, &height))
        return 1;
    int32_t n = (int32_t)sides, levels = dim == 2 ? 1 : 2;
    if (shape_alloc(s, n * levels, dim == 2 ? 1 : n + 2, dim == 2 ? n : 6 * n, o.in->failure))
        return 1;
    for (int32_t i = 0; i < n * levels; i++) {
        vec3 x = quat_turn(quat_rotation(v3(0, 0, 2 * M_PI * (i % n) / n)), v3(radius, 0, 0));
        s->vertex[i] = v3(x.x, x.y, dim == 2 ? 0 : i < n ? -height / 2 : height / 2);
    }
    for (int32_t i = 0; i < n; i++) {
        s->corner[i] = dim == 2 ? i : n - 1 - i; // of the lower face, seen from below
        if (dim == 2) continue;
        const int32_t side[4] = { i, (i + 1) % n, n + (i + 1) % n, n + i };
        s->corner[n + i] = n + i;
        for (int k = 0; k < 4; k++) s->corner[2 * n + 4 * i + k] = side[k];
    }
    for (int32_t f = 1; f <= s->faces; f++) s->first[f] = f <= 2 ? f * n : 2 * n + 4 * (f - 2);
    return 0;
}

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

/* "solid": what the balls of a clump stand for: its volume, m^3, its centre, m, and its inertia about that, m^5 */
static int scene_solids_read_solid(jnode o, struct solid *as)
{
    jnode n = json_node_key(&o, "solid"), rows = json_node_key(&n, "inertia");
    double inertia[3][3];
    size_t length;
    if (!n.json) return 0;
    if (json_node_only(n, "volume centre inertia") || json_node_need(&n, "volume centre inertia") ||
        json_node_number(json_node_key(&n, "volume"), J_POSITIVE, &as->volume) ||
        json_node_vector(json_node_key(&n, "centre"), 3, &as->centre) ||
        json_node_array(rows, &length))
        return 1;
    if (length != 3) return json_node_fault(rows, "needs three rows of three numbers");
    for (size_t i = 0; i < 3; i++) {
        vec3 row = v3(0, 0, 0);
        if (json_node_vector(json_node_item(&rows, i), 3, &row)) return 1;
        inertia[i][0] = row.x, inertia[i][1] = row.y, inertia[i][2] = row.z;
    }
    turn_moments(as->second, inertia, 0.5);
    double(*S)[3] = as->second;
    const double minor = S[0][0] * S[1][1] - S[0][1] * S[1][0];
    const double det = S[0][0] * (S[1][1] * S[2][2] - S[1][2] * S[2][1]) -
                       S[0][1] * (S[1][0] * S[2][2] - S[1][2] * S[2][0]) +
                       S[0][2] * (S[1][0] * S[2][1] - S[1][1] * S[2][0]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < i; j++)
            if (S[i][j] != S[j][i]) return json_node_fault(rows, "must be symmetric");
    return S[0][0] > 0 && minor > 0 && det > 0
               ? 0
               : json_node_fault(rows,
                                 "is the inertia of no body: each principal moment must be less "
                                 "than the sum of the others");
}

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

/* "clump": balls in the surface of a mesh */
static int read_clump(jnode o, struct shape *s, const struct mesh *mesh, const char *file,
                      struct solid *as, struct scene *scene)
{
    jnode c = json_node_key(&o, "clump");
    int64_t balls = 0;
    struct clump_limits limits = { 0 };
    struct clump_errors errors = { 0 };
    struct failure failure = { 0 };
    if (json_node_only(c, "balls error") || json_node_need(&c, "balls") ||
        json_node_integer(json_node_key(&c, "balls"), 1, CLUMP_BALLS_MOST, &balls) ||
        json_node_number(json_node_key(&c, "error"), J_UNIT, &limits.error))
        return 1;
    limits.balls = (int32_t)balls;
    clump_fit(s, as, mesh, &limits, &errors, &failure);
    if (failure.status == EX_DATAERR) return json_node_fault(c, "%s: %s", file, failure.text);
    if (failure.status) return failure_set(o.in->failure, failure.status, "%s", failure.text);
    if (rewrite_clump(o, s, as, &errors, scene) || note_fit(o, scene, &errors)) return 1;
    return scene_solids_read_solid(o, as); // as who reads the rewritten scene gets it
}

/* A polyhedron, or a clump, from the triangles of a file */
static int scene_solids_read_mesh(jnode o, struct shape *s, struct solid *as, struct scene *scene)
{
    const char *name = NULL;
    double scale = 1;
    bool hull = false, by_hull = false;
    int32_t left_out = 0;
    struct mesh mesh = { 0 };
    struct failure failure = { 0 };
    jnode m = json_node_key(&o, "mesh");
    if (json_node_only(m, "file scale hull") || json_node_need(&m, "file") ||
        json_node_text(json_node_key(&m, "file"), &name) ||
        json_node_number(json_node_key(&m, "scale"), J_POSITIVE, &scale) ||
        json_node_bool(json_node_key(&m, "hull"), &hull))
        return 1;
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

/* x^p for x in [0, 1], the same on every machine: the last bits of pow() are not. */
static double scene_solids_power(double x, double p)
{
    return (double)(float)pow(x, p);
}

/*
 * (|x/a|^n + |y/b|^n)^(m/n) + |z/c|^m = 1 at the places a R cos^(2/n), b R sin^(2/n), c d_z^(2/m) with
 * R = (1 - d_z^2)^(1/m) [Barr 1981], one for each direction d of a grid on the octahedron. So corners are
 * close where the surface is bent most.
 */
static int read_superquadric(jnode o, struct shape *s, int dim)
{
    vec3 a = v3(1, 1, 1);
    double n = 2, m = 2;
    int64_t segments = dim == 2 ? 16 : 5, count = 0;
    jnode q = json_node_key(&o, "superquadric"), e = json_node_key(&q, "exponents");
    if (json_node_only(q, "radii exponents segments") || json_node_need(&q, "radii exponents") ||
        json_node_vector(json_node_key(&q, "radii"), dim, &a) ||
        json_node_integer(json_node_key(&q, "segments"), 2, SEGMENTS_MOST, &segments))
        return 1;
    if (!(a.x > 0 && a.y > 0 && (dim == 2 || a.z > 0)))
        return json_node_fault(json_node_key(&q, "radii"), "must be positive");
    size_t exponents;
    if (json_node_array(e, &exponents)) return 1;
    if (exponents != (size_t)dim - 1)
        return json_node_fault(e, dim == 2 ? "needs one number" : "needs two numbers");
    if (json_node_number(json_node_item(&e, 0), J_POSITIVE, &n) ||
        (dim == 3 && json_node_number(json_node_item(&e, 1), J_POSITIVE, &m)))
        return 1;
    if (!(n >= 1 && m >= 1 && n <= 100 && m <= 100))
        return json_node_fault(e, "must lie in [1, 100]: below 1 it is not convex");
    int N = (int)segments;
    vec3 *x = scene_alloc(q, (size_t)(4 * N * N + 2), sizeof *x);
    if (!x) return 1;
    for (int i = -N; i <= N; i++)
        for (int j = -N; j <= N; j++) {
            int rest = N - abs(i) - abs(j);
            if (rest < 0 || (dim == 2 && rest)) continue;
            for (int k = -rest; k <= rest; k += rest ? 2 * rest : 1) {
                double length = sqrt(i * i + j * j + k * k), across = sqrt(i * i + j * j);
                double R = dim == 2 ? 1 : scene_solids_power(across / length, 2 / m);
                double cx = across > 0 ? scene_solids_power(abs(i) / across, 2 / n) : 0;
                double cy = across > 0 ? scene_solids_power(abs(j) / across, 2 / n) : 0;
                x[count++] = v3(copysign(a.x * R * cx, i), copysign(a.y * R * cy, j),
                                copysign(a.z * scene_solids_power(abs(k) / length, 2 / m), k));
            }
        }
    struct failure failure = { 0 };
    hull_of_points(s, dim, count, x, &failure);
    free(x);
    if (failure.status == EX_DATAERR) return json_node_fault(q, "%s", failure.text);
    return failure.status ? failure_set(o.in->failure, failure.status, "%s", failure.text) : 0;
}

static int read_form(jnode o, struct shape *s, struct solid *as, struct scene *scene)
{
    int dim = scene->dim;
    static const char plane[] = "box capsule balls points regular superquadric polygon",
                      space[] = "box capsule balls points regular superquadric vertices mesh";
    int which = json_node_choice(o, dim == 2 ? plane : space);
    if (which < 0) return 1;
    bool rounded = which != 1 && which != 2;
    bool clump = which == 7 && json_node_key(&o, "clump").json;
    char keys[140];
    snprintf(keys, sizeof keys, "%s%s%s", dim == 2 ? plane : space,
             dim == 3 ? " faces clump solid" : "", rounded && !clump ? " round" : "");
    s->form = SHAPE_HULL;
    if (json_node_only(o, keys)) return 1;
    if ((dim == 2 || which != 6) && json_node_key(&o, "faces").json)
        return json_node_fault(json_node_key(&o, "faces"), "goes with vertices");
    for (int k = 0; k < 2 && dim == 3; k++) {
        jnode extra = json_node_key(&o, k ? "solid" : "clump");
        if (extra.json && which != (k ? 2 : 7))
            return json_node_fault(extra, "goes with %s", k ? "balls" : "mesh");
    }
    return which == 0   ? scene_solids_read_box(o, s, dim)
           : which == 1 ? read_capsule(o, s)
           : which == 2 ? read_balls(o, s, dim) || (dim == 3 && scene_solids_read_solid(o, as))
           : which == 3 ? read_hull(o, s, dim)
           : which == 4 ? read_regular(o, s, dim)
           : which == 5 ? read_superquadric(o, s, dim)
           : which == 7 ? scene_solids_read_mesh(o, s, as, scene)
           : dim == 2   ? scene_solids_read_polygon(o, s)
                        : read_polyhedron(o, s);
}

/* What was read, in its own axes and unit; a fault of the shape is reported at its place. */
static int scene_solids_settle(jnode o, struct shape *s, const struct solid *as, int dim,
                               struct solid_frame *solid)
{
    struct failure failure = { 0 };
    if (as->volume > 0)
        solid_settle_as(s, dim, as, solid, &failure);
    else
        solid_settle(s, dim, solid, &failure);
    if (!failure.status) shape_finish(s, dim, &failure);
    if (failure.status == EX_DATAERR) return json_node_fault(o, "%s", failure.text);
    return failure.status ? failure_set(o.in->failure, failure.status, "%s", failure.text) : 0;
}

static int scene_solids_read_shape(jnode o, struct scene *s, const char *name)
{
    struct shape shape = { 0 };
    struct solid_frame solid = { 0 };
    struct solid as = { 0 }; // without a volume: the shape's own
    int bad = read_form(o, &shape, &as, s);
    bool hull = shape.form == SHAPE_HULL;
    bad = bad || (hull && json_node_number(json_node_key(&o, "round"), J_POSITIVE, &shape.round));
    for (int32_t i = 0; !bad && shape.form != SHAPE_CLUMP && i < shape.vertices; i++)
        shape.ball[i] = shape.round;
    bad = bad || scene_solids_settle(o, &shape, &as, s->dim, &solid);
    if (!bad && !(shape.name = strdup(name)))
        bad = failure_set(o.in->failure, EX_SOFTWARE, "no memory for a shape");
    if (bad) return shape_free(&shape), 1;
    if (shapes_add(&s->shapes, s->dim, &shape, o.in->failure)) return 1;
    s->solid[s->shapes.n - 1] = solid;
    return 0;
}

int scene_read_shapes(jnode o, struct scene *s)
{
    const char *name;
    json_t *value;
    size_t count = json_object_size(o.json);
    if (!o.json) return 0;
    if (!json_is_object(o.json)) return json_node_fault(o, "needs an object {...}");
    if (count >= SHAPES_MOST) return json_node_fault(o, "more than %d shapes", SHAPES_MOST - 1);
    if (!(s->solid = scene_alloc(o, count + 1, sizeof *s->solid))) return 1;
    s->solid[0] = (struct solid_frame){ 1, { 0, 0, 0 }, { 1, 0, 0, 0 } };
    json_object_foreach(o.json, name, value)
    {
        jnode n = json_node_key(&o, name);
        if (!strcmp(name, "comment")) continue;
        const char *trouble = name_trouble_of_kind(name, strlen(name));
        if (trouble) return json_node_fault(n, "the name of a shape %s", trouble);
        if (!strcmp(name, "ball")) return json_node_fault(n, "a ball is a ball");
        if (scene_solids_read_shape(n, s, name)) return 1;
    }
    return 0;
}

/* ---- the shape of a group ---- */

static int read_orientation(jnode n, int dim, struct scene_form *form)
{
    vec3 turn = v3(0, 0, 0);
    if (json_is_string(n.json)) {
        static const char *const words[] = { "random", NULL };
        int word = 0;
        if (json_node_word(n, words, &word)) return 1;
        form->tumbled = true;
        return 0;
    }
    if (scene_read_spin(n, dim, &turn)) return 1;
    form->turned = quat_rotation(turn);
    return 0;
}

int scene_read_form(jnode o, const struct scene *s, struct scene_form *form)
{
    const char *name = NULL;
    jnode n = json_node_key(&o, "shape");
    form->turned = (quat){ 1, 0, 0, 0 }, form->fill = 1;
    if (json_node_text(n, &name)) return 1;
    if (!name) {
        jnode size = json_node_key(&o, "size"), turn = json_node_key(&o, "orientation");
        if (size.json) return json_node_fault(size, "is that of a shape; a ball has a radius");
        return turn.json ? json_node_fault(turn, "is that of a shape") : 0;
    }
    form->shape = shapes_find(&s->shapes, name);
    if (form->shape < 1)
        return json_node_fault(n, "no shape \"%s\"; name it under \"shapes\"", name);
    form->fill = s->shapes.s[form->shape].volume / s->shapes.s[0].volume;
    return read_orientation(json_node_key(&o, "orientation"), s->dim, form);
}

int scene_read_sizes(jnode o, const struct scene *s, const struct scene_form *form,
                     struct scene_size *z)
{
    jnode radius = json_node_key(&o, "radius"), size = json_node_key(&o, "size");
    if (radius.json && size.json) return json_node_fault(size, "a radius is given too");
    if (!form->shape && !radius.json) return json_node_need(&o, "radius");
    if (radius.json) return scene_read_size(radius, s->dim, z);
    z->min = z->max = 1;
    if (scene_read_size(size, s->dim, z)) return 1;
    scene_size_scale(z, s->solid[form->shape].reach);
    return 0;
}
