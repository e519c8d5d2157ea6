/* scene/scene_walls.c: boundaries, and boxes of planes, from their JSON. */

#include "scene/scene_read.h"

#include <stdlib.h>
#include <string.h>

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

static int scene_walls_read_box(jnode o, struct scene *s, struct wall w, struct scene_box *box,
                                bool *boxed)
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

/* The room between walls, from its JSON: the load that its walls have together [state/servo_box.h]. */

/* Of normals that are to be parallel, or at right angles */
#define UPRIGHT 1e-9

/* ---- which walls ---- */

/* Names of whole walls, as long as there is room for them */
static void list_walls(const struct scene *s, char *text, size_t room)
{
    const char *had = "";
    size_t at = 0;
    *text = 0;
    for (int32_t w = 0; w < s->walls && at < room; w++) {
        const char *name = names_of_wall(&s->names, w);
        if (!name || !strcmp(name, had)) continue;
        at += (size_t)snprintf(text + at, room - at, "%s%s", at ? ", " : "", name), had = name;
    }
    if (!at) snprintf(text, room, "none has a name: give them a \"name\"");
}

/* The walls of one name */
static int add_named(jnode n, struct scene *s, bool *in)
{
    const char *name = NULL;
    char all[200];
    bool any = false;
    if (json_node_text(n, &name)) return 1;
    for (int32_t w = 0; w < s->walls; w++) {
        const char *own = names_of_wall(&s->names, w);
        if (!own || strcmp(own, name) != 0) continue;
        const struct wall *wall = &s->wall[w];
        if (in[w]) return json_node_fault(n, "names walls[%d] twice", s->wall_item[w]);
        if (wall->shape != BOUNDARY_PLANE)
            return json_node_fault(n, "walls[%d] is no plane: a room has planes, or boxes of them",
                                   s->wall_item[w]);
        if (wall->load.way)
            return json_node_fault(n, "walls[%d] has a load of its own: take one of the two away",
                                   s->wall_item[w]);
        in[w] = any = true;
    }
    if (any) return 0;
    list_walls(s, all, sizeof all);
    return json_node_fault(n, "no wall '%s', but %s", name, all);
}

static int scene_walls_read_names(jnode n, struct scene *s, bool *in)
{
    size_t count = 0;
    if (json_is_string(n.json)) return add_named(n, s, in);
    if (json_node_array(n, &count)) return 1;
    if (!count) return json_node_fault(n, "needs the name of walls, or several");
    for (size_t k = 0; k < count; k++)
        if (add_named(json_node_item(&n, k), s, in)) return 1;
    return 0;
}

/* ---- where its centre is ---- */

/* The plane that faces wall w, if possible one of the room; -1: none */
static int32_t facing(const struct scene *s, const bool *in, int32_t w)
{
    int32_t found = -1;
    for (int32_t k = 0; k < s->walls; k++) {
        const struct wall *other = &s->wall[k];
        if (other->shape != BOUNDARY_PLANE || v3_dot(other->n, s->wall[w].n) > -1 + UPRIGHT)
            continue;
        if (in[k]) return k;
        if (found < 0) found = k;
    }
    return found;
}

/* Midway between opposite walls of the room; where only one of two belongs to it, on the other */
static int find_center(jnode o, const struct scene *s, const bool *in, vec3 *center)
{
    vec3 along[3];
    int n = 0;
    *center = v3(0, 0, 0);
    for (int32_t w = 0; w < s->walls; w++) {
        if (!in[w]) continue;
        const struct wall *wall = &s->wall[w];
        bool had = false, askew = false;
        for (int k = 0; k < n; k++) {
            double cosine = fabs(v3_dot(along[k], wall->n));
            had = had || cosine > 1 - UPRIGHT;
            askew = askew || (cosine > UPRIGHT && cosine < 1 - UPRIGHT);
        }
        if (askew)
            return json_node_fault(o,
                                   "walls[%d] is neither parallel to another of the room nor "
                                   "at right angles: give a \"center\"",
                                   s->wall_item[w]);
        if (had) continue;
        int32_t k = facing(s, in, w);
        if (k < 0)
            return json_node_fault(o, "no plane faces walls[%d]: give a \"center\"",
                                   s->wall_item[w]);
        double at = v3_dot(s->wall[k].x, wall->n);
        if (in[k]) at = 0.5 * (at + v3_dot(wall->x, wall->n));
        *center = v3_axpy(*center, at, wall->n), along[n++] = wall->n;
    }
    return 0;
}

/* ---- the loads ---- */

/* 1/s: "strain_rate" along the axes, which must not change the volume where this yields */
static int read_rates(jnode n, const struct scene *s, bool yields, double rate[3])
{
    vec3 e = v3(0, 0, 0);
    if (json_node_vector(n, s->dim, &e)) return 1;
    rate[0] = e.x, rate[1] = e.y, rate[2] = e.z;
    double trace = e.x + e.y + e.z, most = fabs(e.x) + fabs(e.y) + fabs(e.z);
    if (yields && fabs(trace) > 1e-9 * most)
        return json_node_fault(n,
                               "changes the volume at %g per s, and the pressure does: take a "
                               "third of it off each (in the plane a half)",
                               trace);
    return 0;
}

/* "travel" of its walls, in their order */
static int read_travel(jnode n, struct scene *s, const bool *in)
{
    size_t count = 0, k = 0, walls = 0;
    if (!n.json) return 0;
    for (int32_t w = 0; w < s->walls; w++) walls += in[w];
    if (json_node_array(n, &count)) return 1;
    if (count != walls) return json_node_fault(n, "needs %zu numbers, one for each wall", walls);
    for (int32_t w = 0; w < s->walls; w++)
        if (in[w] && json_node_number(json_node_item(&n, k++), J_ANY, &s->wall[w].load.travel))
            return 1;
    return 0;
}

/* Signals are in the order of the walls, and those of the room have come last. */
static void sort_pushes(struct scene *s)
{
    struct drive *d = s->pushes.drive;
    for (int32_t k = 1; k < s->pushes.n; k++)
        for (int32_t i = k; i > 0 && d[i - 1].boundary > d[i].boundary; i--) {
            struct drive one = d[i];
            d[i] = d[i - 1], d[i - 1] = one;
        }
    for (int32_t w = 0; w < s->walls; w++) s->wall[w].first_push = s->wall[w].pushes = 0;
    for (int32_t k = 0; k < s->pushes.n; k++) {
        struct wall *w = &s->wall[d[k].boundary];
        if (!w->pushes++) w->first_push = k;
    }
}

static int set_loads(jnode o, struct scene *s, const bool *in)
{
    jnode pressure = json_node_key(&o, "pressure"), mass = json_node_key(&o, "mass");
    struct load l = { .way = LOAD_ROOM, .spread = pressure.json != NULL };
    double rate[3];
    s->room_yields = pressure.json;
    if (mass.json && !pressure.json)
        return json_node_fault(mass, "only a room with a \"pressure\" has a mass");
    if (read_rates(json_node_key(&o, "strain_rate"), s, pressure.json, rate) ||
        json_node_number(mass, J_POSITIVE, &l.mass) ||
        json_node_number(json_node_key(&o, "growth"), J_ANY, &l.speed) ||
        (json_node_key(&o, "center").json
             ? json_node_vector(json_node_key(&o, "center"), s->dim, &l.point)
             : find_center(o, s, in, &l.point)))
        return 1;
    if (l.speed != 0 && !pressure.json)
        return json_node_fault(json_node_key(&o, "growth"),
                               "only a room with a \"pressure\" grows: make it 0");
    for (int32_t w = 0; w < s->walls; w++) {
        const vec3 n = s->wall[w].n;
        if (!in[w]) continue;
        l.axis = n, l.rate = rate[0] * n.x * n.x + rate[1] * n.y * n.y + rate[2] * n.z * n.z;
        s->wall[w].load = l;
        if (pressure.json && scene_read_push(pressure, s, w, &s->wall[w].load)) return 1;
    }
    sort_pushes(s);
    return read_travel(json_node_key(&o, "travel"), s, in);
}

int scene_read_room(jnode o, struct scene *s)
{
    if (!o.json) return 0;
    if (json_node_only(o, "walls pressure strain_rate center mass growth travel") ||
        json_node_need(&o, "walls"))
        return 1;
    if (!json_node_key(&o, "pressure").json && !json_node_key(&o, "strain_rate").json)
        return json_node_fault(o, "has neither a \"pressure\" nor a \"strain_rate\"");
    if (!s->has_walls)
        return json_node_fault(o, "needs \"walls\" in the scene: those of a document bring theirs");
    bool *in = scene_alloc(o, (size_t)s->walls, sizeof *in);
    int bad =
        !in || scene_walls_read_names(json_node_key(&o, "walls"), s, in) || set_loads(o, s, in);
    free(in);
    return bad;
}
