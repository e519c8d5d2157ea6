/* scene/scene_room.c: the room between walls, from its JSON: the load that its walls have together [state/servo_box.h]. */
#include "scene/scene_read.h"

#include <stdlib.h>
#include <string.h>

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
    int bad = !in || scene_walls_read_names(json_node_key(&o, "walls"), s, in) || set_loads(o, s, in);
    free(in);
    return bad;
}
