/* scene/scene_solids.c: "shapes" of grains from their JSON, and the shape of a group. */
#include "scene/hull.h"
#include "scene/scene_read.h"

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

static int scene_solids_read_box(jnode box, struct scene *scene, void *out)
{
    const int dim = scene->dim;
    struct shape *s = &((struct form *)out)->shape;
    const struct key sides = { .type = &key_lengths };
    vec3 a = v3(1, 1, 1);
    if (keys_read_array(box, &sides, scene, &a)) return 1;
    return make_box(s, dim, a, box.in->failure);
}

struct capsule {
    double length, radius; /* m */
};

static const struct key capsule_key[] = {
    { "length", &key_positive, offsetof(struct capsule, length), "m", REQUIRED, "0.02",
      "Length of the segment between the centres of the ends, along x." },
    { "radius", &key_positive, offsetof(struct capsule, radius), "m", REQUIRED, "0.01", "Radius." },
    { 0 },
};
static const struct keys capsule_keys = { "capsule", capsule_key };

static int read_capsule(jnode o, struct scene *scene, void *out)
{
    struct shape *s = &((struct form *)out)->shape;
    struct capsule c = { 0 };
    if (keys_read(o, &capsule_keys, scene, &c) || shape_alloc(s, 2, 0, 0, o.in->failure)) return 1;
    s->form = SHAPE_CAPSULE, s->round = c.radius;
    s->vertex[0] = v3(-c.length / 2, 0, 0), s->vertex[1] = v3(c.length / 2, 0, 0);
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

static int read_balls(jnode balls, struct scene *scene, void *out)
{
    struct shape *s = &((struct form *)out)->shape;
    size_t n;
    if (json_node_array(balls, &n)) return 1;
    if (n < 1 || n > SHAPE_VERTICES_MOST)
        return json_node_fault(balls, "needs 1 to %d balls", SHAPE_VERTICES_MOST);
    if (shape_alloc(s, (int32_t)n, 0, 0, balls.in->failure)) return 1;
    s->form = SHAPE_CLUMP;
    for (size_t i = 0; i < n; i++)
        if (read_ball(json_node_item(&balls, i), scene->dim, &s->vertex[i], &s->ball[i])) return 1;
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

static int read_hull(jnode points, struct scene *scene, void *out)
{
    const int dim = scene->dim;
    struct shape *s = &((struct form *)out)->shape;
    size_t n;
    vec3 *x = read_points(points, dim, (size_t)dim + 1, POINTS_MOST, &n);
    struct failure failure = { 0 };
    if (!x) return 1;
    hull_of_points(s, dim, (int64_t)n, x, &failure);
    free(x);
    if (failure.status == EX_DATAERR) return json_node_fault(points, "%s", failure.text);
    return failure.status ? failure_set(points.in->failure, failure.status, "%s", failure.text) : 0;
}

static int scene_solids_read_polygon(jnode list, struct scene *scene, void *out)
{
    struct shape *s = &((struct form *)out)->shape;
    size_t n;
    (void)scene;
    vec3 *x = read_points(list, 2, 3, SHAPE_VERTICES_MOST, &n);
    int bad = !x || shape_alloc(s, (int32_t)n, 1, (int32_t)n, list.in->failure);
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
static int read_polyhedron(jnode vertices, struct scene *scene, void *out)
{
    struct shape *s = &((struct form *)out)->shape;
    size_t n, faces;
    const jnode list = json_node_key(vertices.up, "faces");
    (void)scene;
    if (json_node_array(list, &faces)) return 1;
    vec3 *x = read_points(vertices, 3, 4, SHAPE_VERTICES_MOST, &n);
    if (!x) return 1;
    size_t room = 6 * n; // a closed surface has no more
    int bad = shape_alloc(s, (int32_t)n, 2 * (int32_t)n, (int32_t)room, list.in->failure);
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
struct regular {
    int64_t sides;
    double radius, height; /* m */
};

static const struct key regular_key[] = {
    { "sides", &key_integer, offsetof(struct regular, sides), "-", REQUIRED, "6",
      "Number of sides.", .least = 3, .most = SIDES_MOST },
    { "radius", &key_positive, offsetof(struct regular, radius), "m", REQUIRED, "0.01",
      "Radius of the corners." },
    { "height", &key_positive, offsetof(struct regular, height), "m", REQUIRED, "0.02",
      "Height; not in 2D.", .dim = 3 },
    { 0 },
};
static const struct keys regular_keys = { "regular", regular_key };

static int read_regular(jnode o, struct scene *scene, void *out)
{
    const int dim = scene->dim;
    struct shape *s = &((struct form *)out)->shape;
    struct regular r = { 0 };
    if (keys_read(o, &regular_keys, scene, &r)) return 1;
    const double radius = r.radius, height = r.height;
    int32_t n = (int32_t)r.sides, levels = dim == 2 ? 1 : 2;
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
struct superquadric {
    vec3 radii;         /* m */
    double exponent[2]; /* n, m */
    int64_t segments;   /* 0: the default */
};

static const struct key_type key_exponents = { ARRAY("[n, m]; 2D: [n]", &key_number, -1,
                                                     sizeof(double)) };

static const struct key superquadric_key[] = {
    { "radii", &key_lengths, offsetof(struct superquadric, radii), "m", REQUIRED,
      "[0.02, 0.01, 0.01]", "Half axes [a, b, c]." },
    { "exponents", &key_exponents, offsetof(struct superquadric, exponent), "-", REQUIRED, "[2, 2]",
      "Exponents [n, m], 1 to 100.", .least = 1, .most = 100,
      .limit = "must lie in [1, 100]: below 1 it is not convex" },
    { "segments", &key_integer, offsetof(struct superquadric, segments), "-", "5; 2D: 16", "10",
      "Number of sides between two axes.", .least = 2, .most = SEGMENTS_MOST },
    { 0 },
};
static const struct keys superquadric_keys = { "superquadric", superquadric_key };

static int read_superquadric(jnode q, struct scene *scene, void *out)
{
    const int dim = scene->dim;
    struct shape *s = &((struct form *)out)->shape;
    struct superquadric of = { v3(1, 1, 1), { 2, 2 }, dim == 2 ? 16 : 5 };
    int64_t count = 0;
    if (keys_read(q, &superquadric_keys, scene, &of)) return 1;
    const vec3 a = of.radii;
    const double n = of.exponent[0], m = of.exponent[1];
    int N = (int)of.segments;
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
    return failure.status ? failure_set(q.in->failure, failure.status, "%s", failure.text) : 0;
}

#define AT(member) offsetof(struct form, member)

static const struct key_type key_clump = { "object", "{'$ref': 'clump'}", scene_read_later, NULL,
                                           &clump_keys };
static const struct key_type key_corners = { "array of vectors", "{'$ref': 'points'}", NULL, NULL };
static const struct key_type key_balls = { "array of vectors", "{'$ref': 'balls'}", NULL, NULL };
static const struct key_type key_polygons = { "array of arrays", "{'$ref': 'polygons'}",
                                              scene_read_later, NULL };

/* What a mesh is replaced by stands before it: that is not read. */
static const struct key form_key[] = {
    { "box", &key_lengths, 0, "m", "-", "[0.02, 0.01, 0.01]",
      "A brick with these edge lengths along x, y and z; in 2D a rectangle.", .choice = 1,
      .read = scene_solids_read_box },
    { "capsule", &key_object, 0, "-", "-", "{\"length\": 2, ...}",
      "All points within a radius of a segment.", .choice = 1, .object = &capsule_keys,
      .read = read_capsule },
    { "balls", &key_balls, 0, "m", "-", "[[0, 0, 0, 1], ...]",
      "A clump of balls [x, y, z, r], which may overlap; in 2D of discs [x, y, r].", .choice = 1,
      .read = read_balls },
    { "solid", &key_object, AT(as), "-", "balls", "{\"volume\": 1, ...}",
      "The body that the balls of a clump represent. Default: their union.", .with = "balls",
      .dim = 3, .object = &solid_keys },
    { "points", &key_corners, 0, "m", "-", "[[1, 0, 0], ...]", "The convex hull of points.",
      .choice = 1, .read = read_hull },
    { "regular", &key_object, 0, "-", "-", "{\"sides\": 6, ...}",
      "A prism along z over a regular polygon; in 2D the polygon.", .choice = 1,
      .object = &regular_keys, .read = read_regular },
    { "superquadric", &key_object, 0, "-", "-", "{\"radii\": ...}",
      "The polyhedron whose corners lie on (|x/a|^n + |y/b|^n)^(m/n) + |z/c|^m = 1, in 2D the "
      "polygon of |x/a|^n + |y/b|^n = 1.",
      .choice = 1, .object = &superquadric_keys, .read = read_superquadric },
    { "polygon", &key_corners, 0, "m", "-", "[[0, 0], [1, 0], ...]",
      "A convex polygon, counterclockwise.", .choice = 1, .dim = 2,
      .read = scene_solids_read_polygon },
    { "vertices", &key_corners, 0, "m", "-", "[[1, 0, 0], ...]", "Corners of a convex polyhedron.",
      .choice = 1, .dim = 3, .read = read_polyhedron },
    { "faces", &key_polygons, 0, "-", REQUIRED, "[[0, 1, 2], ...]",
      "Its faces; the corners of a face run counterclockwise seen from outside.",
      .with = "vertices", .dim = 3 },
    { "mesh", &key_object, 0, "-", "-", "{\"file\": \"a.stl\"}",
      "A convex polyhedron from the triangles of a file.", .choice = 1, .dim = 3,
      .object = &grain_mesh_keys, .read = scene_read_grain_mesh },
    { "clump", &key_clump, 0, "-", "-", "{\"balls\": 20}",
      "A clump of balls that fill the surface of the mesh, which may be concave.", .with = "mesh",
      .dim = 3 },
    { "round", &key_positive, AT(shape.round), "m", "0", "0.001",
      "Radius of rounding: the shape becomes all points within this distance of it. Not for "
      "capsules and clumps.",
      .without = "capsule balls clump" },
    { 0 },
};
static const struct keys form_keys = { "shape", form_key };

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
    struct form form = { .shape.form = SHAPE_HULL };
    struct solid_frame solid = { 0 };
    int bad = keys_read(o, &form_keys, s, &form);
    struct shape shape = form.shape;
    for (int32_t i = 0; !bad && shape.form != SHAPE_CLUMP && i < shape.vertices; i++)
        shape.ball[i] = shape.round;
    bad = bad || scene_solids_settle(o, &shape, &form.as, s->dim, &solid);
    if (!bad && !(shape.name = strdup(name)))
        bad = failure_set(o.in->failure, EX_SOFTWARE, "no memory for a shape");
    if (bad) return shape_free(&shape), 1;
    if (shapes_add(&s->shapes, s->dim, &shape, o.in->failure)) return 1;
    s->solid[s->shapes.n - 1] = solid;
    return 0;
}

const struct key_type key_forms = { "object", "{'$ref': 'shapes'}", NULL, NULL, &form_keys };

int scene_read_shapes(jnode o, struct scene *s, void *out)
{
    const char *name;
    json_t *value;
    size_t count = json_object_size(o.json);
    (void)out;
    if (!json_is_object(o.json)) return json_node_fault(o, "needs an object {...}");
    if (count >= SHAPES_MOST) return json_node_fault(o, "more than %d shapes", SHAPES_MOST - 1);
    if (!(s->solid = scene_alloc(o, count + 1, sizeof *s->solid))) return 1;
    s->solid[0] = (struct solid_frame){ 1, { 0, 0, 0 }, { 1, 0, 0, 0 } };
    json_object_foreach(o.json, name, value)
    {
        jnode n = json_node_key(&o, name);
        if (!strcmp(name, "comment")) continue;
        const char *trouble = name_trouble_of_material(name, strlen(name));
        if (trouble) return json_node_fault(n, "the name of a shape %s", trouble);
        if (!strcmp(name, "ball")) return json_node_fault(n, "a ball is a ball");
        if (scene_solids_read_shape(n, s, name)) return 1;
    }
    return 0;
}

/* ---- the shape of a group ---- */

static int read_orientation(jnode n, const struct key *k, struct scene *s, void *member)
{
    struct scene_form *form = member;
    vec3 turn = v3(0, 0, 0);
    if (json_is_string(n.json)) {
        static const char *const words[] = { "random", NULL };
        int word = 0;
        if (json_node_word(n, words, &word)) return 1;
        form->tumbled = true;
        return 0;
    }
    if (key_spin.read(n, k, s, &turn)) return 1;
    form->turned = quat_rotation(turn);
    return 0;
}

const struct key_type key_orientation = { "\"random\", vector",
                                          "{'anyOf': [{'const': 'random'}, {'$ref': 'spin'}]}",
                                          read_orientation, NULL };

static int read_shape_name(jnode n, const struct key *k, struct scene *s, void *member)
{
    struct scene_form *form = member;
    const char *name = NULL;
    (void)k;
    if (json_node_text(n, &name)) return 1;
    form->shape = shapes_find(&s->shapes, name);
    if (form->shape < 1)
        return json_node_fault(n, "no shape \"%s\"; name it under \"shapes\"", name);
    form->fill = s->shapes.s[form->shape].volume / s->shapes.s[0].volume;
    return 0;
}

const struct key_type key_shape = { "string", "{'type': 'string'}", read_shape_name, NULL };

int scene_finish_grain(jnode o, const struct scene *s, const struct scene_form *form,
                       struct scene_size *z)
{
    if (keys_has(&o, "radius")) return 0;
    if (!keys_has(&o, "size")) z->min = z->max = 1;
    scene_size_scale(z, s->solid[form->shape].reach);
    return 0;
}
