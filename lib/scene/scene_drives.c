/* scene/scene_drives.c: the motions of a boundary, and loads in time, from their JSON. */
#include "scene/scene_read.h"

#include <stdlib.h>

/* Room for `more` in an array of n; NULL is told. */
static void *scene_drives_grown(jnode at, void *array, int32_t n, size_t more, size_t size)
{
    void *new = realloc(array, ((size_t)n + more + 1) * size);
    if (!new) failure_set(at.in->failure, EX_SOFTWARE, "no memory for the drives");
    return new;
}

/* [[t, s], ...], t rising */
static int scene_drives_read_table(jnode a, struct drives *list, struct drive *d)
{
    size_t rows = 0;
    if (json_node_array(a, &rows)) return 1;
    if (!rows || rows > 1 << 24) return json_node_fault(a, "needs [[time, value], ...]");
    struct drive_row *row = scene_drives_grown(a, list->row, list->rows, rows, sizeof *row);
    if (!row) return 1;
    list->row = row, row += list->rows;
    d->first = list->rows, d->rows = (int32_t)rows;
    for (size_t i = 0; i < rows; i++) {
        jnode pair = json_node_item(&a, i), t, way;
        size_t two = 0;
        if (json_node_array(pair, &two)) return 1;
        if (two != 2) return json_node_fault(pair, "needs [time, value]");
        t = json_node_item(&pair, 0), way = json_node_item(&pair, 1);
        if (json_node_number(t, J_ANY, &row[i].t) || json_node_number(way, J_ANY, &row[i].s))
            return 1;
        if (i && !(row[i].t > row[i - 1].t)) return json_node_fault(t, "times must rise");
    }
    list->rows += d->rows;
    return 0;
}

static int read_signal(jnode o, struct drives *list, int which, struct drive *d)
{
    d->signal = which;
    switch (which) {
    case DRIVE_SPEED:
        return json_node_number(json_node_key(&o, "speed"), J_ANY, &d->value);
    case DRIVE_SINE:
        return json_node_need(&o, "frequency") ||
               json_node_number(json_node_key(&o, "amplitude"), J_ANY, &d->value) ||
               json_node_number(json_node_key(&o, "frequency"), J_NOT_NEGATIVE, &d->frequency) ||
               json_node_number(json_node_key(&o, "phase"), J_ANY, &d->phase);
    default:
        return scene_drives_read_table(json_node_key(&o, "table"), list, d);
    }
}

static int add_signal(jnode o, struct drives *list, struct drive d)
{
    struct drive *more = scene_drives_grown(o, list->drive, list->n, 1, sizeof *more);
    if (!more) return 1;
    list->drive = more, more[list->n++] = d;
    return 0;
}

/* "along" a direction, or "about" a point (and in space an axis) */
static int read_axis(jnode o, int dim, struct drive *d)
{
    int which = json_node_choice(o, "along about");
    if (which < 0) return 1;
    if (which == 0) return scene_read_direction(json_node_key(&o, "along"), dim, &d->axis);
    d->turns = 1, d->axis = v3(0, 0, 1);
    if (json_node_vector(json_node_key(&o, "about"), dim, &d->point)) return 1;
    if (dim == 2) return 0;
    return json_node_need(&o, "axis") ||
           scene_read_direction(json_node_key(&o, "axis"), dim, &d->axis);
}

/* "since_from": the drive's clock shows 0 at `from`, by which a sine without a phase begins where the
   boundary is. */
static int scene_drives_read_clock(jnode o, struct drive *d)
{
    bool since = false;
    if (json_node_bool(json_node_key(&o, "since_from"), &since)) return 1;
    if (!since) return 0;
    if (json_node_need(&o, "from")) return 1;
    d->clock = -d->from, d->until -= d->from, d->from = 0;
    return 0;
}

static int scene_drives_read_drive(jnode o, struct scene *s, int32_t wall)
{
    static const char *const keys[] = { "speed", "amplitude frequency phase since_from",
                                        "table since_from" };
    struct drive d = { .boundary = wall, .until = INFINITY };
    int which = json_node_choice(o, "speed amplitude table");
    char names[100];
    if (which < 0 || read_axis(o, s->dim, &d)) return 1;
    snprintf(names, sizeof names, "%s from until %s", keys[which],
             !d.turns      ? "along"
             : s->dim == 2 ? "about"
                           : "about axis");
    if (which != DRIVE_SPEED) d.from = -INFINITY;
    if (json_node_only(o, names) || read_signal(o, &s->drives, which, &d) ||
        json_node_number(json_node_key(&o, "from"), J_ANY, &d.from) ||
        json_node_number(json_node_key(&o, "until"), J_ANY, &d.until))
        return 1;
    if (!(d.from <= d.until))
        return json_node_fault(json_node_key(&o, "until"), "must not lie before its beginning");
    return scene_drives_read_clock(o, &d) || add_signal(o, &s->drives, d);
}

int scene_read_drives(jnode a, struct scene *s, int32_t wall)
{
    size_t n = 0;
    if (json_node_array(a, &n)) return 1;
    for (size_t i = 0; i < n; i++)
        if (scene_drives_read_drive(json_node_item(&a, i), s, wall)) return 1;
    return 0;
}

int scene_read_push(jnode o, struct scene *s, int32_t wall, struct load *l)
{
    if (!json_is_object(o.json)) return json_node_number(o, J_ANY, &l->force);
    struct drive d = { .boundary = wall,
                       .turns = l->way == LOAD_TURNS,
                       .axis = l->axis,
                       .from = -INFINITY,
                       .until = INFINITY };
    int which = json_node_choice(o, "amplitude table");
    if (which < 0 || json_node_only(o, which ? "table mean" : "amplitude frequency phase mean") ||
        read_signal(o, &s->pushes, which ? DRIVE_TABLE : DRIVE_SINE, &d) ||
        json_node_number(json_node_key(&o, "mean"), J_ANY, &l->force))
        return 1;
    return add_signal(o, &s->pushes, d);
}

/* ---- forces on bodies ---- */

enum { PULLS_MOST = 100000 };

/* Behind those of the bodies with as low an id */
static int add_pull(jnode o, struct scene *s, struct drive d)
{
    if (s->pulls.n >= PULLS_MOST) return json_node_fault(o, "more than %d forces", PULLS_MOST);
    if (add_signal(o, &s->pulls, d)) return 1;
    for (int32_t k = s->pulls.n - 1; k > 0 && s->pulls.drive[k - 1].boundary > d.boundary; k--)
        s->pulls.drive[k] = s->pulls.drive[k - 1], s->pulls.drive[k - 1] = d;
    return 0;
}

/* A number, which is a table of one row */
static int read_constant(jnode n, struct scene *s, struct drive *d)
{
    double value = 0;
    struct drive_row *row;
    if (json_node_number(n, J_ANY, &value)) return 1;
    if (!(row = scene_drives_grown(n, s->pulls.row, s->pulls.rows, 1, sizeof *row))) return 1;
    s->pulls.row = row, row[s->pulls.rows] = (struct drive_row){ 0, value };
    d->signal = DRIVE_TABLE, d->first = s->pulls.rows++, d->rows = 1;
    return 0;
}

/* Of each body a table of its own: documents have none that belongs to two. */
static int read_pull(jnode n, struct scene *s, struct drive d)
{
    if (!json_is_object(n.json)) return read_constant(n, s, &d) || add_pull(n, s, d);
    int which = json_node_choice(n, "amplitude table");
    if (which < 0 || json_node_only(n, which ? "table mean" : "amplitude frequency phase mean") ||
        read_signal(n, &s->pulls, which ? DRIVE_TABLE : DRIVE_SINE, &d) || add_pull(n, s, d))
        return 1;
    jnode mean = json_node_key(&n, "mean");
    return mean.json && (read_constant(mean, s, &d) || add_pull(mean, s, d));
}

static int read_force(jnode o, struct scene *s)
{
    struct drive d = { .from = -INFINITY, .until = INFINITY, .axis = v3(0, 0, 1) };
    jnode bodies = json_node_key(&o, "bodies");
    size_t n = 0;
    int which = json_node_choice(o, "force torque");
    if (which < 0) return 1;
    d.turns = which == 1;
    if (json_node_only(o, !d.turns      ? "bodies force along from until"
                          : s->dim == 2 ? "bodies torque from until"
                                        : "bodies torque about from until") ||
        json_node_need(&o, !d.turns      ? "bodies along"
                           : s->dim == 2 ? "bodies"
                                         : "bodies about") ||
        scene_read_direction(json_node_key(&o, d.turns ? "about" : "along"), s->dim, &d.axis) ||
        json_node_number(json_node_key(&o, "from"), J_ANY, &d.from) ||
        json_node_number(json_node_key(&o, "until"), J_ANY, &d.until) ||
        json_node_array(bodies, &n))
        return 1;
    if (!(d.from <= d.until))
        return json_node_fault(json_node_key(&o, "until"), "must not lie before its beginning");
    for (size_t i = 0; i < n; i++) {
        int64_t id = 0;
        if (json_node_integer(json_node_item(&bodies, i), 0, INT32_MAX - 1, &id)) return 1;
        d.boundary = (int32_t)id;
        if (read_pull(json_node_key(&o, d.turns ? "torque" : "force"), s, d)) return 1;
    }
    return 0;
}

int scene_read_forces(jnode a, struct scene *s)
{
    size_t n = 0;
    if (json_node_array(a, &n)) return 1;
    for (size_t i = 0; i < n; i++)
        if (read_force(json_node_item(&a, i), s)) return 1;
    return 0;
}
