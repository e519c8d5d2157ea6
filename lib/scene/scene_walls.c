/* scene/scene_walls.c: walls, and boxes of planes, from their JSON. */

#include "scene/scene_read.h"

#include <stdlib.h>
#include <string.h>

/* ---- a BOX ---- */

static int scene_walls_read_side(jnode n, double lo_hi[2])
{
    size_t count;
    if (json_node_array(n, &count)) return 1;
    if (count != 2) return json_node_fault(n, "needs [from, to]");
    for (size_t i = 0; i < 2; i++) {
        jnode end = json_node_item(&n, i);
        if (!json_is_null(end.json) && json_node_number(end, J_ANY, &lo_hi[i])) return 1;
    }
    return lo_hi[0] < lo_hi[1] ? 0 : json_node_fault(n, "its end must lie above its beginning");
}

static int read_interval(jnode n, struct scene *s, void *out)
{
    struct scene_box *b = out;
    const int i = *n.key - 'x';
    double side[2] = { -INFINITY, INFINITY };
    (void)s;
    if (scene_walls_read_side(n, side)) return 1;
    b->lo[i] = side[0], b->hi[i] = side[1];
    return 0;
}

static const struct key_type key_interval = { "[from, to]", "{'$ref': 'interval'}", NULL, NULL };

static const struct key box_key[] = {
    { "x", &key_interval, 0, "m", "open", "[0, 1]", "Interval of x; null is an open end.",
      .read = read_interval },
    { "y", &key_interval, 0, "m", "open", "[0, 1]", "Interval of y.", .read = read_interval },
    { "z", &key_interval, 0, "m", "open", "[0, null]", "Interval of z.", .read = read_interval,
      .dim = 3 },
    { 0 },
};
static const struct keys box_keys = { "box", box_key };

static int read_box(jnode n, const struct key *k, struct scene *s, void *member)
{
    struct scene_box *b = member;
    (void)k;
    for (int i = 0; i < 3; i++) b->lo[i] = -INFINITY, b->hi[i] = INFINITY;
    return keys_read(n, &box_keys, s, b);
}

const struct key_type key_box = { "BOX", "{'$ref': 'box'}", read_box, NULL, &box_keys };

/* ---- what a wall yields to ---- */

#define AT(member) offsetof(struct wall, load.member)

static const struct key load_key[] = {
    { "along", &key_direction, AT(axis), "-", "-", "[0, 0, 1]",
      "Direction in which the wall moves freely under the force.", .choice = 1 },
    { "about", &key_vector, AT(point), "m", "-", "[0, 0, 0]",
      "Point of the axis about which it rotates freely; a plane rotates only about its normal.",
      .choice = 1 },
    { "axis", &key_direction, AT(axis), "-", "of the wall", "[0, 0, 1]",
      "Direction of the axis. Default: normal or axis of the wall.", .with = "about", .dim = 3 },
    { "mass", &key_positive, AT(mass), "kg, kg m^2", "see below", "0.1",
      "Mass, or moment of inertia, which is required with about. Default of a mass: that of one "
      "layer of the grains on the face.",
      .needed = "about" },
    { "force", &key_signal, 0, "N", "0", "-20", "Force along the direction.", .with = "along" },
    { "torque", &key_signal, 0, "N m", "0", "1e-3", "Torque about the axis.", .with = "about" },
    { "pressure", &key_signal, 0, "Pa", "-", "1000",
      "Pressure on the face of a plane, which moves freely along its normal; in 2D in N/m. It "
      "replaces along and force. The face is the area between the planes perpendicular to it, at "
      "their present positions, or the cross section of a periodic cell.",
      .choice = 1 },
    { "speed", &key_number, AT(speed), "m/s, rad/s", "0", "0", "Speed at the start." },
    { "travel", &key_number, AT(travel), "m, rad", "0", "0",
      "Displacement from the described position at the start." },
    { 0 },
};

/* What it is free to do, and the force, the torque or the pressure */
static int finish_load(jnode o, struct scene *s, void *out)
{
    struct wall *w = out;
    struct load *l = &w->load;
    const bool plane = w->shape == WALL_PLANE, turns = keys_has(&o, "about");
    jnode pressure = json_node_key(&o, "pressure");
    l->way = turns ? LOAD_TURNS : LOAD_GLIDES;
    if (pressure.json && !plane)
        return json_node_fault(pressure,
                               "only a plane has a face of known size: give along and a force");
    if (turns && plane && s->dim == 2)
        return json_node_fault(json_node_key(&o, "about"), "in the plane no wall turns");
    if (plane && keys_has(&o, "axis"))
        return json_node_fault(json_node_key(&o, "axis"), "a plane turns about its normal");
    if (pressure.json) l->axis = w->n, l->spread = 1;
    if (turns && !keys_has(&o, "axis")) l->axis = s->dim == 2 ? v3(0, 0, 1) : w->n;
    w->first_push = s->pushes.n;
    jnode push = pressure.json ? pressure : json_node_key(&o, turns ? "torque" : "force");
    if (scene_read_push(push, s, s->walls, l)) return 1;
    w->pushes = s->pushes.n - w->first_push;
    return 0;
}

static const struct keys load_keys = { "load", load_key, .finish = finish_load };

/* ---- what is common to all shapes ---- */

struct wall_read {
    struct wall w;
    const char *name;
    struct scene_box box;
};

/* Adds a wall, and its drives. */
static int scene_walls_add_wall(jnode o, struct scene *s, const char *name, struct wall w)
{
    w.first_drive = s->drives.n;
    if (scene_read_drives(json_node_key(&o, "drives"), s)) return 1;
    w.drives = s->drives.n - w.first_drive;
    if (name && names_give(&s->names, name, s->walls, 0, 0, o.in->failure)) return 1;
    s->wall[s->walls++] = w;
    return 0;
}

/* Walls at the lower x, the upper x, the lower y ..., where the box is not open */
static int add_box(jnode o, struct scene *s, const struct wall_read *r)
{
    const struct scene_box *b = &r->box;
    struct wall w = r->w;
    for (int i = 0; i < 3; i++) {
        double e[3] = { i == 0, i == 1, i == 2 }, side[2] = { b->lo[i], b->hi[i] };
        vec3 axis = v3(e[0], e[1], e[2]), zero = v3(0, 0, 0);
        for (int k = 0; k < 2; k++) {
            w.x = v3_axpy(zero, k ? -side[1] : side[0], k ? v3_scale(-1, axis) : axis);
            w.n = k ? v3_axpy(zero, -1, axis) : axis;
            if (isfinite(side[k]) && scene_walls_add_wall(o, s, r->name, w)) return 1;
        }
    }
    return 0;
}

/* ---- faces that are of another material, or move along themselves otherwise ---- */

struct material_read {
    int64_t face[2];
    int32_t material;
    vec3 belt;
};

#undef AT
#define AT(member) offsetof(struct material_read, member)

static const struct key material_key[] = {
    { "faces", &key_faces, AT(face), "-", REQUIRED, "[0, 11]",
      "Range of triangles or segments, counted as for parts; ranges must not overlap." },
    { "material", &key_material, AT(material), "-", "of the wall", "\"rubber\"",
      "Material of these faces." },
    { "belt", &key_vector, AT(belt), "m/s", "of the wall", "[0.5, 0, 0]", "Belt of these faces." },
    { 0 },
};
static const struct keys material_keys = { "materials", material_key };

static int read_material(jnode o, struct scene *s, void *out)
{
    const struct wall *w = out;
    struct material_read m = { .material = w->material, .belt = w->belt };
    if (keys_read(o, &material_keys, s, &m) || scene_check_faces(o, m.face)) return 1;
    struct scene_part *more = realloc(s->part, ((size_t)s->parts + 1) * sizeof *more);
    if (!more) return failure_set(o.in->failure, EX_SOFTWARE, "no memory for parts of a surface");
    s->part = more;
    more[s->parts++] = (struct scene_part){ s->walls, m.face[0], m.face[1], m.material, m.belt };
    return 0;
}

static int scene_walls_read_materials(jnode a, struct scene *s, void *out)
{
    const struct wall *w = out;
    if (w->load.way)
        return json_node_fault(
            a, "a surface with a load has one material: its parts would move by themselves");
    return keys_each(a, s, out, read_material);
}

/* ---- a wall ---- */

#undef AT
#define AT(member) offsetof(struct wall_read, member)

/* The row of a shape, for scenes of one dimension or of both (0), whose own keys are of struct wall */
#define SHAPE(name, help, dim_)                                                                    \
#name, &key_object, AT(w), "-", "-", (dim_) == 2 ? "2D" : "3D", help,                          \
        .choice = 1, .dim = (dim_), .object = &scene_##name##_keys
#define SHAPE_READ(name, help, dim_)                                                               \
#name, &key_object, AT(w), "-", "-", (dim_) == 2 ? "2D" : "3D", help,                          \
        .choice = 1, .dim = (dim_), .object = &scene_##name##_keys, .read = scene_read_##name

static const struct key_type key_drives = { "array",
                                            "{'type': 'array', 'items': {'$ref': 'drive'}}",
                                            scene_read_later, NULL, &scene_drive_keys };

static const struct key wall_key[] = {
    { "point", &key_vector, AT(w.x), "m", "-", "[0, 0, 0]",
      "Point of a plane, in 2D of a line; bodies stay on the side that the normal points to.",
      .choice = 1 },
    { "normal", &key_direction, AT(w.n), "-", REQUIRED, "[0, 0, 1]", "Normal of the plane.",
      .with = "point" },
    { "box", &key_box, AT(box), "m", "-", "{\"x\": [0, 1], ...}", "Planes; bodies stay inside.",
      .choice = 1 },
    { "segment", &key_segment, AT(w), "m", "-", "2D", "A segment between two points.", .choice = 1,
      .dim = 2, .read = scene_read_segment },
    { SHAPE_READ(polygon, "A chain of segments.", 2) },
    { SHAPE(circle, "A circle.", 2) },
    { SHAPE(arc, "An arc of a circle.", 2) },
    { SHAPE(rectangle, "A rectangle.", 3) },
    { SHAPE(disc, "A disc, perhaps with an orifice.", 3) },
    { SHAPE(cylinder, "The lateral surface of a cylinder.", 3) },
    { SHAPE(cone, "The lateral surface of a cone.", 3) },
    { SHAPE(sphere, "A sphere.", 3) },
    { SHAPE_READ(mesh, "The triangles of a file.", 3) },
    { "name", &key_name, AT(name), "-", "none", "\"floor\"",
      "Name of the wall, for a box that of all of its sides, see Names." },
    { "velocity", &key_vector, AT(w.v), "m/s", "0", "[0, 0, -0.01]", "Constant velocity." },
    { "belt", &key_vector, AT(w.belt), "m/s", "0", "[0.5, 0, 0]",
      "Velocity with which the surface moves along itself while its shape stays: a conveyor "
      "belt. It rotates with the wall. Its component normal to the surface at a contact has no "
      "effect." },
    { "material", &key_material, AT(w.material), "-", "\"wall\"", "\"steel\"", "Material." },
    { "drives", &key_drives, 0, "-", "none", "see below",
      "Prescribed motions, applied one after the other." },
    { "until", &key_number, AT(w.until), "s", "never", "0.4",
      "Time at which the wall is removed: a gate." },
    { "weld", &key_not_negative, AT(w.weld), "m", "1e-6 of size", "1e-5",
      "Weld tolerance: corners of a mesh nearer to each other than this are one corner, and "
      "triangles that become degenerate are omitted; a rim nearer to another wall than this does "
      "not act as a rim. Default: 1e-6 of the diagonal of the box around the mesh, or of the "
      "extent of another wall." },
    { "wear", &key_not_negative, AT(w.wear), "1/Pa", "none", "1e-12",
      "Archard's coefficient k, by which nsd-stat(1) reports the worn volume: k times the "
      "normal force times the sliding distance. The shape of the wall does not change." },
    { "load", &key_object, AT(w), "-", "none", "see below",
      "Force, torque or pressure on a load-controlled wall; not for a box, which a servo may have.",
      .without = "box", .object = &load_keys },
    { "materials", &key_list, AT(w), "-", "none", "see below",
      "Materials and belts of parts of a mesh or of a polygon; not with a load.",
      .with = "mesh polygon",
      .why = "only a mesh or a polygon has faces; other walls have one material",
      .object = &material_keys, .read = scene_walls_read_materials },
    { 0 },
};

static int finish_wall(jnode o, struct scene *s, void *out)
{
    struct wall_read *r = out;
    if (!keys_has(&o, "box")) return scene_walls_add_wall(o, s, r->name, r->w);
    if (add_box(o, s, r)) return 1;
    if (!s->boxed) s->box = r->box, s->boxed = true;
    return 0;
}

const struct keys scene_wall_keys = { "wall", wall_key, .finish = finish_wall };

static int read_wall(jnode o, struct scene *s, void *out)
{
    struct wall_read r = { .w = wall_plane(v3(0, 0, 0), v3(0, 0, 1), 1) };
    int32_t *item = out;
    const int32_t first = s->walls;
    if (keys_read(o, &scene_wall_keys, s, &r)) return 1;
    for (int32_t k = first; k < s->walls; k++) s->wall_item[k] = *item;
    ++*item;
    return 0;
}

int scene_read_walls(jnode a, struct scene *s, void *out)
{
    const size_t n = json_array_size(a.json);
    int32_t item = 0;
    (void)out;
    s->has_walls = a.json;
    return !(s->wall = scene_alloc(a, 6 * n, sizeof *s->wall)) ||
           !(s->wall_item = scene_alloc(a, 6 * n, sizeof *s->wall_item)) ||
           keys_each(a, s, &item, read_wall);
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
        if (wall->shape != WALL_PLANE)
            return json_node_fault(n, "walls[%d] is no plane: a servo has planes, or boxes of them",
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
        if (other->shape != WALL_PLANE || v3_dot(other->n, s->wall[w].n) > -1 + UPRIGHT) continue;
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
                                   "walls[%d] is neither parallel to another of the servo nor at "
                                   "right angles: give a \"center\"",
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

struct room {
    struct load l;
    vec3 rate; /* 1/s, along the axes */
};

/* Rates must not change the volume where this yields. */
static int check_rates(jnode n, bool yields, vec3 e)
{
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
        for (int32_t i = k; i > 0 && d[i - 1].wall > d[i].wall; i--) {
            struct drive one = d[i];
            d[i] = d[i - 1], d[i - 1] = one;
        }
    for (int32_t w = 0; w < s->walls; w++) s->wall[w].first_push = s->wall[w].pushes = 0;
    for (int32_t k = 0; k < s->pushes.n; k++) {
        struct wall *w = &s->wall[d[k].wall];
        if (!w->pushes++) w->first_push = k;
    }
}

static int set_loads(jnode o, struct scene *s, const bool *in, struct room *r)
{
    jnode pressure = json_node_key(&o, "pressure");
    struct load *l = &r->l;
    const vec3 e = r->rate;
    l->way = LOAD_ROOM, l->spread = pressure.json != NULL;
    s->room_yields = pressure.json;
    if (check_rates(json_node_key(&o, "strain_rate"), pressure.json, e) ||
        (!keys_has(&o, "center") && find_center(o, s, in, &l->point)))
        return 1;
    if (l->speed != 0 && !pressure.json)
        return json_node_fault(json_node_key(&o, "growth"),
                               "only a servo with a \"pressure\" grows: make it 0");
    for (int32_t w = 0; w < s->walls; w++) {
        const vec3 n = s->wall[w].n;
        if (!in[w]) continue;
        l->axis = n, l->rate = e.x * n.x * n.x + e.y * n.y * n.y + e.z * n.z * n.z;
        s->wall[w].load = *l;
        if (pressure.json && scene_read_push(pressure, s, w, &s->wall[w].load)) return 1;
    }
    sort_pushes(s);
    return read_travel(json_node_key(&o, "travel"), s, in);
}

static int finish_room(jnode o, struct scene *s, void *out)
{
    if (!s->has_walls)
        return json_node_fault(o, "needs \"walls\" in the scene: those of a document bring theirs");
    bool *in = scene_alloc(o, (size_t)s->walls, sizeof *in);
    int bad = !in || scene_walls_read_names(json_node_key(&o, "walls"), s, in) ||
              set_loads(o, s, in, out);
    free(in);
    return bad;
}

#undef AT
#define AT(member) offsetof(struct room, member)

static const struct key_type key_names = { "string or array", "{'$ref': 'names'}", scene_read_later,
                                           NULL };
static const struct key_type key_travel = { "array", "{'$ref': 'numbers'}", scene_read_later,
                                            NULL };

static const struct key room_key[] = {
    { "walls", &key_names, 0, "-", REQUIRED, "\"box\"",
      "Names of the walls: planes without a load of their own, and boxes. Other walls of the "
      "scene keep their motion." },
    { "pressure", &key_signal, 0, "Pa", "none", "1000",
      "Mean pressure that controls the size of the box of walls; in 2D in N/m. A signal is that of "
      "a load. "
      "Default: nothing controls the size.",
      .some = true },
    { "strain_rate", &key_vector, AT(rate), "1/s", "0", "[0.5, 0.5, -1]",
      "Rates at which the box becomes longer along x, y and z; a wall has that along its normal.",
      .some = true },
    { "center", &key_vector, AT(l.point), "m", "see below", "[0, 0, 0]",
      "Point that stays where it is; no wall may be on its wrong side. Default: midway between "
      "opposite walls of the servo. Where only one of two opposite walls belongs to the servo, the "
      "centre is on the other one, which stays." },
    { "mass", &key_positive, AT(l.mass), "kg", "see below", "0.1",
      "Mass of each wall, as of a load; the inertia of the size is the sum of mass times squared "
      "distance at the start. Default: that of one layer of the grains on the wall.",
      .with = "pressure", .why = "only a servo with a \"pressure\" has a mass" },
    { "growth", &key_number, AT(l.speed), "1/s", "0", "0",
      "Rate at the start at which the size grows by the pressure." },
    { "travel", &key_travel, 0, "m", "0", "[0, 0, 0, ...]",
      "Displacement at the start of each wall by the servo, in the order of the walls." },
    { 0 },
};
const struct keys scene_room_keys = { "servo", room_key, .finish = finish_room };

int scene_read_room(jnode o, struct scene *s, void *out)
{
    struct room r = { 0 };
    (void)out;
    return keys_read(o, &scene_room_keys, s, &r);
}
