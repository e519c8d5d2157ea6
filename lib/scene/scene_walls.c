/* scene/scene_walls.c: walls and boxes from their JSON. */
#include "scene/scene_read.h"

static int read_side(jnode n, double lo_hi[2])
{
    size_t count;
    if (!n.json) return 0;
    if (json_node_array(n, &count)) return 1;
    if (count != 2) return json_node_fault(n, "wants [from, to]");
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
        if (i < dim && read_side(json_node_key(&o, axis_name[i]), side)) return 1;
        b->lo[i] = side[0], b->hi[i] = side[1];
    }
    return 0;
}

static void add_wall(struct scene *s, struct wall w, vec3 point, vec3 normal)
{
    w.x = point, w.n = normal;
    s->wall[s->walls++] = w;
}

/* Walls at the lower x, the upper x, the lower y ..., where the box is not open */
static void add_box(struct scene *s, struct wall w, const struct scene_box *b)
{
    for (int i = 0; i < 3; i++) {
        double e[3] = { i == 0, i == 1, i == 2 }, lo = b->lo[i], hi = b->hi[i];
        vec3 n = v3(e[0], e[1], e[2]), zero = v3(0, 0, 0);
        if (isfinite(lo)) add_wall(s, w, v3_axpy(zero, lo, n), n);
        if (isfinite(hi)) add_wall(s, w, v3_axpy(zero, hi, n), v3_axpy(zero, -1, n));
    }
}

/* Makes a vector of any length a unit vector; false where it is zero. */
static bool direction(vec3 *n)
{
    double most =
        fmax(fabs(n->x), fmax(fabs(n->y), fabs(n->z))); // scaled by it so that no square overflows
    if (!(most > 0)) return false;
    *n = v3(n->x / most, n->y / most, n->z / most);
    double length = v3_norm(*n);
    *n = v3(n->x / length, n->y / length, n->z / length);
    return true;
}

/* "along" a line, under a force, or "about" the normal at a point, under a torque */
static int read_load(jnode o, int dim, vec3 normal, struct load *l)
{
    if (!o.json) return 0;
    int which = json_node_choice(o, "along about");
    if (which < 0 ||
        json_node_only(o, which ? "about mass torque speed" : "along mass force speed") ||
        json_node_need(&o, "mass") ||
        json_node_number(json_node_key(&o, "mass"), J_POSITIVE, &l->mass) ||
        json_node_number(json_node_key(&o, which ? "torque" : "force"), J_ANY, &l->force) ||
        json_node_number(json_node_key(&o, "speed"), J_ANY, &l->speed))
        return 1;
    jnode where = json_node_key(&o, which ? "about" : "along");
    if (which) {
        l->way = LOAD_TURNS, l->axis = normal;
        if (dim == 2) return json_node_fault(where, "in the plane no wall turns");
        return json_node_vector(where, dim, &l->point);
    }
    l->way = LOAD_GLIDES;
    if (json_node_vector(where, dim, &l->axis)) return 1;
    return direction(&l->axis) ? 0 : json_node_fault(where, "must not be zero");
}

static int read_plane(jnode o, struct scene *s, struct wall w)
{
    vec3 x = v3(0, 0, 0), n = x;
    if (json_node_only(o, "point normal velocity kind load") ||
        json_node_need(&o, "point normal") ||
        json_node_vector(json_node_key(&o, "point"), s->dim, &x) ||
        json_node_vector(json_node_key(&o, "normal"), s->dim, &n))
        return 1;
    if (!direction(&n)) return json_node_fault(json_node_key(&o, "normal"), "must not be zero");
    if (read_load(json_node_key(&o, "load"), s->dim, n, &w.load)) return 1;
    add_wall(s, w, x, n);
    return 0;
}

static int read_wall(jnode o, struct scene *s, struct scene_box *box, bool *boxed)
{
    struct wall w = { .kind = 1 };
    struct scene_box b;
    int which = json_node_choice(o, "point box");
    if (which < 0 || json_node_vector(json_node_key(&o, "velocity"), s->dim, &w.v) ||
        scene_read_kind(json_node_key(&o, "kind"), s, &w.kind))
        return 1;
    if (which == 0) return read_plane(o, s, w);
    if (json_node_only(o, "box velocity kind") ||
        scene_read_box(json_node_key(&o, "box"), s->dim, &b))
        return 1;
    add_box(s, w, &b);
    if (!*boxed) *box = b, *boxed = true;
    return 0;
}

int scene_read_walls(jnode a, struct scene *s, struct scene_box *box, bool *boxed)
{
    size_t n;
    if (json_node_array(a, &n) || !(s->wall = scene_alloc(a, 6 * n, sizeof *s->wall))) return 1;
    for (size_t i = 0; i < n; i++)
        if (read_wall(json_node_item(&a, i), s, box, boxed)) return 1;
    return 0;
}
