/* scene/scene_shapes.c: the shapes of boundaries from their JSON. */
#include "scene/scene_read.h"

#include <stdlib.h>
#include <string.h>

/* A unit vector across n, next to the one given, or to an axis of space */
static vec3 scene_shapes_across(vec3 n, vec3 wish)
{
    vec3 e = v3_axpy(wish, -v3_dot(wish, n), n);
    double length = v3_norm(e);
    return length > 1e-9 ? v3_scale(1 / length, e) : v3_across(n);
}

static int read_along(jnode o, int dim, struct wall *w)
{
    vec3 wish = v3(0, 0, 0);
    jnode along = json_node_key(&o, "along");
    if (scene_read_direction(along, dim, &wish)) return 1;
    w->along = scene_shapes_across(w->n, wish);
    return 0;
}

static int read_two(jnode a, enum json_range range, double out[2])
{
    size_t n = 0;
    if (json_node_array(a, &n)) return 1;
    if (n != 2) return json_node_fault(a, "needs two numbers");
    return json_node_number(json_node_item(&a, 0), range, &out[0]) ||
           json_node_number(json_node_item(&a, 1), range, &out[1]);
}

static int scene_shapes_read_side(jnode o, struct wall *w)
{
    int side = w->side;
    if (json_node_word(json_node_key(&o, "side"), boundary_side_name, &side)) return 1;
    w->side = side;
    return 0;
}

static int read_arc(jnode o, int dim, struct wall *w)
{
    jnode arc = json_node_key(&o, "arc");
    if (json_node_number(arc, J_POSITIVE, &w->arc)) return 1;
    if (w->arc >= 2 * M_PI) return json_node_fault(arc, "must be below 2 pi; leave it out for all");
    return read_along(o, dim, w);
}

/* ---- in space ---- */

static int read_rectangle(jnode o, struct scene *s, struct wall *w)
{
    (void)s;
    return json_node_only(o, "center normal along sides") ||
           json_node_need(&o, "center normal sides") ||
           json_node_vector(json_node_key(&o, "center"), 3, &w->x) ||
           scene_read_direction(json_node_key(&o, "normal"), 3, &w->n) || read_along(o, 3, w) ||
           read_two(json_node_key(&o, "sides"), J_POSITIVE, w->size);
}

static int scene_shapes_read_disc(jnode o, struct scene *s, struct wall *w)
{
    (void)s;
    if (json_node_only(o, "center normal radius hole") ||
        json_node_need(&o, "center normal radius") ||
        json_node_vector(json_node_key(&o, "center"), 3, &w->x) ||
        scene_read_direction(json_node_key(&o, "normal"), 3, &w->n) ||
        json_node_number(json_node_key(&o, "radius"), J_POSITIVE, &w->size[1]) ||
        json_node_number(json_node_key(&o, "hole"), J_NOT_NEGATIVE, &w->size[0]))
        return 1;
    if (w->size[0] < w->size[1]) return 0;
    return json_node_fault(json_node_key(&o, "hole"), "must be smaller than the radius");
}

static int read_cylinder(jnode o, struct scene *s, struct wall *w)
{
    (void)s;
    return json_node_only(o, "point axis radius length side along arc") ||
           json_node_need(&o, "point axis radius") ||
           json_node_vector(json_node_key(&o, "point"), 3, &w->x) ||
           scene_read_direction(json_node_key(&o, "axis"), 3, &w->n) ||
           json_node_number(json_node_key(&o, "radius"), J_POSITIVE, &w->size[0]) ||
           json_node_number(json_node_key(&o, "length"), J_POSITIVE, &w->size[2]) ||
           scene_shapes_read_side(o, w) || read_arc(o, 3, w);
}

static int read_cone(jnode o, struct scene *s, struct wall *w)
{
    jnode radii = json_node_key(&o, "radii");
    (void)s;
    if (json_node_only(o, "point axis radii length side along arc") ||
        json_node_need(&o, "point axis radii length") ||
        json_node_vector(json_node_key(&o, "point"), 3, &w->x) ||
        scene_read_direction(json_node_key(&o, "axis"), 3, &w->n) ||
        read_two(radii, J_NOT_NEGATIVE, w->size) ||
        json_node_number(json_node_key(&o, "length"), J_POSITIVE, &w->size[2]) ||
        scene_shapes_read_side(o, w) || read_arc(o, 3, w))
        return 1;
    return w->size[0] + w->size[1] > 0 ? 0 : json_node_fault(radii, "must not both be 0");
}

static int read_sphere(jnode o, struct scene *s, struct wall *w)
{
    (void)s;
    return json_node_only(o, "center radius side") || json_node_need(&o, "center radius") ||
           json_node_vector(json_node_key(&o, "center"), 3, &w->x) ||
           json_node_number(json_node_key(&o, "radius"), J_POSITIVE, &w->size[0]) ||
           scene_shapes_read_side(o, w);
}

/* The file is read by whoever can, before the scene is built. */
static int scene_shapes_read_mesh(jnode o, struct scene *s, struct wall *w)
{
    const char *name = NULL;
    struct scene_mesh m = { .wall = s->walls, .scale = 1 };
    if (json_node_only(o, "file scale at parts") || json_node_need(&o, "file") ||
        json_node_text(json_node_key(&o, "file"), &name) ||
        scene_read_parts(json_node_key(&o, "parts"), s, &m.groups) ||
        json_node_number(json_node_key(&o, "scale"), J_POSITIVE, &m.scale) ||
        json_node_vector(json_node_key(&o, "at"), 3, &w->x))
        return 1;
    struct scene_mesh *more = realloc(s->mesh_file, ((size_t)s->meshes + 1) * sizeof *more);
    if (more) s->mesh_file = more, m.file = strdup(name);
    if (!m.file) return failure_set(o.in->failure, EX_SOFTWARE, "no memory for a mesh");
    s->mesh_file[s->meshes++] = m;
    return 0;
}

/* A shape of space, or of the plane: its key, and who reads what is there */
struct reader_of_shape {
    const char *key;
    enum boundary_shape shape;
    int (*read)(jnode o, struct scene *s, struct wall *w);
};

static int scene_shapes_read_shape(jnode o, const char *common, struct scene *s, struct wall *w,
                                   const struct reader_of_shape *r)
{
    char names[100];
    for (; r->key; r++) {
        jnode shape = json_node_key(&o, r->key);
        if (!shape.json) continue;
        snprintf(names, sizeof names, "%s %s", r->key, common);
        w->shape = r->shape;
        return json_node_only(o, names) || r->read(shape, s, w);
    }
    return json_node_fault(o, "no shape");
}

int scene_read_shape_3d(jnode o, const char *common, struct scene *s, struct wall *w)
{
    static const struct reader_of_shape in_space[] = {
        { "rectangle", BOUNDARY_RECTANGLE, read_rectangle },
        { "disc", BOUNDARY_DISC, scene_shapes_read_disc },
        { "cylinder", BOUNDARY_CYLINDER, read_cylinder },
        { "cone", BOUNDARY_CONE, read_cone },
        { "sphere", BOUNDARY_SPHERE, read_sphere },
        { "mesh", BOUNDARY_MESH, scene_shapes_read_mesh },
        { 0 },
    };
    return scene_shapes_read_shape(o, common, s, w, in_space);
}

/* ---- in the plane ---- */

/* [[x, y], [x, y]] */
static int read_segment(jnode a, struct scene *s, struct wall *w)
{
    size_t n = 0;
    vec3 end[2] = { 0 };
    (void)s;
    if (json_node_array(a, &n)) return 1;
    if (n != 2) return json_node_fault(a, "needs two points");
    for (size_t i = 0; i < 2; i++)
        if (json_node_vector(json_node_item(&a, i), 2, &end[i])) return 1;
    vec3 d = v3_sub(end[1], end[0]);
    double length = v3_norm(d);
    if (!(length > 0 && isfinite(length))) return json_node_fault(a, "is without a length");
    w->along = v3_scale(1 / length, d), w->n = v3(-w->along.y, w->along.x, 0);
    w->x = v3_axpy(end[0], 0.5, d), w->size[0] = length;
    return 0;
}

static int read_circle(jnode o, struct scene *s, struct wall *w)
{
    (void)s;
    return json_node_only(o, "center radius side") || json_node_need(&o, "center radius") ||
           json_node_vector(json_node_key(&o, "center"), 2, &w->x) ||
           json_node_number(json_node_key(&o, "radius"), J_POSITIVE, &w->size[0]) ||
           scene_shapes_read_side(o, w);
}

static int read_arc_2d(jnode o, struct scene *s, struct wall *w)
{
    (void)s;
    return json_node_only(o, "center radius along arc side") ||
           json_node_need(&o, "center radius along arc") ||
           json_node_vector(json_node_key(&o, "center"), 2, &w->x) ||
           json_node_number(json_node_key(&o, "radius"), J_POSITIVE, &w->size[0]) ||
           scene_shapes_read_side(o, w) || read_arc(o, 2, w);
}

/* A chain of segments; closed: from the last point to the first, too */
static int scene_shapes_read_polygon(jnode o, struct scene *s, struct wall *w)
{
    size_t n = 0;
    bool closed = true;
    jnode a = json_node_key(&o, "points");
    if (json_node_only(o, "points closed parts") || json_node_need(&o, "points") ||
        scene_read_parts(json_node_key(&o, "parts"), s, NULL) ||
        json_node_bool(json_node_key(&o, "closed"), &closed) || json_node_array(a, &n))
        return 1;
    if (n < 2 || n > 1 << 24) return json_node_fault(a, "needs two points or more");
    int32_t segments = (int32_t)n - !(closed && n > 2);
    vec3 *vertex;
    int32_t(*element)[3];
    w->first_element = s->mesh.elements, w->elements = segments;
    int32_t first = s->mesh.vertices;
    if (mesh_grow(&s->mesh, (int32_t)n, segments, &vertex, &element, a.in->failure)) return 1;
    for (size_t i = 0; i < n; i++)
        if (json_node_vector(json_node_item(&a, i), 2, &vertex[i])) return 1;
    for (int32_t k = 0; k < segments; k++) {
        int32_t next = (k + 1) % (int32_t)n;
        element[k][0] = first + k, element[k][1] = element[k][2] = first + next;
        if (!(v3_norm(v3_sub(vertex[next], vertex[k])) > 0))
            return json_node_fault(json_node_item(&a, (size_t)next),
                                   "lies where the last one does");
    }
    return 0;
}

int scene_read_shape_2d(jnode o, const char *common, struct scene *s, struct wall *w)
{
    static const struct reader_of_shape in_plane[] = {
        { "segment", BOUNDARY_RECTANGLE, read_segment },
        { "circle", BOUNDARY_CYLINDER, read_circle },
        { "arc", BOUNDARY_CYLINDER, read_arc_2d },
        { "polygon", BOUNDARY_MESH, scene_shapes_read_polygon },
        { 0 },
    };
    return scene_shapes_read_shape(o, common, s, w, in_plane);
}
