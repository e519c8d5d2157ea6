#include "io/frame_write.h"

#include "bodies/freedom.h"
#include "io/flow_tables.h"
#include "io/h5.h"
#include "io/roster.h"
#include "io/stream.h"
#include "io/unknown.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Hard links WHERE/COLUMN/name to the dataset `from` for all columns */
static int link_clock(struct table_write *s, const char *from, const char *name, const char *where,
                      const struct column *c, struct why *why)
{
    char to[80];
    for (; c->name; c++) {
        snprintf(to, sizeof to, "%s/%s/%s", where, c->name, name);
        if (h5_has(s->file, to)) continue; // this is where it was written
        if (H5Lcreate_hard(s->file, from, s->file, to, H5P_DEFAULT, H5P_DEFAULT) < 0)
            return why_set(why, EX_IOERR, "%s: cannot be linked", to);
    }
    return 0;
}

/* Writes HOME/step (i64) or HOME/time (f64, s), and links it to all columns. */
static int write_clock(struct table_write *s, const char *home, bool step, const void *value,
                       const char *where, const struct column *c, struct why *why)
{
    const hsize_t one = 1;
    const char *name = step ? "step" : "time";
    char path[80];
    snprintf(path, sizeof path, "%s/%s", home, name);
    bool linked = table_write_grows(s, path);
    if (table_write_rows(s, path, step ? COLUMN_I64 : COLUMN_F64, 1, &one, CHUNK_FRAMES, value,
                         step ? NULL : "s", why))
        return why->status;
    return linked ? 0 : link_clock(s, path, name, where, c, why);
}

/* ---- what is the same in all frames ---- */

static int write_parameters(hid_t file, const struct frame *f, struct why *why)
{
    const struct packing *p = &f->packing;
    const int h5md[2] = { 1, 1 };
    int version = DOCUMENT_VERSION;
    if (h5_group(file, "/h5md/author", why) || h5_group(file, "/h5md/creator", why) ||
        h5_attr(file, "/h5md", "version", H5T_NATIVE_INT, 2, h5md, why) ||
        h5_attr_text(file, "/h5md/author", "name", "", why) ||
        h5_attr_text(file, "/h5md/creator", "name", "nsd", why) ||
        h5_attr_text(file, "/h5md/creator", "version", NSD_VERSION, why) ||
        h5_group(file, "/nsd", why) ||
        h5_attr(file, "/nsd", "version", H5T_NATIVE_INT, -1, &version, why) ||
        h5_attr_text(file, "/nsd", "kind", f->foreign ? "problem" : "packing", why) ||
        h5_write_text(file, "/nsd/history", f->history ? f->history : "", why))
        return why->status;
    if (f->foreign) return 0;
    const double g[3] = { p->g.x, p->g.y, p->g.z };
    int64_t seed = (int64_t)p->seed;
    if (h5_attr(file, "/nsd", "dim", H5T_NATIVE_INT, -1, &p->dim, why) ||
        h5_attr(file, "/nsd", "dt", H5T_NATIVE_DOUBLE, -1, &p->dt, why) ||
        h5_attr(file, "/nsd", "theta", H5T_NATIVE_DOUBLE, -1, &p->theta, why) ||
        h5_attr(file, "/nsd", "gravity", H5T_NATIVE_DOUBLE, 3, g, why) ||
        h5_attr(file, "/nsd", "seed", H5T_NATIVE_INT64, -1, &seed, why) ||
        (p->overlap && h5_attr_text(file, "/nsd", "overlap", overlap_name[p->overlap], why)))
        return why->status;
    return p->scene ? h5_write_text(file, "/nsd/scene", p->scene, why) : 0;
}

static int write_material(hid_t file, const struct packing *p, struct why *why)
{
    const hsize_t square[2] = { (hsize_t)p->kinds, (hsize_t)p->kinds };
    for (const struct column *c = layout_material; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/nsd/material/%s", c->name);
        if (h5_write(file, path, H5T_NATIVE_DOUBLE, 2, square, column_array(c, p), c->units, why))
            return why->status;
    }
    size_t length = 1;
    for (int32_t k = 0; k < p->kinds; k++) length += strlen(p->kind_name[k]) + 1;
    char *names = calloc(length, 1);
    if (!names) return why_set(why, EX_SOFTWARE, "no memory for the kinds");
    for (int32_t k = 0; k < p->kinds; k++) strcat(strcat(names, p->kind_name[k]), "\n");
    int e = h5_attr_text(file, "/nsd/material", "kinds", names, why);
    free(names);
    return e;
}

/* What moves the cell's edges, and what they yield to */
static int write_drive(hid_t file, const struct cell *c, struct why *why)
{
    const hsize_t shape[3] = { (hsize_t)c->gradients, 3, 3 }, *square = shape + 1;
    size_t n = (size_t)c->gradients;
    double *t = calloc(n + 1, sizeof *t), (*L)[9] = calloc(n + 1, sizeof *L);
    if (t && L)
        for (size_t k = 0; k < n; k++) {
            t[k] = c->gradient[k].t;
            memcpy(L[k], c->gradient[k].L, sizeof L[k]);
        }
    else
        why_set(why, EX_SOFTWARE, "no memory for the cell");
    bool bad =
        why->status || h5_write(file, "/nsd/cell/time", H5T_NATIVE_DOUBLE, 1, shape, t, "s", why) ||
        h5_write(file, "/nsd/cell/gradient", H5T_NATIVE_DOUBLE, 3, shape, L, "s-1", why) ||
        h5_write(file, "/nsd/cell/mass", H5T_NATIVE_DOUBLE, 2, square, c->mass, "kg", why) ||
        h5_write(file, "/nsd/cell/stress", H5T_NATIVE_DOUBLE, 2, square, c->stress, "Pa", why);
    free(t), free(L);
    return bad ? why->status : 0;
}

/* H5MD's box; where nothing is periodic it has no edges. */
static int write_box(hid_t file, const struct cell *c, struct why *why)
{
    const int dimension = 3; // positions have three components in the plane too
    const char none[3][5] = { "none", "none", "none" };
    const char *box = "/particles/all/box";
    const hsize_t three = 3;
    if (h5_group(file, box, why) ||
        h5_attr(file, box, "dimension", H5T_NATIVE_INT, -1, &dimension, why))
        return why->status;
    char boundary[3][9] = { "none", "none", "none" };
    for (int k = 0; k < 3; k++)
        if (c->repeats[k]) memcpy(boundary[k], "periodic", sizeof boundary[k]);
    bool repeats = cell_repeats(c);
    hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, repeats ? sizeof boundary[0] : sizeof none[0]);
    int e = h5_attr(file, box, "boundary", text, 3,
                    repeats ? (const void *)boundary : (const void *)none, why);
    H5Tclose(text);
    if (e || !repeats) return e;
    return h5_write(file, "/particles/all/box/origin", H5T_NATIVE_DOUBLE, 1, &three, &c->origin,
                    "m", why) ||
                   write_drive(file, c, why)
               ? why->status
               : 0;
}

static int write_bodies_and_walls(struct table_write *s, const struct packing *p, struct why *why)
{
    const hsize_t n = (hsize_t)p->n;
    for (const struct column *c = layout_bodies; c->name && !s->roster; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s", c->name);
        if (h5_write(s->file, path, column_native(c->type), 1, &n, column_array(c, p), c->units,
                     why))
            return why->status;
    }
    bool growing = s->growing;
    s->growing = false; // walls do not grow with the frames
    int e = table_write_columns(s, "/walls/plane", "", layout_walls, p->walls, p->wall,
                                sizeof *p->wall, 0, why);
    if (!e && freedoms_in(p))
        e = table_write_columns(s, "/walls/load", "", layout_loads, p->walls, p->wall,
                                sizeof *p->wall, 0, why);
    s->growing = growing;
    return e;
}

/* ---- what belongs to one frame ---- */

/* A trajectory whose bodies come and go */
static int write_roster(struct table_write *s, const struct packing *p, struct why *why)
{
    int64_t *row;
    if (!roster_enter(s->roster, s, p, &row, why)) roster_write(s->roster, s, p, row, why);
    free(row);
    return why->status;
}

static int write_motion(struct table_write *s, const struct packing *p, struct why *why)
{
    if (s->roster) return write_roster(s, p, why);
    for (const struct column *c = layout_motion; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s/value", c->name);
        const hsize_t shape[3] = { 1, (hsize_t)p->n, (hsize_t)c->width };
        if (table_write_rows(s, path, c->type, 3, shape, 1, column_array(c, p), c->units, why))
            return why->status;
    }
    return 0;
}

/* The speeds and travels of the walls' loads, with clocks of their own */
static int write_yield(struct table_write *s, const struct packing *p, struct why *why)
{
    const char *loads = "/walls/load";
    double *row = malloc(((size_t)p->walls + 1) * sizeof *row);
    if (!row) return why_set(why, EX_SOFTWARE, "no memory for the loads");
    const hsize_t shape[2] = { 1, (hsize_t)p->walls };
    int e = 0;
    for (const struct column *c = layout_yield; !e && c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "%s/%s/value", loads, c->name);
        column_gather(c, p->walls, p->wall, sizeof *p->wall, row);
        e = table_write_rows(s, path, c->type, 2, shape, CHUNK_FRAMES, row, c->units, why);
    }
    free(row);
    if (!e) e = write_clock(s, loads, true, &p->step, loads, layout_yield, why);
    return e ? e : write_clock(s, loads, false, &p->t, loads, layout_yield, why);
}

/* The images and the edges, where the cell repeats */
static int write_cell(struct table_write *s, const struct packing *p, struct why *why)
{
    for (const struct column *c = layout_cell; cell_repeats(&p->cell) && c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s/value", c->name);
        bool images = c == layout_cell;
        const hsize_t shape[3] = { 1, images ? (hsize_t)p->n : 3, 3 };
        const void *data = images ? column_array(c, p) : (const char *)&p->cell + c->offset;
        if (table_write_rows(s, path, c->type, 3, shape, images ? 1 : CHUNK_FRAMES, data, c->units,
                             why))
            return why->status;
    }
    return 0;
}

static int write_bases(struct table_write *s, const struct contacts *t, struct why *why)
{
    const hsize_t shape[3] = { (hsize_t)t->n, 3, 3 };
    vec3(*basis)[3] = malloc((size_t)(t->n + 1) * sizeof *basis);
    if (!basis) return why_set(why, EX_SOFTWARE, "no memory for /contacts/frame");
    for (int64_t i = 0; i < t->n; i++) {
        const struct contact *c = &t->c[i];
        basis[i][0] = c->n, basis[i][1] = c->t1, basis[i][2] = contact_t2(c);
    }
    int e = table_write_rows(s, "/contacts/frame", COLUMN_F64, 3, shape, CHUNK_CONTACTS, basis, "1",
                             why);
    free(basis);
    return e;
}

static int write_forces(struct table_write *s, const struct contacts *t, double dt, struct why *why)
{
    const hsize_t shape[2] = { (hsize_t)t->n, 3 };
    vec3 *force = malloc((size_t)(t->n + 1) * sizeof *force);
    if (!force) return why_set(why, EX_SOFTWARE, "no memory for %s", LAYOUT_FORCE);
    for (int64_t i = 0; i < t->n; i++)
        force[i] = v3_scale(1 / dt, contact_in_space(&t->c[i], t->found[i].r));
    int e =
        table_write_rows(s, LAYOUT_FORCE, COLUMN_F64, 2, shape, CHUNK_CONTACTS, force, "N", why);
    free(force);
    return e;
}

static int write_contacts(struct table_write *s, const struct frame *f, struct why *why)
{
    bool first = !table_write_grows(s, "/contacts/start");
    const hsize_t one = 1;
    const struct contacts *t = &f->contacts;
    // a column of a trajectory is one of all its contacts, or of none
    bool forces = t->found && (first ? f->forces : table_write_grows(s, LAYOUT_FORCE));
    if (table_write_rows(s, "/contacts/start", COLUMN_I64, 1, &one, CHUNK_FRAMES, &s->contacts,
                         NULL, why) ||
        table_write_rows(s, "/contacts/count", COLUMN_I64, 1, &one, CHUNK_FRAMES, &t->n, NULL,
                         why) ||
        table_write_columns(s, "/contacts", "", layout_contacts, t->n, t->c, sizeof *t->c,
                            CHUNK_CONTACTS, why) ||
        write_bases(s, t, why) ||
        (cell_repeats(&f->packing.cell) &&
         table_write_columns(s, "/contacts", "", layout_shifts, t->n, t->c, sizeof *t->c,
                             CHUNK_CONTACTS, why)) ||
        (t->found && table_write_columns(s, "/contacts", "", layout_found, t->n, t->found,
                                         sizeof *t->found, CHUNK_CONTACTS, why)) ||
        (forces && write_forces(s, t, f->packing.dt, why)) ||
        table_write_rows(s, "/contacts/step", COLUMN_I64, 1, &one, CHUNK_FRAMES, &f->packing.step,
                         NULL, why))
        return why->status;
    if (s->growing) s->contacts += t->n;
    int moved = f->moved;
    return !first ? 0 : h5_attr(s->file, "/contacts", "moved", H5T_NATIVE_INT, -1, &moved, why);
}

/* The balances, beside the report, whose clocks they share */
static int write_balance(struct table_write *s, const struct report *rep, bool first,
                         struct why *why)
{
    const char *solver = LAYOUT_REPORT;
    if (table_write_columns(s, solver, "/value", layout_balance, 1, rep, sizeof *rep, CHUNK_FRAMES,
                            why))
        return why->status;
    if (first && (link_clock(s, LAYOUT_REPORT "/step", "step", solver, layout_balance, why) ||
                  link_clock(s, LAYOUT_REPORT "/time", "time", solver, layout_balance, why)))
        return why->status;
    return 0;
}

static int write_report(struct table_write *s, const struct report *rep, struct why *why)
{
    const char *solver = LAYOUT_REPORT;
    bool first = !table_write_grows(s, LAYOUT_REPORT "/eps/value");
    if (table_write_columns(s, solver, "/value", layout_report, 1, rep, sizeof *rep, CHUNK_FRAMES,
                            why) ||
        write_clock(s, solver, true, &rep->step, solver, layout_report, why) ||
        write_clock(s, solver, false, &rep->t, solver, layout_report, why) ||
        (rep->balanced && write_balance(s, rep, first, why)))
        return why->status;
    if (first &&
        (h5_attr_text(s->file, solver, "method", rep->method, why) ||
         h5_attr_text(s->file, solver, "criterion", criterion_name[rep->criterion], why) ||
         h5_attr(s->file, solver, "eps", H5T_NATIVE_DOUBLE, -1, &rep->eps, why) ||
         h5_attr_text(s->file, solver, "options", rep->options ? rep->options : "{}", why)))
        return why->status;
    if (!rep->history || s->growing) return 0;
    const hsize_t shape[2] = { (hsize_t)rep->sweeps, 5 };
    return h5_write(s->file, LAYOUT_REPORT "/history", H5T_NATIVE_DOUBLE, 2, shape, rep->history,
                    "1", why);
}

int frame_write_static(struct table_write *s, const struct frame *f, struct why *why)
{
    if (write_parameters(s->file, f, why)) return why->status;
    if (f->packed &&
        (write_material(s->file, &f->packing, why) || write_box(s->file, &f->packing.cell, why) ||
         write_bodies_and_walls(s, &f->packing, why)))
        return why->status;
    return unknown_write(f->unknown, s->file, f->stale && !f->foreign, why);
}

static const char particles[] = "/particles/all", position[] = "/particles/all/position";

/* Its steps or its times, for all that a frame has of particles */
static int write_particles_clock(struct table_write *s, bool step, const struct packing *p,
                                 struct why *why)
{
    const char *from = step ? "/particles/all/position/step" : "/particles/all/position/time";
    bool linked = table_write_grows(s, from);
    const void *value = step ? (const void *)&p->step : (const void *)&p->t;
    if (write_clock(s, position, step, value, particles, layout_motion, why)) return why->status;
    if (linked || !cell_repeats(&p->cell)) return 0;
    return link_clock(s, from, step ? "step" : "time", particles, layout_cell, why);
}

int frame_write_moment(struct table_write *s, const struct frame *f, struct why *why)
{
    if (f->packed &&
        (write_motion(s, &f->packing, why) || write_cell(s, &f->packing, why) ||
         write_particles_clock(s, false, &f->packing, why) || flow_write(s, &f->packing, why)))
        return why->status;
    if (f->packed && freedoms_in(&f->packing) && write_yield(s, &f->packing, why))
        return why->status;
    if (f->packed && f->detected && write_contacts(s, f, why)) return why->status;
    return f->reported ? write_report(s, &f->report, why) : 0;
}

int frame_write_step(struct table_write *s, const struct frame *f, struct why *why)
{
    if (!f->packed) return 0;
    bool first = !table_write_grows(s, "/particles/all/position/step");
    if (write_particles_clock(s, true, &f->packing, why)) return why->status;
    return first ? flow_link(s, &f->packing, why) : 0;
}
