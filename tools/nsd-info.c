/* nsd-info: shows any part of a document as JSON lines, for jq and gnuplot. */
#include "base/renamed.h"
#include "file/reader.h"
#include "file/report_json.h"
#include "measure/stress.h"
#include "run/cli.h"
#include "state/face_of.h"
#include "state/fields.h"
#include "state/kinematics.h"
#include "state/rotation.h"
#include "state/selection.h"
#include "state/servo_box.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool last, bodies, particles, contacts, walls, history, events, scene;
static const char *steps, *only;
static struct selection chosen; /* of the frame at hand, by --only */
static bool shown;              /* whether any frame had what was asked for: contacts, a history */

static const struct cli_option own[] = {
    { CLI_FLAG, 'b', "bodies", &bodies, .help = "print one line per body" },
    { CLI_FLAG, 'p', "particles", &particles,
      .help = "print it with the former keys x, v, w, q, which scripts read" },
    { CLI_FLAG, 'c', "contacts", &contacts, .help = "print one line per contact" },
    { CLI_FLAG, 'w', "walls", &walls, .help = "print one line per wall" },
    { CLI_FLAG, 0, "history", &history,
      .help = "print one line per sweep, of nsd-solve --history" },
    { CLI_FLAG, 0, "events", &events, .help = "print one line per body that was added or removed" },
    { CLI_FLAG, 0, "scene", &scene,
      .help = "print the scene that restarts from the last frame of FILE" },
    { CLI_TEXT, 0, "only", &only, "NAME,...",
      .help = "print only these walls, parts, groups, materials (-b, -w, -c) [all]" },
    { CLI_FLAG, 'l', "last", &last, .help = "process only the last frame" },
    { CLI_TEXT, 's', "frames", &steps, "A:B:K",
      .help = "process the frames of steps A to B, every K-th [all]" },
    { 0 },
};
static const struct cli_option *const tables[] = { own, NULL };

const struct cli_tool tool = {
    "nsd-info", "[FILE ...]",
    "Prints the contents of documents: one line of JSON per document, then one per frame.", tables,
    "  nsd-info out.h5 | jq -r 'select(.step != null) | [.step, .sweeps, .natural] | @tsv'\n"
    "  nsd-info --last -b out.h5 | jq -r '[.position[], .radius] | @tsv'\n"
};

/* What pairs of materials do beyond friction and restitution */
static void add_law(json_t *j, const struct pair_law *l)
{
    for (const struct law_name *law = law_names; law->name; law++) {
        const size_t length = strlen(law->name);
        if (!law->is_of(l)) continue;
        json_t *of = json_object();
        for (const struct field *f = law_fields; f->name; f++) {
            double x = *(const double *)(const void *)((const char *)l + f->offset);
            bool named = f->key && !strncmp(f->key, law->name, length) && f->key[length] == '.';
            if (!named || (x == 0 && (f->traits & FIELD_OPTIONAL || f->range == FIELD_FLAG)) ||
                (f->range == FIELD_FINITE &&
                 l->forever > 0)) // bonds are made at a time, or for ever
                continue;
            json_object_set_new(of, f->key + length + 1,
                                f->range == FIELD_FLAG ? json_true() : json_real(x));
        }
        json_object_set_new(j, law->name, of);
    }
}

static json_t *material(const struct packing *p)
{
    json_t *list = json_array();
    for (int32_t a = 0; a < p->materials; a++)
        for (int32_t b = a; b < p->materials; b++) {
            int32_t k = a * p->materials + b;
            json_t *j = json_pack("{s:[s,s]}", "pair", p->material_name[a], p->material_name[b]);
#define NUMBER(member, name, unit, key, ...) json_object_set_new(j, key, json_real(p->member[k]));
            EACH_PAIR_COLUMN(NUMBER)
            if (p->mu_s[k] > 0) {
                STATIC_FRICTION_COLUMNS(NUMBER)
            }
#undef NUMBER
            if (p->law) add_law(j, &p->law[k]);
            json_array_append_new(list, j);
        }
    return list;
}

/* The commands that made the document; each line of its history is JSON already. */
static json_t *commands(const char *text)
{
    json_t *list = json_array();
    for (const char *s = text; s && *s;) {
        size_t n = strcspn(s, "\n");
        json_t *line = json_loadb(s, n, 0, NULL);
        json_array_append_new(list, line ? line : json_null());
        s += n + (s[n] == '\n');
    }
    return list;
}

/* The options of the solve, which documents keep by their names of version 1 */
static json_t *solve_options(const char *text)
{
    json_t *kept = json_loads(text, 0, NULL), *options = json_object(), *value;
    const char *key;
    json_object_foreach(kept, key, value)
    {
        const struct renamed *r = renamed_find("document", key, strlen(key));
        json_object_set(options, r ? r->is : key, value);
    }
    json_decref(kept);
    return options;
}

static void show_document(const struct frame *f, int64_t frames)
{
    json_t *j = json_object();
    json_object_set_new(j, "type", json_string(f->foreign ? "problem" : "packing"));
    json_object_set_new(j, "frames", json_integer(frames));
    if (f->foreign) {
        const struct delassus *W = &f->problem.W;
        json_object_set_new(j, "form", json_string(f->problem.global ? "global" : "local"));
        json_object_set_new(j, "dim", json_integer(W->d));
        json_object_set_new(j, "contacts", json_integer(W->n));
        json_object_set_new(j, "blocks", json_integer(W->first[W->n] + W->n));
    } else {
        const struct packing *p = &f->packing;
        json_object_set_new(j, "dim", json_integer(p->dim));
        json_object_set_new(j, "bodies", json_integer(p->n));
        json_object_set_new(j, "walls", json_integer(p->walls));
        json_object_set_new(j, "dt", json_number(p->dt));
        json_object_set_new(j, "theta", json_number(p->theta));
        if (p->overlap)
            json_object_set_new(j, "overlap_rule", json_string(overlap_name[p->overlap]));
        json_object_set_new(j, "gravity", json_vec(p->g));
        json_object_set_new(j, "seed", json_integer((json_int_t)p->seed));
        json_object_set_new(j, "material", material(p));
    }
    if (f->report.options) json_object_set_new(j, "options", solve_options(f->report.options));
    json_object_set_new(j, "history", commands(f->history));
    json_line(j);
}

/* How many bodies pours have brought, or removals have taken, so far, and their mass */
static void show_passages(json_t *j, const char *name, int32_t n, const struct flow_count *passed)
{
    json_t *list = json_array();
    for (int32_t k = 0; k < n; k++)
        json_array_append_new(list, json_pack("{s:I, s:o}", "bodies", (json_int_t)passed[k].bodies,
                                              "mass", json_number(passed[k].mass)));
    if (n) json_object_set(j, name, list);
    json_decref(list);
}

static json_t *three(const vec3 e[3])
{
    json_t *list = json_array();
    for (int k = 0; k < 3; k++) json_array_append_new(list, json_vec(e[k]));
    return list;
}

/* Pa, in the plane N/m: that of the contacts, as nsd-stat has it [measure/stress.h] */
static json_t *stress(const struct frame *f)
{
    static const struct asked all = { .axis = -1 };
    struct snapshot s;
    struct failure failure = { 0 };
    vec3 row[3];
    snapshot_init(&s, &f->packing, &f->contacts, f->moved, &all, &failure);
    struct tensor T = stress_contacts(&s, &s.whole);
    tensor_scale(&T, 1 / s.whole.volume);
    for (int k = 0; k < 3; k++) row[k] = v3(T.x[k][0], T.x[k][1], T.x[k][2]);
    return three(row);
}

static void show_moment(const struct frame *f)
{
    if (f->foreign && !f->reported) return;
    json_t *j = json_object();
    if (f->packed) {
        const struct packing *p = &f->packing;
        const struct energy e = energy_of(p);
        json_object_set_new(j, "step", json_integer(p->step));
        json_object_set_new(j, "time", json_number(p->t));
        json_object_set_new(j, "bodies", json_integer(p->n));
        json_object_set_new(j, "contacts", f->detected ? json_integer(f->contacts.n) : json_null());
        json_object_set_new(j, "kinetic_energy", json_number(e.kinetic));
        json_object_set_new(j, "potential_energy", json_number(e.potential));
        json_object_set_new(j, "max_speed", json_number(e.fastest));
        show_passages(j, "poured", p->pours, p->poured);
        show_passages(j, "removed", p->removals, p->removed);
    }
    if (f->packed && cell_repeats(&f->packing.cell)) {
        json_object_set_new(j, "edges", three(f->packing.cell.edge));
        json_object_set_new(j, "rates", three(f->packing.cell.rate));
        if (f->detected && f->contacts.found) json_object_set_new(j, "stress", stress(f));
    }
    if (f->reported) {
        json_t *r = json_report(&f->report);
        json_object_del(r, "step"), json_object_del(r, "time"); // the packing's own are there
        json_object_update(j, r);
        json_decref(r);
    }
    if (f->account.steps)
        json_object_set_new(j, "account", json_account(&f->account, &f->packing.names));
    json_line(j);
}

static void show_bodies(const struct packing *p)
{
#define MEMBER(ctype, member, ...) #member,
    static const char *const former[] = { EACH_BODY_COLUMN(MEMBER) };
#undef MEMBER
    const unsigned apart =
        1 << BODY_inertia | 1 << BODY_id | 1 << BODY_material | 1 << BODY_shape | 1 << BODY_group;
    for (int64_t i = 0; i < p->n; i++) {
        if (!selection_body(&chosen, p, i)) continue;
        json_t *j = json_object();
        json_object_set_new(j, "step", json_integer(p->step));
        json_object_set_new(j, "id", json_integer(p->id[i]));
        json_object_set_new(j, "material", json_string(p->material_name[p->material[i]]));
        if (p->group && p->group[i])
            json_object_set_new(j, "group", json_string(p->names.text[p->group[i] - 1]));
        if (p->shape) json_object_set_new(j, "shape", json_string(p->shapes.s[p->shape[i]].name));
        for (int k = 0; k < BODY_COLUMNS; k++)
            if (!(apart >> k & 1) && field_array(&body_columns[k], p))
                json_object_set_new(
                    j, particles ? former[k] : body_columns[k].name,
                    json_field(&body_columns[k], field_row(&body_columns[k], p, i)));
        json_line(j);
    }
}

static void show_events(const struct packing *p)
{
    for (int64_t i = 0; i < p->events.n; i++) {
        const struct event *e = &p->events.e[i];
        json_t *j = json_object();
        json_object_set_new(j, "step", json_integer(e->step));
        json_object_set_new(j, "time", json_number(e->t));
        json_object_set_new(j, "event", json_string(e->came ? "poured" : "removed"));
        json_object_set_new(j, "by", json_integer(e->which));
        json_object_set_new(j, "id", json_integer(e->id));
        json_object_set_new(j, "radius", json_number(e->radius));
        json_object_set_new(j, "mass", json_number(e->mass));
        json_object_set_new(j, "position", json_vec(e->x));
        json_object_set_new(j, "velocity", json_vec(e->v));
        json_line(j);
    }
}

/* The force is what acts in the step that begins where the packing is, tables and sines too. */
static json_t *load(const struct packing *p, const struct wall *w)
{
    const struct load *l = &w->load;
    json_t *j = json_object();
    bool turns = l->way == LOAD_TURNS, room = servo_box_has(w);
    if (room) json_object_set_new(j, "center", json_vec(l->point));
    if (room) json_object_set_new(j, "lever", json_number(wall_lever(p, w, p->t)));
    json_object_set_new(j, turns ? "about" : "along", json_vec(l->axis));
    if (turns) json_object_set_new(j, "point", json_vec(l->point));
    json_object_set_new(j, "mass", json_number(l->mass));
    json_object_set_new(j, turns ? "torque" : "force",
                        json_number(wall_force(p, w, p->t + p->dt / 2)));
    if (l->spread || room) json_object_set_new(j, "face", json_number(wall_face(p, w, p->t)));
    if (room) json_object_set_new(j, "strain_rate", json_number(l->rate));
    json_object_set_new(j, room ? "growth" : "speed", json_number(l->speed));
    json_object_set_new(j, "travel", json_number(l->travel));
    return j;
}

/* m: as nsd-format(5) has them */
static json_t *sizes(const struct wall *w)
{
    json_t *j = json_array();
    for (int k = 0; k < 3; k++) json_array_append_new(j, json_number(w->size[k]));
    return j;
}

/* The parts of a surface that have names: { name: [[first, last], ...] } */
static json_t *parts(const struct packing *p, int32_t wall)
{
    json_t *j = json_object();
    for (int32_t k = 0; k < p->names.rows; k++) {
        const struct named *r = &p->names.row[k];
        const char *name = p->names.text[r->name];
        if (r->wall != wall || !r->count) continue;
        if (!json_object_get(j, name)) json_object_set_new(j, name, json_array());
        json_array_append_new(json_object_get(j, name),
                              json_pack("[i,i]", r->first, r->first + r->count - 1));
    }
    return j;
}

static void show_walls(const struct packing *p)
{
    for (int32_t i = 0; i < p->walls; i++) {
        const struct wall *w = &p->wall[i];
        const char *name = names_of_wall(&p->names, i);
        if (!selection_wall(&chosen, p, i)) continue;
        json_t *j = json_object();
        json_object_set_new(j, "step", json_integer(p->step));
        json_object_set_new(j, "wall", json_integer(i));
        if (name) json_object_set_new(j, "name", json_string(name));
        json_object_set_new(j, "material", json_string(p->material_name[w->material]));
        vec3 x = wall_at(p, w, p->t), spin = wall_spin(p, w);
        json_object_set_new(j, "shape", json_string(wall_shape_name[w->shape]));
        json_object_set_new(j, "point", json_vec(x));
        json_object_set_new(j, "normal", json_vec(wall_normal(p, w, p->t)));
        json_object_set_new(j, "velocity", json_vec(wall_velocity(p, w, x)));
        if (v3_norm(w->belt) > 0) json_object_set_new(j, "belt", json_vec(w->belt));
        if (v3_norm(spin) > 0) json_object_set_new(j, "spin", json_vec(spin));
        if (w->shape != WALL_PLANE) json_object_set_new(j, "size", sizes(w));
        if (!wall_there(w, p->t)) json_object_set_new(j, "gone", json_true());
        if (w->load.way) json_object_set_new(j, "load", load(p, w));
        json_t *named = parts(p, i);
        if (json_object_size(named)) json_object_set(j, "parts", named);
        json_decref(named);
        json_line(j);
    }
}

/* What other laws do at a contact */
static void add_tie(json_t *j, const struct contact_law *t)
{
    json_object_set_new(j, "pull", json_number(t->pull));
    json_object_set_new(j, "beta", json_number(t->beta));
    json_object_set_new(j, "wet", json_boolean(t->state & CONTACT_LAW_WET));
    if (t->beta > 0) {
        json_object_set_new(j, "stiffness", json_numbers(t->stiff, 2));
        json_object_set_new(j, "jump", json_numbers(t->jump, 3));
    }
    if (t->spring[0] > 0) {
        json_object_set_new(j, "spring", json_numbers(t->spring, 2));
        json_object_set_new(j, "stretch", json_numbers(t->jump, 3));
        json_object_set_new(j, "meets", json_boolean(t->state & CONTACT_LAW_MEETS));
    }
    if (t->mu_r > 0 || t->mu_p > 0) {
        json_object_set_new(j, "mu_r", json_number(t->mu_r));
        json_object_set_new(j, "mu_p", json_number(t->mu_p));
        if (t->roll > 0) {
            json_object_set_new(j, "rolling_stiffness", json_number(t->roll));
            json_object_set_new(j, "turn", json_numbers(t->turn, 3));
        }
    }
}

static void show_contacts(const struct frame *f)
{
    static const char *const status[] = { "free", "stick", "slide", "jammed", "summed" };
    const struct packing *p = &f->packing;
    struct wall_faces faces;
    struct failure failure = { 0 };
    shown = true;
    if (face_of_init(&faces, p, p->names.rows > 0, &failure)) die_why(&failure);
    for (int64_t i = 0; i < f->contacts.n; i++) {
        const struct contact *c = &f->contacts.c[i];
        const char *name =
            c->a < 0 ? names_of_face(&p->names, -1 - c->a, face_of_contact(&faces, p, c, 0)) : NULL;
        if (only && !selection_contact(&chosen, p, &faces, c)) continue;
        json_t *j = json_object();
        json_object_set_new(j, "step", json_integer(f->packing.step));
        json_object_set_new(j, "body", json_pack("[i,i]", c->a, c->b));
        if (c->a < 0) json_object_set_new(j, "wall", json_integer(-1 - c->a));
        if (name) json_object_set_new(j, "name", json_string(name));
        if (cell_repeats(&f->packing.cell))
            json_object_set_new(j, "shift",
                                json_pack("[i,i,i]", c->shift[0], c->shift[1], c->shift[2]));
        json_object_set_new(j, "point", json_vec(c->x));
        json_object_set_new(j, "n", json_vec(c->n));
        json_object_set_new(j, "t1", json_vec(c->t1));
        json_object_set_new(j, "t2", json_vec(contact_t2(c)));
        json_object_set_new(j, "gap", json_number(c->gap));
#define NUMBER(member, name, unit, key, ...) json_object_set_new(j, key, json_number(c->member));
        EACH_PAIR_COLUMN(NUMBER)
#undef NUMBER
        if (f->contacts.law) add_tie(j, &f->contacts.law[i]);
        const struct found *found = f->contacts.found ? &f->contacts.found[i] : NULL;
        if (found) {
            json_object_set_new(j, "r", json_numbers(found->r, 3));
            json_object_set_new(j, "u", json_numbers(found->u, 3));
            if (f->contacts.moment)
                json_object_set_new(j, "moment", json_numbers(f->contacts.moment[i], 3));
            json_object_set_new(j, "status", json_string(status[found->status % 5]));
        }
        json_line(j);
    }
    wall_faces_free(&faces);
}

static void show_problem_contacts(const struct frame *f)
{
    shown = true;
    const struct delassus *W = &f->problem.W;
    for (int64_t c = 0; c < W->n; c++) {
        json_t *j = json_object();
        json_object_set_new(j, "contact", json_integer(c));
        json_object_set_new(j, "mu", json_number(W->mu[c]));
        json_object_set_new(j, "q", json_numbers(W->q + W->d * c, W->d));
        if (f->u) {
            json_object_set_new(j, "r", json_numbers(W->r + W->d * c, W->d));
            json_object_set_new(j, "u", json_numbers(f->u + W->d * c, W->d));
        }
        json_line(j);
    }
}

static void show_sweeps(const struct frame *f)
{
    shown = true;
    for (int32_t i = 0; i < f->report.sweeps; i++) {
        json_t *j = json_pack("{s:i}", "sweep", i + 1);
        json_terms(j, &f->report.history[i]);
        json_line(j);
    }
}

static void show(const struct frame *f)
{
    struct failure failure = { 0 };
    if (only && !f->packed) die(EX_DATAERR, "--only: a contact problem has no names");
    if (only && selection_init(&chosen, &f->packing, "--only", only, &failure)) die_why(&failure);
    if ((bodies || particles) && f->packed) show_bodies(&f->packing);
    if (events && f->packed) show_events(&f->packing);
    if (walls && f->packed) show_walls(&f->packing);
    if (contacts && f->foreign) show_problem_contacts(f);
    if (contacts && f->detected) show_contacts(f);
    if (history && f->report.history) show_sweeps(f);
    if (!bodies && !particles && !walls && !contacts && !history && !events) show_moment(f);
    selection_free(&chosen);
}

/* ---- --scene ---- */

/* A scene of the same parameters, of a packing that keeps none */
static json_t *scene_of_parameters(const struct packing *p)
{
    json_t *j = json_pack("{s:i, s:o, s:I}", "dim", p->dim, "dt", json_real(p->dt), "seed",
                          (json_int_t)p->seed);
    const double g[3] = { p->g.x, p->g.y, p->g.z };
    json_t *materials = json_object();
    for (int32_t k = 0; k < p->materials; k++)
        json_object_set_new(materials, p->material_name[k], json_object());
    json_object_set_new(j, "gravity", json_numbers(g, p->dim));
    json_object_set_new(j, "materials", materials);
    json_object_set_new(j, "pairs", material(p));
    return j;
}

/* How many walls this item of a scene's walls is: of a box, as many as it has sides */
static int32_t walls_of(const json_t *wall)
{
    const char *axis;
    json_t *side, *box = json_object_get(wall, "box");
    int32_t n = 0;
    if (!box) return 1;
    json_object_foreach(box, axis, side) n +=
        json_is_number(json_array_get(side, 0)) + json_is_number(json_array_get(side, 1));
    return n;
}

/* What yields to a load goes on from where it is, and as fast. */
static void set_loads(json_t *list, const struct packing *p)
{
    int32_t at = 0;
    for (size_t i = 0; i < json_array_size(list); i++) {
        json_t *wall = json_array_get(list, i), *load = json_object_get(wall, "load");
        if (load && at < p->walls) {
            json_object_set_new(load, "speed", json_real(p->wall[at].load.speed));
            json_object_set_new(load, "travel", json_real(p->wall[at].load.travel));
        }
        at += walls_of(wall);
    }
}

static void set_room(json_t *room, const struct packing *p)
{
    json_t *travel = json_array();
    for (int32_t w = 0; w < p->walls; w++)
        if (servo_box_has(&p->wall[w]))
            json_array_append_new(travel, json_real(p->wall[w].load.travel));
    if (room) json_object_set_new(room, "growth", json_real(servo_box_growth(p)));
    if (room) json_object_set(room, "travel", travel);
    json_decref(travel);
}

/* And so does a cell: its edges are taken from the document. */
static void set_cell(json_t *cell)
{
    json_object_del(cell, "lengths"), json_object_del(cell, "edges");
    json_object_del(cell, "affine");
}

/* Pours and removals go on, too: what they have done by now, and the beginning that was the scene's. */
static void set_passages(json_t *list, const char *key, const struct flow_count *done, int32_t n,
                         double began)
{
    for (int32_t k = 0; k < n && (size_t)k < json_array_size(list); k++) {
        json_t *item = json_array_get(list, (size_t)k), *from = json_object_get(item, "from");
        double at = json_is_number(from) ? json_number_value(from) : 0;
        if (!strcmp(key, "poured") && !json_object_get(item, key))
            json_object_set_new(item, "from", json_real(fmax(at, began)));
        json_object_set_new(
            item, key,
            json_pack("{s:I, s:f}", "bodies", (json_int_t)done[k].bodies, "mass", done[k].mass));
    }
}

/* The time of bonds is by default that of the scene, which is another now. */
static void set_made(json_t *of, double began)
{
    json_t *law = json_object_get(of, "adhesion");
    if (json_is_object(law) && !json_object_get(law, "made") &&
        !json_is_true(json_object_get(law, "forever")))
        json_object_set_new(law, "made", json_real(began));
}

static void set_times(json_t *j, const struct packing *p)
{
    const json_t *pairs = json_object_get(j, "pairs");
    double began = json_number_value(json_object_get(j, "time"));
    set_made(j, began);
    for (size_t k = 0; k < json_array_size(pairs); k++) set_made(json_array_get(pairs, k), began);
    set_passages(json_object_get(j, "pour"), "poured", p->poured, p->pours, began);
    set_passages(json_object_get(j, "remove"), "removed", p->removed, p->removals, began);
    json_object_set_new(j, "time", json_real(p->t));
}

/* The scene with the last frame's bodies, at its time */
static void show_scene(const struct packing *p, const char *path)
{
    json_t *j = p->scene ? json_loads(p->scene, 0, NULL) : scene_of_parameters(p);
    if (!json_is_object(j)) die(EX_DATAERR, "%s: /nsd/scene is no scene", path);
    json_object_set_new(j, "theta", json_real(p->theta));
    set_times(j, p);
    set_loads(json_object_get(j, "walls"), p);
    set_room(json_object_get(j, "room"), p); // its former name
    set_room(json_object_get(j, "servo"), p);
    if (cell_repeats(&p->cell)) set_cell(json_object_get(j, "cell"));
    json_object_set_new(j, "bodies", json_pack("[{s:s}]", "document", path));
    json_line(j);
}

int tool_main(int argc, char **argv)
{
    struct reader *in;
    struct frame f = { 0 };
    struct range range;
    struct failure failure = { 0 };
    bool more, part = bodies || particles || walls || contacts || history || events;
    int64_t frames = 0;
    if (!range_parse(&range, steps ? steps : ":")) die_usage("--frames: '%s' is not A:B:K", steps);
    if (last && steps) die_usage("--last and --frames exclude each other");
    if (only && (scene || (!bodies && !particles && !walls && !contacts)))
        die_usage("--only: needs -b, -w or -c");
    if (scene && (argc != 1 || !strcmp(argv[0], "-")))
        die_usage("--scene: one FILE, which the scene names");
    if (reader_open(&in, argc, argv, &failure)) die_why(&failure);
    begin_stdout();
    if (scene) last = true;
    if (last) {
        if (reader_last(in, &f, &more, &failure)) die_why(&failure);
        if (scene && (!more || !f.packed)) die(EX_DATAERR, "%s: no bodies", reader_where(in));
        if (scene)
            show_scene(&f.packing, argv[0]);
        else if (more)
            show(&f);
    }
    while (!last && !failure.status && !reader_document(in, &frames, &failure) && frames >= 0)
        for (int64_t k = 0; k < frames; k++) {
            bool wanted = reader_has(in, k, &range), first = k == 0 && !part;
            if (!wanted && !first) continue;
            if (reader_frame(in, k, &f, &failure)) break;
            if (first) show_document(&f, frames);
            if (wanted) show(&f);
        }
    if (failure.status) die_why(&failure);
    if (contacts && !shown) die(EX_DATAERR, "%s: no group /contacts", reader_where(in));
    if (history && !shown)
        die(EX_DATAERR, "%s: no history: nsd-solve --history keeps it", reader_where(in));
    frame_free(&f);
    reader_close(in);
    finish_stdout();
    return 0;
}
