/* run/read.c: what there is of a run, as arrays, numbers and JSON. */
#include "base/renamed.h"
#include "base/text.h"
#include "file/report_json.h"
#include "measure/branch.h"
#include "measure/measures.h"
#include "run/run.h"
#include "solve/err.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- arrays ---- */

/* What an array is of; those of bodies are the packing's own, those of acts the run's, others are made */
enum read_rows { OF_BODIES, OF_ACTS, OF_CONTACTS, OF_WALLS, OF_CELL };

struct read_row {
    const char *name, *unit;
    enum read_rows rows;
    char type;
    int width;
    size_t at; /* of bodies: the array in struct packing; of acts: in struct acts */
    void (*make)(const struct nsd_run *r, void *out);
};

static size_t read_size_of(char type)
{
    return type == 'd' ? sizeof(double) : type == 'i' ? sizeof(int32_t) : sizeof(int8_t);
}

static void read_put3(double *out, int64_t i, vec3 x)
{
    out[3 * i] = x.x, out[3 * i + 1] = x.y, out[3 * i + 2] = x.z;
}

static void contact_bodies(const struct nsd_run *r, void *out)
{
    int32_t *at = out;
    const struct packing *p = &r->f.packing;
    for (int64_t i = 0; i < r->f.contacts.n; i++) {
        const struct contact *c = &r->f.contacts.c[i];
        *at++ = c->a < 0 ? c->a : p->id[c->a], *at++ = p->id[c->b];
    }
}

#define OF_EACH_CONTACT(name, ...)                                                                 \
    static void name(const struct nsd_run *r, void *out)                                           \
    {                                                                                              \
        const struct contacts *s = &r->f.contacts;                                                 \
        for (int64_t i = 0; i < s->n; i++) {                                                       \
            __VA_ARGS__;                                                                           \
        }                                                                                          \
    }

OF_EACH_CONTACT(contact_points, read_put3(out, i, s->c[i].x))
OF_EACH_CONTACT(contact_normals, read_put3(out, i, s->c[i].n))
OF_EACH_CONTACT(contact_gaps, ((double *)out)[i] = s->c[i].gap)
OF_EACH_CONTACT(contact_frictions, ((double *)out)[i] = s->c[i].mu)
OF_EACH_CONTACT(contact_forces,
                read_put3(out, i, s->found ? branch_force(&r->f.packing, s, i) : v3(0, 0, 0)))
OF_EACH_CONTACT(contact_velocities,
                read_put3(out, i,
                          s->found ? contact_in_space(&s->c[i], s->found[i].u) : v3(0, 0, 0)))
OF_EACH_CONTACT(contact_statuses, ((int8_t *)out)[i] = s->found ? s->found[i].status : 0)

#define OF_EACH_WALL(name, ...)                                                                    \
    static void name(const struct nsd_run *r, void *out)                                           \
    {                                                                                              \
        const struct packing *p = &r->f.packing;                                                   \
        for (int32_t i = 0; i < p->walls; i++) {                                                   \
            const struct wall *w = &p->wall[i];                                                    \
            __VA_ARGS__;                                                                           \
        }                                                                                          \
    }

OF_EACH_WALL(wall_positions, read_put3(out, i, wall_at(p, w, p->t)))
OF_EACH_WALL(wall_normals, read_put3(out, i, wall_normal(p, w, p->t)))
OF_EACH_WALL(wall_velocities, read_put3(out, i, wall_velocity(p, w, wall_at(p, w, p->t))))
OF_EACH_WALL(wall_spins, read_put3(out, i, wall_spin(p, w)))

/* N: of the bodies on the walls; and N m, of that about where they are */
static void sum_walls(const struct nsd_run *r, double *out, bool torque)
{
    const struct packing *p = &r->f.packing;
    const struct contacts *s = &r->f.contacts;
    memset(out, 0, 3 * (size_t)p->walls * sizeof *out);
    for (int64_t i = 0; s->found && i < s->n; i++) {
        if (s->c[i].a >= 0) continue;
        int32_t w = -1 - s->c[i].a;
        vec3 on_b =
            torque ? branch_torque(p, s, i, wall_at(p, &p->wall[w], p->t)) : branch_force(p, s, i);
        read_put3(out, w, v3_sub(v3(out[3 * w], out[3 * w + 1], out[3 * w + 2]), on_b));
    }
}

static void wall_forces(const struct nsd_run *r, void *out)
{
    sum_walls(r, out, false);
}

static void wall_torques(const struct nsd_run *r, void *out)
{
    sum_walls(r, out, true);
}

static void cell_origin(const struct nsd_run *r, void *out)
{
    read_put3(out, 0, r->f.packing.cell.origin);
}

static void cell_edges(const struct nsd_run *r, void *out)
{
    for (int k = 0; k < 3; k++) read_put3(out, k, r->f.packing.cell.edge[k]);
}

static void cell_rates(const struct nsd_run *r, void *out)
{
    for (int k = 0; k < 3; k++) read_put3(out, k, r->f.packing.cell.rate[k]);
}

static void cell_repeated(const struct nsd_run *r, void *out)
{
    for (int k = 0; k < 3; k++) ((int8_t *)out)[k] = r->f.packing.cell.repeats[k];
}

#define ACT(designator) OF_ACTS, 'd', 3, offsetof(struct control, designator), NULL

/* Before these come the columns of bodies [state/body_columns.h]. */
static const struct read_row table[] = {
    { "force", "N", ACT(force[CONTROL_LASTING]) },
    { "torque", "N m", ACT(torque[CONTROL_LASTING]) },
    { "force_once", "N", ACT(force[CONTROL_ONCE]) },
    { "torque_once", "N m", ACT(torque[CONTROL_ONCE]) },
    { "contact_body", "1", OF_CONTACTS, 'i', 2, 0, contact_bodies },
    { "contact_point", "m", OF_CONTACTS, 'd', 3, 0, contact_points },
    { "contact_normal", "1", OF_CONTACTS, 'd', 3, 0, contact_normals },
    { "contact_gap", "m", OF_CONTACTS, 'd', 1, 0, contact_gaps },
    { "contact_friction", "1", OF_CONTACTS, 'd', 1, 0, contact_frictions },
    { "contact_force", "N", OF_CONTACTS, 'd', 3, 0, contact_forces },
    { "contact_velocity", "m s-1", OF_CONTACTS, 'd', 3, 0, contact_velocities },
    { "contact_status", "1", OF_CONTACTS, 'b', 1, 0, contact_statuses },
    { "wall_position", "m", OF_WALLS, 'd', 3, 0, wall_positions },
    { "wall_normal", "1", OF_WALLS, 'd', 3, 0, wall_normals },
    { "wall_velocity", "m s-1", OF_WALLS, 'd', 3, 0, wall_velocities },
    { "wall_angular_velocity", "rad s-1", OF_WALLS, 'd', 3, 0, wall_spins },
    { "wall_force", "N", OF_WALLS, 'd', 3, 0, wall_forces },
    { "wall_torque", "N m", OF_WALLS, 'd', 3, 0, wall_torques },
    { "cell_origin", "m", OF_CELL, 'd', 1, 0, cell_origin },
    { "cell_edges", "m", OF_CELL, 'd', 3, 0, cell_edges },
    { "cell_rates", "m s-1", OF_CELL, 'd', 3, 0, cell_rates },
    { "cell_periodic", "1", OF_CELL, 'b', 1, 0, cell_repeated },
};
enum { ROWS = sizeof table / sizeof table[0], FIRST_MADE = 4 };
_Static_assert(ROWS - FIRST_MADE <= MADE_MOST, "there is a place for each array that is made");

const char *nsd_array_name(int k)
{
    if (k < 0 || k >= BODY_COLUMNS + ROWS) return NULL;
    return k < BODY_COLUMNS ? field_key(&body_columns[k]) : table[k - BODY_COLUMNS].name;
}

/* The row of the table that a column of bodies would have */
static struct read_row column_as_row(int k)
{
    const struct field *b = &body_columns[k];
    const char type = b->type == COLUMN_F64 ? 'd' : b->type == COLUMN_I8 ? 'b' : 'i';
    return (struct read_row){ field_key(b), b->units, OF_BODIES, type, b->width, b->offset, NULL };
}

/* The array, made anew in place of what it was */
static void *read_make(struct nsd_run *r, int k, int64_t n, struct failure *failure)
{
    const struct read_row *t = &table[k];
    void *data = calloc((size_t)n * (size_t)t->width + 1, read_size_of(t->type));
    if (!data) return failure_set(failure, NSD_SOFTWARE, "%s: no memory", t->name), NULL;
    if (n) t->make(r, data);
    free(r->made[k - FIRST_MADE]);
    return r->made[k - FIRST_MADE] = data;
}

static void *data_of(struct nsd_run *r, const struct read_row *t, int64_t n,
                     struct failure *failure)
{
    const char *owner = t->rows == OF_BODIES ? (char *)&r->f.packing : (char *)&r->driver.acts;
    void *data;
    if (t->make) return read_make(r, (int)(t - table), n, failure);
    if (t->rows == OF_ACTS) {
        const bool torque = t->at >= offsetof(struct control, torque);
        const int term = (int)((t->at - (torque ? offsetof(struct control, torque)
                                                : offsetof(struct control, force))) /
                               sizeof(vec3 *));
        if (control_arrays(&r->driver.acts, &r->f.packing, failure)) return NULL;
        (torque ? r->driver.acts.twists : r->driver.acts.pushes)[term] =
            true; // what is written there acts
    }
    memcpy(&data, owner + t->at, sizeof data);
    if (!data) failure_set(failure, NSD_USAGE, "no body of the run has '%s'", t->name);
    return data;
}

int nsd_read(struct nsd_run *r, const char *name, struct nsd_array *out)
{
    struct failure *failure = run_why(r);
    int k = 0;
    if (!failure) return NSD_USAGE;
    if (!out || out->size < sizeof *out)
        return failure_set(failure, NSD_USAGE, "an array's size is not that of struct nsd_array");
    while (nsd_array_name(k) && (!name || strcmp(nsd_array_name(k), name) != 0)) k++;
    const struct renamed *was = name ? renamed_find("nsd_read", name, strlen(name)) : NULL;
    if (!nsd_array_name(k) && was)
        return failure_set(failure, NSD_USAGE, "array '%s': now called %s", was->was, was->is);
    if (!nsd_array_name(k))
        return failure_set(failure, NSD_USAGE, "there is no array '%.60s'", name ? name : "");
    const struct read_row of_bodies = column_as_row(k < BODY_COLUMNS ? k : 0);
    const struct read_row *t = k < BODY_COLUMNS ? &of_bodies : &table[k - BODY_COLUMNS];
    int64_t n = t->rows == OF_CONTACTS ? r->f.contacts.n
                : t->rows == OF_WALLS  ? r->f.packing.walls
                : t->rows == OF_CELL   ? (cell_repeats(&r->f.packing.cell) ? 3 : 0)
                                       : r->f.packing.n;
    void *data = data_of(r, t, n, failure);
    if (!data) return failure->status;
    const int64_t size = (int64_t)read_size_of(t->type);
    *out = (struct nsd_array){ .size = out->size,
                               .data = data,
                               .unit = t->unit,
                               .shape = { n, t->width },
                               .stride = { size * t->width, size },
                               .rank = t->width > 1 ? 2 : 1,
                               .type = t->type,
                               .writable = t->rows == OF_ACTS };
    return 0;
}

/* ---- numbers ---- */

static double read_number(const struct nsd_run *r, const char *name, bool *known)
{
    const struct packing *p = &r->f.packing;
    const struct report *rep = &r->f.report;
    const struct {
        const char *name;
        double x;
        bool solved; /* it is of the last solve */
    } numbers[] = {
        { "step", (double)p->step, false },
        { "time", p->t, false },
        { "dt", p->dt, false },
        { "dim", p->dim, false },
        { "bodies", (double)p->n, false },
        { "walls", p->walls, false },
        { "contacts", (double)r->f.contacts.n, false },
        { "sweeps", rep->sweeps, true },
        { "small_steps", (double)rep->small, true },
        { "converged", rep->converged, true },
        { "error", err_of(&rep->err, rep->criterion), true },
        { "natural", rep->err.natural, true },
        { "max_overlap", rep->err.max_overlap, true },
        { "max_penetration", rep->err.max_penetration_true, true },
        { "kinetic_energy", rep->balance.kinetic, true },
        { "seconds", rep->seconds, true },
    };
    *known = true;
    for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++)
        if (!strcmp(numbers[k].name, name))
            return numbers[k].solved && !r->f.reported ? NAN : numbers[k].x;
    *known = false;
    return NAN;
}

int nsd_number(struct nsd_run *r, const char *name, double *x)
{
    struct failure *failure = run_why(r);
    bool known = false;
    if (!failure) return NSD_USAGE;
    if (!name || !x) return failure_set(failure, NSD_USAGE, "a number has a name and a place");
    double found = read_number(r, name, &known);
    if (!known) return failure_set(failure, NSD_USAGE, "there is no number '%.60s'", name);
    *x = found;
    return 0;
}

/* ---- JSON ---- */

static int read_no_memory(struct failure *failure)
{
    return failure_set(failure, NSD_SOFTWARE, "no memory for JSON, or a name in it is not UTF-8");
}

int nsd_report(struct nsd_run *r, const char **json)
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    if (!json) return failure_set(failure, NSD_USAGE, "there is no place for JSON");
    if (!r->f.reported)
        return failure_set(failure, NSD_USAGE, "no step was made, and nothing was solved");
    json_t *j = json_report(&r->f.report);
    json_object_set_new(j, "account", json_account(&r->f.account, &r->f.packing.names));
    char *text = json_text(j);
    json_decref(j);
    if (!text) return read_no_memory(failure);
    free(r->text);
    *json = r->text = text;
    return 0;
}

int nsd_failure(struct nsd_run *r, const char **text)
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    if (!text) return failure_set(failure, NSD_USAGE, "there is no place for the text");
    const size_t room = 200 * ACCOUNT_ROWS;
    char *all = calloc(room, 1);
    if (!all) return failure_set(failure, NSD_SOFTWARE, "no memory for a text");
    for (int k = 0; k < ACCOUNT_ROWS; k++) {
        const enum account_row row = (enum account_row)k;
        if (!account_row_fails(&r->account, row)) continue;
        const size_t n = strlen(all), mark = n ? 2 : 0;
        memcpy(all + n, ", ", mark);
        account_says(&r->account, row, &r->f.packing.names, all + n + mark, room - n - mark);
    }
    free(r->text);
    *text = r->text = all;
    return 0;
}

/* Adds the name, or null */
static bool read_put_name(json_t *list, const char *name)
{
    return !json_array_append_new(list, name ? json_string(name) : json_null());
}

/* The walls that have each name, or a part that has it, in order; rows are sorted by name and wall. */
static bool put_named(json_t *to, const struct names *names)
{
    bool good = true;
    for (int32_t k = 0; good && k < names->rows; k++) {
        const struct named *row = &names->row[k], *before = k ? row - 1 : NULL;
        const char *name = names->text[row->name];
        if (before && before->name == row->name && before->wall == row->wall) continue;
        json_t *walls = json_object_get(to, name);
        if (!walls) {
            good = !json_object_set_new(to, name, json_array());
            walls = json_object_get(to, name);
        }
        good = good && !json_array_append_new(walls, json_integer(row->wall));
    }
    return good;
}

static bool put_groups(json_t *to, const struct packing *p)
{
    bool used[NAMES_MOST] = { false }, good = true;
    for (int64_t i = 0; p->group && i < p->n; i++)
        if (p->group[i]) used[p->group[i] - 1] = true;
    for (int32_t k = 0; good && k < p->names.n; k++)
        if (used[k]) good = read_put_name(to, p->names.text[k]);
    return good;
}

/* NULL: no memory */
static json_t *names_of(const struct packing *p)
{
    json_t *materials = json_array(), *shapes = json_array(), *walls = json_array(),
           *groups = json_array(), *named = json_object();
    bool good = materials && shapes && walls && groups && named;
    for (int32_t k = 0; good && k < p->materials; k++)
        good = read_put_name(materials, p->material_name[k]);
    for (int32_t k = 0; good && k < p->shapes.n; k++)
        good = read_put_name(shapes, p->shapes.s[k].name);
    for (int32_t w = 0; good && w < p->walls; w++)
        good = read_put_name(walls, names_of_wall(&p->names, w));
    good = good && put_groups(groups, p) && put_named(named, &p->names);
    json_t *all = json_pack("{s:o*, s:o*, s:o*, s:o*, s:o*}", "materials", materials, "shapes",
                            shapes, "walls", walls, "groups", groups, "named", named);
    if (good) return all;
    json_decref(all);
    return NULL;
}

int nsd_names(struct nsd_run *r, const char **json)
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    if (!json) return failure_set(failure, NSD_USAGE, "there is no place for JSON");
    json_t *j = names_of(&r->f.packing);
    char *text = json_text(j);
    json_decref(j);
    if (!text) return read_no_memory(failure);
    free(r->text);
    *json = r->text = text;
    return 0;
}

int nsd_measure(struct nsd_run *r, const char *names, const char **json)
{
    struct failure *failure = run_why(r);
    const struct measure *chosen[MOST_MEASURES + 1];
    struct table t[MOST_MEASURES];
    struct snapshot s;
    struct text written;
    char *text = NULL;
    size_t size = 0;
    if (!failure) return NSD_USAGE;
    if (!names || !json)
        return failure_set(failure, NSD_USAGE, "a measure has a name, and JSON a place");
    const struct frame *f = &r->f;
    if (measured_choose(chosen, names, failure)) {
        memmove(failure->text, failure->text + 2, strlen(failure->text + 2) + 1);
        return failure->status;
    }
    if (r->asked.boxed && f->packing.dim == 3 && !isfinite(r->asked.lo[2]))
        return failure_set(failure, NSD_USAGE,
                           "box: it has four numbers, and the bodies are balls");
    snapshot_init(&s, &f->packing, f->detected ? &f->contacts : NULL, f->moved, &r->asked, failure);
    if (r->remembers) s.first = &r->first, s.before = &r->before;
    const double missed = r->account.worst[ACCOUNT_UNCONVERGED].value;
    s.unconverged = missed - r->measured, s.report = f->reported ? &f->report : NULL;
    if (!measured_run(t, chosen, &s, failure)) {
        FILE *out = text_open(&written);
        if (out) measured_json(out, &s, chosen, t);
        if (!(text = text_close(&written, out, &size))) read_no_memory(failure);
    }
    if (failure->status && !strncmp(failure->text, "--", 2))
        memmove(failure->text, failure->text + 2, strlen(failure->text + 2) + 1);
    measured_free(t);
    // what measures of ways look back to: the first moment that was measured, and the last
    if (!failure->status && measured_remember(chosen) &&
        !measured_keep(chosen, &s, &r->first, &r->before, failure))
        r->remembers = true;
    snapshot_free(&s);
    if (failure->status) return free(text), failure->status;
    r->measured = missed;
    free(r->text);
    *json = r->text = text;
    return 0;
}
