/* scene/scene_walls.c: boundaries, and boxes of planes, from their JSON. */
#include "scene/scene_read.h"

#include <stdlib.h>

static int scene_walls_read_side(jnode n, double lo_hi[2])
{
    size_t count;
    if (!n.json) return 0;
    if (json_node_array(n, &count)) return 1;
    if (count != 2) return json_node_fault(n, "needs [from, to]");
    for (size_t i = 0; i < 2; i++) {
        jnode end = json_node_item(&n, i);
        if (!json_is_null(end.json) && json_node_number(end, J_ANY, &lo_hi[i])) return 1;
    }
    return lo_hi[0] < lo_hi[1] ? 0 : json_node_fault(n, "its end must lie above its beginning");
}

int scene_read_box(jnode o, int dim, struct scene_box *b)
{
    if (json_node_only(o, dim == 2 ? "x y" : "x y z")) return 1;
    for (int i = 0; i < 3; i++) {
        double side[2] = { -INFINITY, INFINITY };
        if (i < dim && scene_walls_read_side(json_node_key(&o, axis_name[i]), side)) return 1;
        b->lo[i] = side[0], b->hi[i] = side[1];
    }
    return 0;
}

/* Makes a vector of any length a unit vector; false where it is zero. */
static bool scene_walls_direction(vec3 *n)
{
    double most =
        fmax(fabs(n->x), fmax(fabs(n->y), fabs(n->z))); // scaled by it so that no square overflows
    if (!(most > 0)) return false;
    *n = v3(n->x / most, n->y / most, n->z / most);
    double length = v3_norm(*n);
    *n = v3(n->x / length, n->y / length, n->z / length);
    return true;
}

int scene_read_direction(jnode n, int dim, vec3 *out)
{
    if (!n.json) return 0;
    if (json_node_vector(n, dim, out)) return 1;
    return scene_walls_direction(out) ? 0 : json_node_fault(n, "must not be zero");
}

/* ---- what a boundary yields to ---- */

/* "along" a line, or "about" an axis through a point */
static int read_way(jnode o, int dim, const struct wall *w, bool turns, struct load *l)
{
    l->way = turns ? LOAD_TURNS : LOAD_GLIDES;
    if (!turns) return scene_read_direction(json_node_key(&o, "along"), dim, &l->axis);
    jnode about = json_node_key(&o, "about");
    l->axis = dim == 2 ? v3(0, 0, 1) : w->n;
    if (dim == 2 && w->shape == BOUNDARY_PLANE)
        return json_node_fault(about, "in the plane no wall turns");
    return json_node_vector(about, dim, &l->point) ||
           scene_read_direction(json_node_key(&o, "axis"), dim, &l->axis);
}

/* A plane that a pressure on its face pushes along its normal */
static int read_pressure(jnode o, struct scene *s, struct wall *w)
{
    struct load *l = &w->load;
    l->way = LOAD_GLIDES, l->axis = w->n, l->spread = 1;
    if (w->shape != BOUNDARY_PLANE)
        return json_node_fault(json_node_key(&o, "pressure"),
                               "only a plane has a face of known size: give along and a force");
    if (json_node_only(o, "pressure mass speed travel") ||
        json_node_number(json_node_key(&o, "mass"), J_POSITIVE, &l->mass) ||
        json_node_number(json_node_key(&o, "speed"), J_ANY, &l->speed) ||
        json_node_number(json_node_key(&o, "travel"), J_ANY, &l->travel))
        return 1;
    w->first_push = s->pushes.n;
    if (scene_read_push(json_node_key(&o, "pressure"), s, s->walls, l)) return 1;
    w->pushes = s->pushes.n - w->first_push;
    return 0;
}

/* What it is free to do, and the force or the torque */
static int read_load(jnode o, struct scene *s, struct wall *w)
{
    bool plane = w->shape == BOUNDARY_PLANE;
    if (!o.json) return 0;
    if (json_node_key(&o, "pressure").json) return read_pressure(o, s, w);
    int which = json_node_choice(o, "along about");
    if (which < 0 ||
        json_node_only(o, !which                 ? "along mass force speed travel"
                          : plane || s->dim == 2 ? "about mass torque speed travel"
                                                 : "about axis mass torque speed travel") ||
        (which == 1 && json_node_need(&o, "mass")) ||
        json_node_number(json_node_key(&o, "mass"), J_POSITIVE, &w->load.mass) ||
        json_node_number(json_node_key(&o, "speed"), J_ANY, &w->load.speed) ||
        json_node_number(json_node_key(&o, "travel"), J_ANY, &w->load.travel) ||
        read_way(o, s->dim, w, which == 1, &w->load))
        return 1;
    w->first_push = s->pushes.n;
    if (scene_read_push(json_node_key(&o, which ? "torque" : "force"), s, s->walls, &w->load))
        return 1;
    w->pushes = s->pushes.n - w->first_push;
    return 0;
}

/* ---- what is common to all shapes ---- */

/* What all shapes have besides their own keys */
#define COMMON "name velocity belt kind drives until weld wear"

/* Adds a wall, and its drives. */
static int scene_walls_add_wall(jnode o, struct scene *s, struct wall w)
{
    w.first_drive = s->drives.n;
    if (scene_read_drives(json_node_key(&o, "drives"), s, s->walls)) return 1;
    w.drives = s->drives.n - w.first_drive;
    const char *name;
    if (scene_read_name(json_node_key(&o, "name"), s, &name) ||
        (name && names_give(&s->names, name, s->walls, 0, 0, o.in->failure)))
        return 1;
    s->wall[s->walls++] = w;
    return 0;
}

/* Walls at the lower x, the upper x, the lower y ..., where the box is not open */
static int add_box(jnode o, struct scene *s, struct wall w, const struct scene_box *b)
{
    for (int i = 0; i < 3; i++) {
        double e[3] = { i == 0, i == 1, i == 2 }, side[2] = { b->lo[i], b->hi[i] };
        vec3 axis = v3(e[0], e[1], e[2]), zero = v3(0, 0, 0);
        for (int k = 0; k < 2; k++) {
            w.x = v3_axpy(zero, k ? -side[1] : side[0], k ? v3_scale(-1, axis) : axis);
            w.n = k ? v3_axpy(zero, -1, axis) : axis;
            if (isfinite(side[k]) && scene_walls_add_wall(o, s, w)) return 1;
        }
    }
    return 0;
}

/* Faces that are of another kind, or move along themselves otherwise, than the surface that is to be added */
static int scene_walls_read_part(jnode o, struct scene *s, const struct wall *w)
{
    struct scene_part part = { .wall = s->walls, .kind = w->kind, .belt = w->belt };
    jnode faces = json_node_key(&o, "faces");
    size_t n = 0;
    if (json_node_only(o, "faces kind belt") || json_node_need(&o, "faces") ||
        scene_read_kind(json_node_key(&o, "kind"), s, &part.kind) ||
        json_node_vector(json_node_key(&o, "belt"), s->dim, &part.belt) ||
        json_node_array(faces, &n))
        return 1;
    if (n != 2) return json_node_fault(faces, "needs [first, last], from 0");
    if (json_node_integer(json_node_item(&faces, 0), 0, INT32_MAX, &part.first) ||
        json_node_integer(json_node_item(&faces, 1), part.first, INT32_MAX, &part.last))
        return 1;
    struct scene_part *more = realloc(s->part, ((size_t)s->parts + 1) * sizeof *more);
    if (!more) return failure_set(o.in->failure, EX_SOFTWARE, "no memory for parts of a surface");
    s->part = more, s->part[s->parts++] = part;
    return 0;
}

static int scene_walls_read_materials(jnode a, struct scene *s, const struct wall *w)
{
    size_t n = 0;
    if (!a.json) return 0;
    if (w->shape != BOUNDARY_MESH)
        return json_node_fault(a, "only a mesh or a polygon has faces; other walls have one kind");
    if (w->load.way)
        return json_node_fault(
            a, "a surface with a load has one kind: its parts would move by themselves");
    if (json_node_array(a, &n)) return 1;
    for (size_t i = 0; i < n; i++)
        if (scene_walls_read_part(json_node_item(&a, i), s, w)) return 1;
    return 0;
}

static int read_plane(jnode o, struct scene *s, struct wall w)
{
    w.n = v3(0, 0, 0);
    if (json_node_only(o, "point normal load " COMMON) || json_node_need(&o, "point normal") ||
        json_node_vector(json_node_key(&o, "point"), s->dim, &w.x) ||
        scene_read_direction(json_node_key(&o, "normal"), s->dim, &w.n) ||
        read_load(json_node_key(&o, "load"), s, &w))
        return 1;
    return scene_walls_add_wall(o, s, w);
}

static int scene_walls_read_box(jnode o, struct scene *s, struct wall w, struct scene_box *box, bool *boxed)
{
    struct scene_box b;
    if (json_node_only(o, "box " COMMON) || scene_read_box(json_node_key(&o, "box"), s->dim, &b) ||
        add_box(o, s, w, &b))
        return 1;
    if (!*boxed) *box = b, *boxed = true;
    return 0;
}

static int read_wall(jnode o, struct scene *s, struct scene_box *box, bool *boxed)
{
    static const char *const plane_shapes = "point box segment polygon circle arc";
    static const char *const space_shapes = "point box rectangle disc cylinder cone sphere mesh";
    struct wall w = boundary_plane(v3(0, 0, 0), v3(0, 0, 1), 1);
    int which = json_node_choice(o, s->dim == 2 ? plane_shapes : space_shapes);
    if (which < 0 || json_node_vector(json_node_key(&o, "velocity"), s->dim, &w.v) ||
        json_node_vector(json_node_key(&o, "belt"), s->dim, &w.belt) ||
        scene_read_kind(json_node_key(&o, "kind"), s, &w.kind) ||
        json_node_number(json_node_key(&o, "until"), J_ANY, &w.until) ||
        json_node_number(json_node_key(&o, "weld"), J_NOT_NEGATIVE, &w.weld) ||
        json_node_number(json_node_key(&o, "wear"), J_NOT_NEGATIVE, &w.wear))
        return 1;
    if (which == 0) return read_plane(o, s, w);
    if (which == 1) return scene_walls_read_box(o, s, w, box, boxed);
    int e = s->dim == 2 ? scene_read_shape_2d(o, "load materials " COMMON, s, &w)
                        : scene_read_shape_3d(o, "load materials " COMMON, s, &w);
    if (e || read_load(json_node_key(&o, "load"), s, &w) ||
        scene_walls_read_materials(json_node_key(&o, "materials"), s, &w))
        return 1;
    return scene_walls_add_wall(o, s, w);
}

int scene_read_walls(jnode a, struct scene *s, struct scene_box *box, bool *boxed)
{
    size_t n;
    if (json_node_array(a, &n) || !(s->wall = scene_alloc(a, 6 * n, sizeof *s->wall)) ||
        !(s->wall_item = scene_alloc(a, 6 * n, sizeof *s->wall_item)))
        return 1;
    for (size_t i = 0; i < n; i++) {
        int32_t first = s->walls;
        if (read_wall(json_node_item(&a, i), s, box, boxed)) return 1;
        for (int32_t k = first; k < s->walls; k++) s->wall_item[k] = (int32_t)i;
    }
    return 0;
}
