#include "file/frame_write.h"

#include "file/breakage_tables.h"
#include "file/cell_tables.h"
#include "file/contact_rows.h"
#include "file/external_force_tables.h"
#include "file/h5.h"
#include "file/pair_law_tables.h"
#include "file/report_rows.h"
#include "file/roster.h"
#include "file/shape_tables.h"
#include "file/stream.h"
#include "file/unknown.h"
#include "file/wall_load_tables.h"
#include "file/wall_tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- what is the same in all frames ---- */

static int write_parameters(hid_t file, const struct frame *f, struct failure *failure)
{
    const struct packing *p = &f->packing;
    const int h5md[2] = { 1, 1 };
    int version = DOCUMENT_VERSION;
    if (h5_group(file, "/h5md/author", failure) || h5_group(file, "/h5md/creator", failure) ||
        h5_attr(file, "/h5md", "version", h5_vector(H5T_NATIVE_INT, 2, h5md), failure) ||
        h5_attr_text(file, "/h5md/author", "name", "", failure) ||
        h5_attr_text(file, "/h5md/creator", "name", "nsd", failure) ||
        h5_attr_text(file, "/h5md/creator", "version", NSD_VERSION, failure) ||
        h5_group(file, "/nsd", failure) ||
        h5_attr(file, "/nsd", "version", h5_scalar(H5T_NATIVE_INT, &version), failure) ||
        h5_attr_text(file, "/nsd", "kind", f->foreign ? "problem" : "packing", failure) ||
        h5_write_text(file, "/nsd/history", f->history ? f->history : "", failure))
        return failure->status;
    if (f->foreign) return 0;
    const double g[3] = { p->g.x, p->g.y, p->g.z };
    int64_t seed = (int64_t)p->seed;
    double dt = p->dt;
    if (h5_attr(file, "/nsd", "dim", h5_scalar(H5T_NATIVE_INT, &p->dim), failure) ||
        h5_attr(file, "/nsd", "dt", h5_scalar(H5T_NATIVE_DOUBLE, &dt), failure) ||
        h5_attr(file, "/nsd", "theta", h5_scalar(H5T_NATIVE_DOUBLE, &p->theta), failure) ||
        h5_attr(file, "/nsd", "gravity", h5_vector(H5T_NATIVE_DOUBLE, 3, g), failure) ||
        h5_attr(file, "/nsd", "seed", h5_scalar(H5T_NATIVE_INT64, &seed), failure) ||
        (p->overlap && h5_attr_text(file, "/nsd", "overlap", overlap_name[p->overlap], failure)))
        return failure->status;
    const double origin[2] = { p->t0, (double)p->step0 };
    if ((p->t0 != 0 || p->step0) &&
        h5_attr(file, "/nsd", "time_origin", h5_vector(H5T_NATIVE_DOUBLE, 2, origin), failure))
        return failure->status;
    return p->scene ? h5_write_text(file, "/nsd/scene", p->scene, failure) : 0;
}

/* Is any of the numbers of a pair not 0? */
static bool any_pair(const struct packing *p, const double *table)
{
    for (int32_t k = 0; k < p->materials * p->materials; k++)
        if (table[k] != 0) return true;
    return false;
}

static int write_pairs(hid_t file, const struct packing *p, struct failure *failure)
{
    const hsize_t square[2] = { (hsize_t)p->materials, (hsize_t)p->materials };
    for (const struct field *c = material_fields; c->name; c++) {
        char path[80];
        if (c->traits & FIELD_OPTIONAL && !any_pair(p, field_array(c, p))) continue;
        snprintf(path, sizeof path, "/nsd/material/%s", c->name);
        if (h5_write(file, path, h5_array(H5T_NATIVE_DOUBLE, 2, square, field_array(c, p)),
                     c->units, failure))
            return failure->status;
    }
    return 0;
}

static int write_material(hid_t file, const struct packing *p, struct failure *failure)
{
    if (write_pairs(file, p, failure)) return failure->status;
    size_t length = 1;
    for (int32_t k = 0; k < p->materials; k++) length += strlen(p->material_name[k]) + 1;
    char *names = calloc(length, 1);
    if (!names) return failure_set(failure, EX_SOFTWARE, "no memory for the materials");
    for (int32_t k = 0; k < p->materials; k++) strcat(strcat(names, p->material_name[k]), "\n");
    int e = h5_attr_text(file, "/nsd/material", "kinds", names, failure);
    free(names);
    return e;
}

static int write_bodies(struct table_write *s, const struct packing *p, struct failure *failure)
{
    if (!s->roster && table_write_bodies(s, false, p, failure)) return failure->status;
    if (wall_tables_write_static(s, p, failure) || pull_tables_write(s, p, failure))
        return failure->status;
    return sum_tables_write_static(s, p, failure);
}

/* ---- what belongs to one frame ---- */

/* A trajectory whose bodies come and go */
static int write_roster(struct table_write *s, const struct packing *p, struct failure *failure)
{
    int64_t *row;
    if (!roster_enter(s->roster, s, p, &row, failure)) roster_write(s->roster, s, p, row, failure);
    free(row);
    return failure->status;
}

static int write_motion(struct table_write *s, const struct packing *p, struct failure *failure)
{
    return s->roster ? write_roster(s, p, failure) : table_write_bodies(s, true, p, failure);
}

int frame_write_static(struct table_write *s, const struct frame *f, struct failure *failure)
{
    if (write_parameters(s->file, f, failure)) return failure->status;
    if (f->packed && (write_material(s->file, &f->packing, failure) ||
                      shape_tables_write_static(s, &f->packing, failure) ||
                      breakage_tables_write_static(s, &f->packing, failure) ||
                      name_tables_write(s, &f->packing, failure) ||
                      pair_law_tables_write_static(s->file, &f->packing, failure) ||
                      cell_tables_write_box(s->file, &f->packing.cell, failure) ||
                      write_bodies(s, &f->packing, failure)))
        return failure->status;
    return unknown_write(f->unknown, s->file, f->stale && !f->foreign, failure);
}

static const char particles[] = "/particles/all";

/* Its steps or its times, for all that a frame has of particles */
static int write_particles_clock(struct table_write *s, bool step, const struct packing *p,
                                 struct failure *failure)
{
    const char *from = step ? "/particles/all/position/step" : "/particles/all/position/time";
    bool linked = table_write_grows(s, from);
    const void *value = step ? (const void *)&p->step : (const void *)&p->t;
    const char *name = step ? "step" : "time";
    if (table_write_number(s, from, step ? COLUMN_I64 : COLUMN_F64, value, step ? NULL : "s",
                           failure))
        return failure->status;
    for (const struct field *b = body_columns; b->name && !linked; b++) {
        const struct field it[] = { *b, { 0 } };
        if (b->traits & FIELD_MOVES && field_array(b, p) &&
            table_write_link(s, from, name, particles, it, failure))
            return failure->status;
    }
    if (linked || !cell_repeats(&p->cell)) return 0;
    return table_write_link(s, from, name, particles, box_fields, failure);
}

int frame_write_moment(struct table_write *s, const struct frame *f, struct failure *failure)
{
    if (f->packed &&
        (write_motion(s, &f->packing, failure) || cell_tables_write(s, &f->packing, failure) ||
         write_particles_clock(s, false, &f->packing, failure) ||
         flow_write(s, &f->packing, failure) || shape_tables_write(s, &f->packing, failure) ||
         breakage_tables_write(s, &f->packing, failure)))
        return failure->status;
    if (f->packed &&
        (wall_tables_write(s, &f->packing, failure) ||
         pair_law_tables_write(s, &f->packing, failure) ||
         memory_rows_write(s, &f->packing, failure) || sum_tables_write(s, &f->packing, failure) ||
         external_force_tables_write(s, f, failure)))
        return failure->status;
    if (f->packed && f->detected && contact_rows_write(s, f, failure)) return failure->status;
    if (!f->reported || report_rows_write(s, &f->report, failure)) return failure->status;
    return f->packed ? account_rows_write(s, &f->account, failure) : 0;
}

int frame_write_step(struct table_write *s, const struct frame *f, struct failure *failure)
{
    if (!f->packed) return 0;
    bool first = !table_write_grows(s, "/particles/all/position/step");
    if (write_particles_clock(s, true, &f->packing, failure)) return failure->status;
    if (!first) return 0;
    return flow_link(s, &f->packing, failure) || breakage_tables_link(s, &f->packing, failure)
               ? failure->status
               : 0;
}
