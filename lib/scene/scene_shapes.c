/* scene/scene_shapes.c: the shapes of walls from their JSON. */
#include "scene/scene_read.h"

#include <stdlib.h>
#include <string.h>

#define AT(member) offsetof(struct wall, member)

/* A unit vector across n, next to the one given, or to an axis of space */
static vec3 scene_shapes_across(vec3 n, vec3 wish)
{
    vec3 e = v3_axpy(wish, -v3_dot(wish, n), n);
    double length = v3_norm(e);
    return length > 1e-9 ? v3_scale(1 / length, e) : v3_across(n);
}

static const struct key_type key_two = { ARRAY("two numbers >= 0", &key_not_negative, 2,
                                               sizeof(double)) };

/* Rows that several shapes have */
#define CENTER "center", &key_vector, AT(x), "m", REQUIRED, "[0, 0, 0]", "Centre."
#define POINT                                                                                      \
    "point", &key_vector, AT(x), "m", REQUIRED, "[0, 0, 0]", "Point on the axis, where it begins."
#define AXIS       "axis", &key_direction, AT(n), "-", REQUIRED, "[0, 0, 1]", "Direction of the axis."
#define NORMAL     "normal", &key_direction, AT(n), "-", REQUIRED, "[0, 0, 1]", "Normal."
#define RADIUS(at) "radius", &key_positive, AT(at), "m", REQUIRED, "0.1", "Radius."
#define SIDE                                                                                       \
    "side", &key_word, AT(side), "-", "\"inside\"", "\"both\"",                                    \
        "Side on which bodies stay; both: a surface without thickness.", .words = wall_side_name
#define ALONG(need, text) "along", &key_direction, AT(along), "-", need, "[1, 0, 0]", text
#define ARC(need)                                                                                  \
    "arc", &key_positive, AT(arc), "rad", need, "3.14",                                            \
        "Sector of that angle, counterclockwise about the axis from along; below 2 pi.",           \
        .most = 6.283185307179585 /* the last double below 2 pi */,                                \
        .limit = "must be below 2 pi; leave it out for all"
#define ALL   "all around"
#define FIRST "Direction in which the sector begins."

/* ---- in space ---- */

static int settle(struct wall *w, enum wall_shape shape)
{
    w->shape = shape;
    w->along = scene_shapes_across(w->n, w->along);
    return 0;
}

#define FINISH(name, shape)                                                                        \
    static int finish_##name(jnode o, struct scene *s, void *out)                                  \
    {                                                                                              \
        (void)o, (void)s;                                                                          \
        return settle(out, shape);                                                                 \
    }

static const struct key rectangle_key[] = {
    { CENTER },
    { NORMAL },
    { ALONG("an axis", "Direction of side a.") },
    { "sides", &key_two_positive, AT(size), "m", REQUIRED, "[0.2, 0.1]", "Sides [a, b]." },
    { 0 },
};
FINISH(rectangle, WALL_RECTANGLE)
const struct keys scene_rectangle_keys = { "rectangle", rectangle_key, .finish = finish_rectangle };

static const struct key disc_key[] = {
    { CENTER },
    { NORMAL },
    { RADIUS(size[1]) },
    { "hole", &key_not_negative, AT(size[0]), "m", "0", "0.02", "Radius of an orifice." },
    { 0 },
};

static int scene_shapes_finish_disc(jnode o, struct scene *s, void *out)
{
    struct wall *w = out;
    (void)s;
    w->shape = WALL_DISC;
    if (w->size[0] < w->size[1]) return 0;
    return json_node_fault(json_node_key(&o, "hole"), "must be smaller than the radius");
}

const struct keys scene_disc_keys = { "disc", disc_key, .finish = scene_shapes_finish_disc };

static const struct key cylinder_key[] = {
    { POINT },
    { AXIS },
    { RADIUS(size[0]) },
    { "length", &key_positive, AT(size[2]), "m", "infinite", "0.3",
      "Length of the lateral surface, from the point along the axis. Default: infinite in both "
      "directions." },
    { SIDE },
    { ALONG("an axis", FIRST) },
    { ARC(ALL) },
    { 0 },
};
FINISH(cylinder, WALL_CYLINDER)
const struct keys scene_cylinder_keys = { "cylinder", cylinder_key, .finish = finish_cylinder };

static const struct key cone_key[] = {
    { POINT },
    { AXIS },
    { "radii", &key_two, AT(size), "m", REQUIRED, "[0.1, 0.02]",
      "Radius r of [r, s] at the point, s at the other end." },
    { "length", &key_positive, AT(size[2]), "m", REQUIRED, "0.3", "Length along the axis." },
    { SIDE },
    { ALONG("an axis", FIRST) },
    { ARC(ALL) },
    { 0 },
};

static int finish_cone(jnode o, struct scene *s, void *out)
{
    struct wall *w = out;
    (void)s;
    if (!(w->size[0] + w->size[1] > 0))
        return json_node_fault(json_node_key(&o, "radii"), "must not both be 0");
    return settle(w, WALL_CONE);
}

const struct keys scene_cone_keys = { "cone", cone_key, .finish = finish_cone };

static const struct key sphere_key[] = { { CENTER }, { RADIUS(size[0]) }, { SIDE }, { 0 } };

static int finish_round(jnode o, struct scene *s, void *out)
{
    (void)o;
    ((struct wall *)out)->shape = s->dim == 2 ? WALL_CYLINDER : WALL_SPHERE;
    return 0;
}

const struct keys scene_sphere_keys = { "sphere", sphere_key, .finish = finish_round };

/* ---- in the plane ---- */

const struct keys scene_circle_keys = { "circle", sphere_key, .finish = finish_round };

static const struct key arc_key[] = {
    { CENTER }, { RADIUS(size[0]) }, { ALONG(REQUIRED, FIRST) }, { ARC(REQUIRED) }, { SIDE }, { 0 }
};
const struct keys scene_arc_keys = { "arc", arc_key, .finish = finish_cylinder };

const struct key_type key_segment = { ARRAY("[[x, y], [x, y]]", &key_vector, 2, sizeof(vec3)) };

int scene_read_segment(jnode a, struct scene *s, void *out)
{
    struct wall *w = out;
    const struct key ends = { .type = &key_segment };
    vec3 end[2] = { 0 };
    w->shape = WALL_RECTANGLE;
    if (keys_read_array(a, &ends, s, end)) return 1;
    vec3 d = v3_sub(end[1], end[0]);
    double length = v3_norm(d);
    if (!(length > 0 && isfinite(length))) return json_node_fault(a, "is without a length");
    w->along = v3_scale(1 / length, d), w->n = v3(-w->along.y, w->along.x, 0);
    w->x = v3_axpy(end[0], 0.5, d), w->size[0] = length;
    return 0;
}

/* ---- meshes ---- */

#undef AT
#define AT(member) offsetof(struct scene_mesh, member)

static const struct key mesh_key[] = {
    { "file", &key_file, AT(file), "-", REQUIRED, "\"drum.stl\"",
      "Triangles, see Files of surfaces." },
    { "scale", &key_positive, AT(scale), "m", "1", "0.001", "Length of a unit of the file." },
    { "at", &key_vector, AT(at), "m", "0", "[0, 0, 0.1]", "Position of its origin." },
    { "parts", &key_mesh_parts, AT(groups), "-", "none", "\"groups\"",
      "Names of parts of it, see Names.", .read = scene_read_mesh_parts },
    { 0 },
};
const struct keys scene_mesh_keys = { "mesh", mesh_key };

/* The file is read by whoever can, before the scene is built. */
int scene_read_mesh(jnode o, struct scene *s, void *out)
{
    struct wall *w = out;
    struct scene_mesh *more = realloc(s->mesh_file, ((size_t)s->meshes + 1) * sizeof *more);
    if (!more) return failure_set(o.in->failure, EX_SOFTWARE, "no memory for a mesh");
    s->mesh_file = more;
    struct scene_mesh *m = &more[s->meshes++];
    *m = (struct scene_mesh){ .wall = s->walls };
    w->shape = WALL_MESH;
    if (keys_read(o, &scene_mesh_keys, s, m)) return 1;
    w->x = m->at;
    return 0;
}

/* A chain of segments */
struct polygon {
    int32_t first, points; /* of the scene's mesh */
    bool closed;           /* from the last point to the first, too */
};

static int scene_shapes_read_points(jnode a, struct scene *s, void *out)
{
    struct polygon *p = out;
    size_t n = 0;
    vec3 *vertex;
    int32_t(*element)[3];
    if (json_node_array(a, &n)) return 1;
    if (n < 2 || n > 1 << 24) return json_node_fault(a, "needs two points or more");
    p->first = s->mesh.vertices, p->points = (int32_t)n;
    if (mesh_grow(&s->mesh, (int32_t)n, 0, &vertex, &element, a.in->failure)) return 1;
    for (size_t i = 0; i < n; i++)
        if (json_node_vector(json_node_item(&a, i), 2, &vertex[i])) return 1;
    return 0;
}

#undef AT
#define AT(member) offsetof(struct polygon, member)

static const struct key_type key_points = { "array of vectors", "{'$ref': 'points'}", NULL, NULL };
const struct key_type key_parts = { "array", "{'type': 'array', 'items': {'$ref': 'part'}}", NULL,
                                    NULL, &scene_part_keys };

static const struct key polygon_key[] = {
    { "points", &key_points, 0, "m", REQUIRED, "[[0, 0], [1, 0]]",
      "Corners of a chain of segments.", .read = scene_shapes_read_points },
    { "closed", &key_bool, AT(closed), "-", "true", "false",
      "A segment goes from the last point to the first." },
    { "parts", &key_parts, 0, "-", "none", "see above", "As for a mesh.",
      .read = scene_read_parts },
    { 0 },
};
const struct keys scene_polygon_keys = { "polygon", polygon_key };

int scene_read_polygon(jnode o, struct scene *s, void *out)
{
    struct wall *w = out;
    struct polygon p = { 0 };
    vec3 *vertex;
    int32_t(*element)[3];
    if (keys_read(o, &scene_polygon_keys, s, &p)) return 1;
    const int32_t segments = p.points - !(p.closed && p.points > 2);
    w->shape = WALL_MESH, w->first_element = s->mesh.elements, w->elements = segments;
    if (mesh_grow(&s->mesh, 0, segments, &vertex, &element, o.in->failure)) return 1;
    vertex = s->mesh.vertex + p.first;
    for (int32_t k = 0; k < segments; k++) {
        int32_t next = (k + 1) % p.points;
        element[k][0] = p.first + k, element[k][1] = element[k][2] = p.first + next;
        jnode points = json_node_key(&o, "points");
        if (!(v3_norm(v3_sub(vertex[next], vertex[k])) > 0))
            return json_node_fault(json_node_item(&points, (size_t)next),
                                   "lies where the last one does");
    }
    return 0;
}
