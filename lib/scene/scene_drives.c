/* scene/scene_drives.c: the motions of a wall, and loads in time, from their JSON. */
#include "scene/scene_read.h"

#include <stdlib.h>

/* What moves, or pushes */
struct signal {
    struct drive d;
    struct drives *list; /* that it goes to, and its table */
    double mean;
    bool since_from;
};

/* Room for `more` in an array of n; NULL is told. */
static void *scene_drives_grown(jnode at, void *array, int32_t n, size_t more, size_t size)
{
    void *new = realloc(array, ((size_t)n + more + 1) * size);
    if (!new) failure_set(at.in->failure, EX_SOFTWARE, "no memory for the drives");
    return new;
}

/* [[t, s], ...], t rising */
static int scene_drives_read_table(jnode a, struct scene *s, void *out)
{
    struct signal *of = out;
    struct drives *list = of->list;
    struct drive *d = &of->d;
    size_t rows = 0;
    (void)s;
    if (json_node_array(a, &rows)) return 1;
    if (!rows || rows > 1 << 24) return json_node_fault(a, "needs [[time, value], ...]");
    struct drive_row *row = scene_drives_grown(a, list->row, list->rows, rows, sizeof *row);
    if (!row) return 1;
    list->row = row, row += list->rows;
    d->first = list->rows, d->rows = (int32_t)rows;
    if (keys_read_rows(a, &row->t)) return 1;
    list->rows += d->rows;
    return 0;
}

static int add_signal(jnode o, struct drives *list, struct drive d)
{
    struct drive *more = scene_drives_grown(o, list->drive, list->n, 1, sizeof *more);
    if (!more) return 1;
    list->drive = more, more[list->n++] = d;
    return 0;
}

int scene_check_span(jnode o, double from, double until)
{
    return from <= until
               ? 0
               : json_node_fault(json_node_key(&o, "until"), "must not lie before its beginning");
}

#define AT(member) offsetof(struct signal, member)

static const struct key_type key_rows = { "array of pairs", "{'$ref': 'rows'}", NULL, NULL };

#define AMPLITUDE(choice_, unit)                                                                   \
    "amplitude", &key_number, AT(d.value), unit, "-", "1e-3",                                      \
        "Amplitude of amplitude sin(2 pi frequency t + phase).", .choice = (choice_)
#define FREQUENCY                                                                                  \
    "frequency", &key_not_negative, AT(d.frequency), "Hz", REQUIRED, "20", "Frequency of a sine.", \
        .with = "amplitude"
#define PHASE                                                                                      \
    "phase", &key_number, AT(d.phase), "rad", "0", "1.57", "Phase of a sine.", .with = "amplitude"
#define TABLE(choice_)                                                                             \
    "table", &key_rows, 0, "s", "-", "[[0, 0], [1, 0.1]]",                                         \
        "[t, value], linear between the rows and constant before and after.",                      \
        .choice = (choice_), .read = scene_drives_read_table

/* ---- the motion of a wall ---- */

static const struct key drive_key[] = {
    { "along", &key_direction, AT(d.axis), "-", "-", "[0, 0, 1]",
      "Direction of a translation; displacement in m.", .choice = 1 },
    { "about", &key_vector, AT(d.point), "m", "-", "[0, 0]",
      "Point of the axis of a rotation; displacement in rad.", .choice = 1 },
    { "axis", &key_direction, AT(d.axis), "-", REQUIRED, "[0, 1, 0]",
      "Direction of the axis; not in 2D.", .with = "about", .dim = 3 },
    { "speed", &key_number, AT(d.value), "m/s, rad/s", "-", "1.5",
      "Displacement speed (t - from); from is 0 by default.", .choice = 2 },
    { AMPLITUDE(2, "m, rad") },
    { FREQUENCY },
    { PHASE },
    { TABLE(2) },
    { "from", &key_number, AT(d.from), "s", "-infinity", "0.3",
      "Start of the drive; before it the displacement has its value of this time." },
    { "until", &key_number, AT(d.until), "s", "infinity", "2",
      "End of the drive; after it the displacement keeps its value." },
    { "since_from", &key_bool, AT(since_from), "-", "false", "true",
      "Measure t of a sine or table from \"from\", which must be given: a sine without phase "
      "then begins with displacement 0.",
      .with = "amplitude table" },
    { 0 },
};

static int signal_of(jnode o)
{
    return keys_has(&o, "speed")       ? DRIVE_SPEED
           : keys_has(&o, "amplitude") ? DRIVE_SINE
                                       : DRIVE_TABLE;
}

static int finish_drive(jnode o, struct scene *s, void *out)
{
    struct signal *x = out;
    struct drive *d = &x->d;
    (void)s;
    d->turns = keys_has(&o, "about"), d->signal = signal_of(o);
    if (d->signal == DRIVE_SPEED && !keys_has(&o, "from")) d->from = 0;
    if (scene_check_span(o, d->from, d->until)) return 1;
    if (!x->since_from) return 0;
    // the drive's clock shows 0 at `from`, by which a sine without a phase begins where the wall is
    if (!keys_has(&o, "from")) return json_node_fault(json_node_key(&o, "from"), "is missing");
    d->clock = -d->from, d->until -= d->from, d->from = 0;
    return 0;
}

const struct keys scene_drive_keys = { "drive", drive_key, .finish = finish_drive };

static int scene_drives_read_drive(jnode o, struct scene *s, void *out)
{
    struct signal x = {
        .d = { .wall = s->walls, .axis = v3(0, 0, 1), .from = -INFINITY, .until = INFINITY },
        .list = &s->drives
    };
    (void)out;
    return keys_read(o, &scene_drive_keys, s, &x) || add_signal(o, &s->drives, x.d);
}

int scene_read_drives(jnode a, struct scene *s)
{
    return keys_each(a, s, NULL, scene_drives_read_drive);
}

/* ---- a load in time ---- */

static const struct key signal_key[] = {
    { AMPLITUDE(1, "N") },
    { FREQUENCY },
    { PHASE },
    { TABLE(1) },
    { "mean", &key_number, AT(mean), "N", "0", "5", "Is added." },
    { 0 },
};
static const struct keys signal_keys = { "signal", signal_key };

const struct key_type key_signal = { "number or signal",
                                     "{'anyOf': [{'type': 'number'}, {'$ref': 'signal'}]}",
                                     scene_read_later, NULL, &signal_keys };

static int read_signal(jnode o, struct scene *s, struct signal *x)
{
    x->d.signal = signal_of(o);
    return keys_read(o, &signal_keys, s, x);
}

int scene_read_push(jnode o, struct scene *s, int32_t wall, struct load *l)
{
    if (!json_is_object(o.json)) return json_node_number(o, J_ANY, &l->force);
    struct signal x = { .d = { .wall = wall,
                               .turns = l->way == LOAD_TURNS,
                               .axis = l->axis,
                               .from = -INFINITY,
                               .until = INFINITY },
                        .list = &s->pushes };
    if (read_signal(o, s, &x)) return 1;
    l->force = x.mean;
    return add_signal(o, &s->pushes, x.d);
}

/* ---- forces on bodies ---- */

enum { PULLS_MOST = 100000 };

/* Behind those of the bodies with as low an id */
static int add_pull(jnode o, struct scene *s, struct drive d)
{
    if (s->pulls.n >= PULLS_MOST) return json_node_fault(o, "more than %d forces", PULLS_MOST);
    if (add_signal(o, &s->pulls, d)) return 1;
    for (int32_t k = s->pulls.n - 1; k > 0 && s->pulls.drive[k - 1].wall > d.wall; k--)
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
    struct signal x = { .d = d, .list = &s->pulls };
    if (read_signal(n, s, &x) || add_pull(n, s, x.d)) return 1;
    jnode mean = json_node_key(&n, "mean");
    return mean.json && (read_constant(mean, s, &d) || add_pull(mean, s, d));
}

static const struct key_type key_bodies = { "array of integers", "{'$ref': 'body_ids'}", NULL,
                                            NULL };

static int each_body(jnode a, struct scene *s, void *out)
{
    int64_t id = 0;
    (void)s, (void)out;
    return json_node_integer(a, 0, INT32_MAX - 1, &id);
}

static int check_bodies(jnode a, struct scene *s, void *out)
{
    return keys_each(a, s, out, each_body);
}

#undef AT
#define AT(member) offsetof(struct drive, member)

static const struct key force_key[] = {
    { "bodies", &key_bodies, 0, "-", REQUIRED, "[0, 17]",
      "Ids of bodies that exist at the start (nsd-info -b).", .read = check_bodies },
    { "force", &key_signal, 0, "N", "-", "0.5",
      "Force on each of the bodies; signals as for the load of a wall.", .choice = 1 },
    { "along", &key_direction, AT(axis), "-", REQUIRED, "[0, 0, 1]", "Direction of the force.",
      .with = "force" },
    { "torque", &key_signal, 0, "N m", "-", "1e-4", "Torque on each of the bodies.", .choice = 1 },
    { "about", &key_direction, AT(axis), "-", REQUIRED, "[0, 0, 1]",
      "Direction of the axis of the torque, through the centre of mass; not in 2D.",
      .with = "torque", .dim = 3 },
    { FROM("Start; before it the force or torque is 0.") },
    { UNTIL("End; after it the force or torque is 0.") },
    { 0 },
};

static int finish_force(jnode o, struct scene *s, void *out)
{
    struct drive *d = out;
    jnode bodies = json_node_key(&o, "bodies");
    d->turns = keys_has(&o, "torque");
    if (scene_check_span(o, d->from, d->until)) return 1;
    for (size_t i = 0; i < json_array_size(bodies.json); i++) {
        d->wall = (int32_t)json_number_value(json_array_get(bodies.json, i));
        if (read_pull(json_node_key(&o, d->turns ? "torque" : "force"), s, *d)) return 1;
    }
    return 0;
}

const struct keys scene_force_keys = { "force", force_key, .finish = finish_force };

static int read_force(jnode o, struct scene *s, void *out)
{
    struct drive d = { .from = -INFINITY, .until = INFINITY, .axis = v3(0, 0, 1) };
    (void)out;
    return keys_read(o, &scene_force_keys, s, &d);
}

int scene_read_forces(jnode a, struct scene *s, void *out)
{
    return keys_each(a, s, out, read_force);
}
