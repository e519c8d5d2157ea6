#include "file/frame_read.h"

#include "file/breakage_tables.h"
#include "file/cell_tables.h"
#include "file/distributed.h"
#include "file/external_force_tables.h"
#include "file/pair_law_tables.h"
#include "file/roster.h"
#include "file/shape_tables.h"
#include "file/wall_load_tables.h"
#include "file/wall_tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MATERIALS_MOST = 4096, /* of material: tables of pairs have a row for two of them */
    BLOCK =
        2 * 8192 /* bodies that are read at once where others take them: two chunks of nsd's own */
};

/* Does the document have no dataset of a column that it may lack? */
static bool may_lack(const struct source *s, const struct field *b, const char *path)
{
    return (b->traits & FIELD_OPTIONAL) && !source_has(s, path);
}

/* Steps and times of the frames. A frame counts when all of its motion is there. */
static int frame_read_count_frames(struct frame_read *r, struct failure *failure)
{
    uint64_t m, shape[4];
    int64_t n;
    r->step = table_read_steps(r->source, "/particles/all/position/step", &n, failure);
    r->time = source_read_all(r->source, "/particles/all/position/time", COLUMN_F64, &m, failure);
    if (!r->step || !r->time) return failure->status;
    n = n < (int64_t)m ? n : (int64_t)m;
    for (const struct field *b = body_columns; b->name; b++) {
        char path[80];
        layout_body_path(b, path);
        if (!(b->traits & FIELD_MOVES) || b->traits & FIELD_OPTIONAL) continue;
        if (source_shape(r->source, path, shape) != 3)
            return failure_set(failure, EX_DATAERR, "%s: no dataset of shape frames x bodies x %d",
                               path, b->width);
        n = n < (int64_t)shape[0] ? n : (int64_t)shape[0];
    }
    if (source_shape(r->source, "/particles/all/id/value", shape) == 2)
        n = n < (int64_t)shape[0] ? n : (int64_t)shape[0];
    const int64_t most = (int64_t)1 << STEPS_LOG2;
    for (int64_t k = 0; k < n; k++)
        if (r->step[k] < -most || r->step[k] > most)
            return failure_set(failure, EX_DATAERR,
                               "/particles/all/position/step: %lld is out of range",
                               (long long)r->step[k]);
    // a killed writer may have made room for a step without setting it
    for (r->frames = n > 0; r->frames < n; r->frames++)
        if (r->step[r->frames] <= r->step[r->frames - 1]) break;
    return 0;
}

int frame_read_open(struct frame_read *r, struct source *source, struct failure *failure)
{
    *r = (struct frame_read){ .source = source, .frames = 1 };
    if (source_has(source, "/particles/all")) {
        if (frame_read_count_frames(r, failure) || cell_tables_open(source, r->repeats, failure))
            return failure->status;
        if (memory_rows_open(&r->memory, source, failure)) return failure->status;
        if (source_has(source, "/contacts") && contact_rows_open(&r->contacts, source, failure))
            return failure->status;
    } else if (!fclib_in(source)) {
        return fclib_none(source, failure);
    }
    if (report_rows_open(&r->reports, source, failure)) return failure->status;
    r->reports.one_frame = r->frames == 1;
    return 0;
}

void frame_read_close(struct frame_read *r)
{
    free(r->step), free(r->time);
    contact_rows_close(&r->contacts);
    memory_rows_close(&r->memory);
    report_rows_close(&r->reports);
    *r = (struct frame_read){ 0 };
}

/* Tables of pairs of materials, both halves of which say the same */
static int read_pairs(struct source *doc, struct packing *p, struct failure *failure)
{
    const uint64_t materials = (uint64_t)p->materials;
    for (const struct field *c = material_fields; c->name; c++) {
        char path[80];
        double *table = field_array(c, p);
        snprintf(path, sizeof path, "/nsd/material/%s", c->name);
        if (c->traits & FIELD_OPTIONAL && !source_has(doc, path)) continue;
        if (source_read(doc, path, COLUMN_F64, materials * materials, table, failure))
            return failure->status;
        for (int32_t a = 0; a < p->materials; a++)
            for (int32_t b = 0; b < a; b++)
                if (!(table[a * p->materials + b] == table[b * p->materials + a]))
                    return failure_set(failure, EX_DATAERR, "%s: %s and %s have two values", path,
                                       p->material_name[b], p->material_name[a]);
    }
    return 0;
}

static int frame_read_material(struct source *doc, struct packing *p, struct failure *failure)
{
    char *names = source_text(doc, "/nsd/material", "kinds", failure);
    int32_t materials = 0;
    for (const char *c = names; c && *c; c++) materials += *c == '\n';
    if (failure->status) return failure->status;
    if (materials > MATERIALS_MOST) {
        free(names);
        return failure_set(failure, EX_DATAERR, "/nsd/material@kinds: more than %d materials",
                           MATERIALS_MOST);
    }
    if (!materials) {
        free(names);
        return failure_set(failure, EX_DATAERR, "/nsd/material@kinds: no materials");
    }
    int e = packing_alloc_materials(p, materials, failure);
    char *name = names;
    for (int32_t k = 0; !e && k < materials; k++) {
        char *end = strchr(name, '\n');
        free(p->material_name[k]);
        p->material_name[k] = strndup(name, (size_t)(end - name));
        if (!p->material_name[k])
            e = failure_set(failure, EX_SOFTWARE, "no memory for the materials");
        name = end + 1;
    }
    free(names);
    return e ? e : read_pairs(doc, p, failure);
}

/* What is done about overlap; a document need not say it. */
static int read_overlap(struct source *doc, struct packing *p, struct failure *failure)
{
    char *name = source_text(doc, "/nsd", "overlap", failure);
    if (!name) return failure->status;
    for (int k = OVERLAP_KEEP; k < OVERLAP_COUNT; k++)
        if (!strcmp(name, overlap_name[k])) p->overlap = (enum overlap)k;
    free(name);
    return p->overlap
               ? 0
               : failure_set(failure, EX_DATAERR, "/nsd@overlap: no such treatment of overlap");
}

static int read_parameters(struct source *doc, struct packing *p, struct failure *failure)
{
    double g[3] = { 0 };
    int64_t seed = 0;
    if (source_attribute(doc, "/nsd", "dt", (struct numbers){ COLUMN_F64, -1, &p->dt }, failure) ||
        source_attribute(doc, "/nsd", "theta", (struct numbers){ COLUMN_F64, -1, &p->theta },
                         failure) ||
        source_attribute(doc, "/nsd", "gravity", (struct numbers){ COLUMN_F64, 3, g }, failure) ||
        source_attribute(doc, "/nsd", "seed", (struct numbers){ COLUMN_I64, -1, &seed }, failure))
        return failure->status;
    p->g = v3(g[0], g[1], g[2]);
    p->seed = (uint64_t)seed;
    if (read_overlap(doc, p, failure)) return failure->status;
    p->scene = source_text(doc, "/nsd/scene", NULL, failure);
    return failure->status;
}

/* The dt of frame k, where each has its own: none is longer than the document's. Times are counted from t0 all the same. */
static int read_time_step(struct frame_read *r, int64_t k, double t0, struct packing *p,
                          struct failure *failure)
{
    double dt;
    if (source_rows(r->source, LAYOUT_TIME_STEP, (struct slab){ COLUMN_F64, k, 1, 1 }, &dt,
                    failure))
        return failure->status;
    if (!(dt > 0 && dt <= p->dt))
        return failure_set(failure, EX_DATAERR,
                           LAYOUT_TIME_STEP ": not above 0 and at most /nsd@dt");
    p->t0 = t0;
    packing_set_dt(p, dt);
    return 0;
}

/* Step and time of frame k, and from where its time is counted: a document whose time is step dt need not
   say it, and what one says that contradicts its times is not believed. */
static int frame_read_clock(struct frame_read *r, int64_t k, struct packing *p,
                            struct failure *failure)
{
    const double most = (double)((int64_t)1 << STEPS_LOG2);
    double origin[2] = { 0 };
    struct failure none = { 0 };
    if (source_attribute(r->source, "/nsd", "time_origin",
                         (struct numbers){ COLUMN_F64, 2, origin }, &none) ||
        !(fabs(origin[1]) <= most))
        origin[0] = origin[1] = 0;
    p->step = r->step[k], p->t = r->time[k];
    packing_count_from(p, origin[0], (int64_t)origin[1]);
    return source_has(r->source, LAYOUT_TIME_STEP) ? read_time_step(r, k, origin[0], p, failure)
                                                   : 0;
}

/* The bodies of frame k in rows first .. first + p->n - 1, into p; first -1: all rows that there are */
static int read_bodies(struct frame_read *r, int64_t k, int64_t first, struct packing *p,
                       struct failure *failure)
{
    for (const struct field *b = body_columns; b->name; b++) {
        const struct field *c = b;
        void *to = field_array(c, p);
        char path[80];
        layout_body_path(b, path);
        if (!to || may_lack(r->source, b, path)) continue;
        if (!(b->traits & FIELD_MOVES))
            source_rows(r->source, path,
                        (struct slab){ c->type, first < 0 ? 0 : first, p->n, c->width }, to,
                        failure);
        else if (first < 0)
            source_rows(r->source, path, (struct slab){ c->type, k, 1, p->n * c->width }, to,
                        failure);
        else
            source_part(r->source, path, k, (struct slab){ c->type, first, p->n, c->width }, to,
                        failure);
        if (failure->status) return failure->status;
    }
    return 0;
}

/* Columns that are there where the document has them */
static int alloc_optional(struct frame_read *r, struct packing *p, struct failure *failure)
{
    for (int k = 0; k < BODY_COLUMNS; k++) {
        char path[80];
        layout_body_path(&body_columns[k], path);
        if (body_columns[k].traits & FIELD_OPTIONAL && !field_array(&body_columns[k], p) &&
            !(body_columns[k].traits & FIELD_BY_SETTINGS) && source_has(r->source, path) &&
            packing_alloc_column(p, k, failure))
            return failure->status;
    }
    return 0;
}

/* All of frame k but the numbers of its n bodies */
static int read_settings(struct frame_read *r, int64_t k, int64_t n, struct packing *p,
                         struct failure *failure)
{
    int dim;
    if (source_attribute(r->source, "/nsd", "dim", (struct numbers){ COLUMN_I32, -1, &dim },
                         failure) ||
        packing_init(p, dim, n, failure) || read_parameters(r->source, p, failure) ||
        frame_read_material(r->source, p, failure) || shape_tables_read(r->source, k, p, failure) ||
        breakage_tables_read(r->source, k, p, failure) ||
        wall_tables_read(r->source, k, p, failure) || flow_tables_read(r->source, k, p, failure) ||
        pull_tables_read(r->source, p, failure) || pair_law_tables_read(r->source, k, p, failure) ||
        frame_read_clock(r, k, p, failure) ||
        cell_tables_read(r->source, k, r->repeats, p, failure))
        return failure->status;
    if (flow_tables_read_numbers(r->source, p, failure) ||
        external_force_tables_read(r->source, p, failure) ||
        name_tables_read(r->source, p, failure) || sum_tables_read(r->source, k, p, failure))
        return failure->status;
    return alloc_optional(r, p, failure);
}

/* Are all datasets of n bodies there, and of their shape? (What is not says read_bodies.) */
static bool has_columns(const struct frame_read *r, const struct packing *p, int64_t n)
{
    uint64_t shape[4];
    char path[80];
    for (const struct field *b = body_columns; b->name; b++) {
        bool moves = b->traits & FIELD_MOVES, wide = b->width > 1;
        layout_body_path(b, path);
        if (!field_array(b, p) || may_lack(r->source, b, path)) continue;
        int rank = source_shape(r->source, path, shape);
        if (rank != (moves ? 3 : 1 + wide) || (int64_t)shape[moves] != n ||
            ((moves || wide) && shape[1 + moves] != (uint64_t)b->width))
            return false;
    }
    return true;
}

/* The n bodies of frame k on their way to those who have them; p has all else. */
static int hand_over(struct frame_read *r, int64_t k, const struct packing *p, int64_t n,
                     struct failure *failure)
{
    struct packing room;
    double most = 0;
    if (packing_init(&room, p->dim, n < BLOCK ? n : BLOCK, failure) ||
        packing_alloc_optional(&room, packing_optional(p), failure))
        return packing_free(&room), failure->status;
    for (int64_t first = 0; first < n && !failure->status; first += BLOCK) {
        struct packing block =
            packing_with_bodies(p, &room, 0, n - first < BLOCK ? n - first : BLOCK);
        if (read_bodies(r, k, first, &block, failure) ||
            packing_check_bodies(&block, first, failure) ||
            r->distributed->take(r->distributed, &block, first, failure) ||
            source_unload(r->source, failure) ||
            source_frame(r->source, failure)) // the block is gone
            break;
        for (int64_t i = 0; i < block.n; i++)
            most = most < block.radius[i] ? block.radius[i] : most;
    }
    packing_free(&room);
    if (!failure->status && cell_repeats(&p->cell)) cell_check(&p->cell, p->dim, 2 * most, failure);
    return failure->status;
}

/* Do others take the bodies? Then *p has all else; else nothing. */
static bool are_wanted(struct frame_read *r, int64_t k, struct packing *p)
{
    struct failure none = { 0 };
    uint64_t shape[4];
    if (!r->distributed || source_has(r->source, "/particles/all/id/value") ||
        source_shape(r->source, "/particles/all/radius", shape) != 1)
        return false;
    int64_t n = shape[0] > INT32_MAX ? 0 : (int64_t)shape[0];
    bool good =
        !read_settings(r, k, 0, p, &none) && !packing_check(p, &none) && n && has_columns(r, p, n);
    if (good && r->distributed->wants(r->distributed, p, n)) return true;
    packing_free(p);
    return false;
}

static int read_packing(struct frame_read *r, int64_t k, struct packing *p, struct failure *failure)
{
    uint64_t shape[4];
    int64_t n = 0, *row;
    if (roster_find(r->source, k, &row, &n, failure)) goto end;
    // no memory is allocated for bodies without positions
    if (source_shape(r->source, "/particles/all/position/value", shape) != 3 ||
        (row ? (int64_t)shape[1] < n : (int64_t)shape[1] != n)) {
        failure_set(failure, EX_DATAERR,
                    "/particles/all/position/value: not of shape frames x %lld x 3", (long long)n);
        goto end;
    }
    if (read_settings(r, k, n, p, failure) ||
        (row ? roster_read(r->source, k, row, p, failure) : read_bodies(r, k, -1, p, failure)))
        goto end;
    if (!packing_check(p, failure)) memory_rows_read(&r->memory, p, failure);
end:
    free(row);
    return failure->status;
}

static int frame_read_foreign(struct frame_read *r, struct frame *f, struct failure *failure)
{
    struct source *source = r->source;
    if (fclib_read(&f->problem, source, failure)) return failure->status;
    f->foreign = true;
    struct delassus *W = &f->problem.W;
    if (fclib_load_solution(&f->problem, source, W->r, failure)) return failure->status;
    if (source_has(source, "/solution/u")) {
        uint64_t n = (uint64_t)(W->d * W->n);
        f->u = calloc(n + 1, sizeof *f->u);
        if (!f->u) return failure_set(failure, EX_SOFTWARE, "no memory for the solution");
        if (source_read(source, "/solution/u", COLUMN_F64, n, f->u, failure))
            return failure->status;
    }
    return report_rows_read(&r->reports, 0, &f->report, &f->account, &f->reported, failure);
}

int frame_read_moment(struct frame_read *r, int64_t k, struct frame *f, struct failure *failure)
{
    if (source_frame(r->source, failure)) return failure->status;
    f->history = source_text(r->source, "/nsd/history", NULL, failure);
    if (failure->status) return failure->status;
    if (!r->step) return frame_read_foreign(r, f, failure);
    if (are_wanted(r, k, &f->packing)) {
        f->distributed = r->distributed;
        if (hand_over(r, k, &f->packing, f->distributed->n, failure)) return failure->status;
    } else if (read_packing(r, k, &f->packing, failure)) {
        return failure->status;
    }
    f->packed = true;
    if (contact_rows_read(&r->contacts, f, failure)) return failure->status;
    return report_rows_read(&r->reports, r->step[k], &f->report, &f->account, &f->reported,
                            failure);
}
