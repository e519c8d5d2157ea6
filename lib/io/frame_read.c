#include "io/frame_read.h"

#include "io/boundary_tables.h"
#include "io/cell_tables.h"
#include "io/flow_tables.h"
#include "io/law_tables.h"
#include "io/roster.h"
#include "io/shape_tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Steps and times of the frames. A frame counts when all of its motion is there. */
static int count_frames(struct frame_read *r, struct why *why)
{
    uint64_t m, shape[4];
    int64_t n;
    r->step = table_read_steps(r->source, "/particles/all/position/step", &n, why);
    r->time = source_read_all(r->source, "/particles/all/position/time", COLUMN_F64, &m, why);
    if (!r->step || !r->time) return why->status;
    n = n < (int64_t)m ? n : (int64_t)m;
    for (const struct column *c = layout_motion; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s/value", c->name);
        if (source_shape(r->source, path, shape) != 3)
            return why_set(why, EX_DATAERR, "%s: no dataset of shape frames x bodies x %d", path,
                           c->width);
        n = n < (int64_t)shape[0] ? n : (int64_t)shape[0];
    }
    if (source_shape(r->source, "/particles/all/id/value", shape) == 2)
        n = n < (int64_t)shape[0] ? n : (int64_t)shape[0];
    // a killed writer may have made room for a step without setting it
    for (r->frames = n > 0; r->frames < n; r->frames++)
        if (r->step[r->frames] <= r->step[r->frames - 1]) break;
    return 0;
}

int frame_read_open(struct frame_read *r, struct source *source, struct why *why)
{
    *r = (struct frame_read){ .source = source, .frames = 1 };
    if (source_has(source, "/particles/all")) {
        if (count_frames(r, why) || cell_tables_open(source, r->repeats, why)) return why->status;
        if (source_has(source, "/contacts") && contact_rows_open(&r->contacts, source, why))
            return why->status;
    } else if (!fclib_in(source)) {
        return why_set(why, EX_DATAERR, "holds neither particles nor an FCLIB problem");
    }
    return report_rows_open(&r->reports, source, why);
}

void frame_read_close(struct frame_read *r)
{
    free(r->step), free(r->time);
    contact_rows_close(&r->contacts);
    report_rows_close(&r->reports);
    *r = (struct frame_read){ 0 };
}

/* Both halves of the tables say the same. */
static int check_symmetric(const struct packing *p, struct why *why)
{
    for (const struct column *c = layout_material; c->name; c++) {
        const double *table = column_array(c, p);
        for (int32_t a = 0; a < p->kinds; a++)
            for (int32_t b = 0; b < a; b++)
                if (!(table[a * p->kinds + b] == table[b * p->kinds + a]))
                    return why_set(why, EX_DATAERR, "/nsd/material/%s: %s and %s have two values",
                                   c->name, p->kind_name[b], p->kind_name[a]);
    }
    return 0;
}

static int read_material(struct source *doc, struct packing *p, struct why *why)
{
    char *names = source_text(doc, "/nsd/material", "kinds", why);
    int32_t kinds = 0;
    for (const char *c = names; c && *c; c++) kinds += *c == '\n';
    if (why->status) return why->status;
    if (!kinds) {
        free(names);
        return why_set(why, EX_DATAERR, "/nsd/material@kinds: no kinds of material");
    }
    int e = packing_alloc_kinds(p, kinds, why);
    char *name = names;
    for (int32_t k = 0; !e && k < kinds; k++) {
        char *end = strchr(name, '\n');
        free(p->kind_name[k]);
        p->kind_name[k] = strndup(name, (size_t)(end - name));
        if (!p->kind_name[k]) e = why_set(why, EX_SOFTWARE, "no memory for the kinds");
        name = end + 1;
    }
    for (const struct column *c = layout_material; !e && c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/nsd/material/%s", c->name);
        e = source_read(doc, path, COLUMN_F64, (uint64_t)kinds * (uint64_t)kinds,
                        column_array(c, p), why);
    }
    free(names);
    return e ? e : check_symmetric(p, why);
}

/* What is done about overlap; a document need not say it. */
static int read_overlap(struct source *doc, struct packing *p, struct why *why)
{
    char *name = source_text(doc, "/nsd", "overlap", why);
    if (!name) return why->status;
    for (int k = OVERLAP_KEEP; k < OVERLAP_COUNT; k++)
        if (!strcmp(name, overlap_name[k])) p->overlap = (enum overlap)k;
    free(name);
    return p->overlap ? 0 : why_set(why, EX_DATAERR, "/nsd@overlap: no such way against overlap");
}

static int read_parameters(struct source *doc, struct packing *p, struct why *why)
{
    double g[3];
    int64_t seed;
    if (source_attribute(doc, "/nsd", "dt", COLUMN_F64, -1, &p->dt, why) ||
        source_attribute(doc, "/nsd", "theta", COLUMN_F64, -1, &p->theta, why) ||
        source_attribute(doc, "/nsd", "gravity", COLUMN_F64, 3, g, why) ||
        source_attribute(doc, "/nsd", "seed", COLUMN_I64, -1, &seed, why))
        return why->status;
    p->g = v3(g[0], g[1], g[2]);
    p->seed = (uint64_t)seed;
    if (read_overlap(doc, p, why)) return why->status;
    p->scene = source_text(doc, "/nsd/scene", NULL, why);
    return why->status;
}

/* Bodies as they are in every frame, and where they are in frame k */
static int read_bodies(struct frame_read *r, int64_t k, struct packing *p, struct why *why)
{
    for (const struct column *c = layout_bodies; c->name; c++) {
        char path[80];
        if (!column_array(c, p)) continue;
        snprintf(path, sizeof path, "/particles/all/%s", c->name);
        if (source_rows(r->source, path, c->type, 0, p->n, c->width, column_array(c, p), why))
            return why->status;
    }
    for (const struct column *c = layout_motion; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s/value", c->name);
        if (source_rows(r->source, path, c->type, k, 1, p->n * c->width, column_array(c, p), why))
            return why->status;
    }
    return 0;
}

static int read_packing(struct frame_read *r, int64_t k, struct packing *p, struct why *why)
{
    uint64_t shape[4];
    int dim;
    int64_t n = 0, *row;
    if (roster_find(r->source, k, &row, &n, why)) goto end;
    if (source_attribute(r->source, "/nsd", "dim", COLUMN_I32, -1, &dim, why)) goto end;
    // no memory is allocated for bodies without positions
    if (source_shape(r->source, "/particles/all/position/value", shape) != 3 ||
        (row ? (int64_t)shape[1] < n : (int64_t)shape[1] != n)) {
        why_set(why, EX_DATAERR, "/particles/all/position/value: not of shape frames x %lld x 3",
                (long long)n);
        goto end;
    }
    if (packing_init(p, dim, n, why) || read_parameters(r->source, p, why) ||
        read_material(r->source, p, why) || shape_tables_read(r->source, p, why) ||
        boundary_tables_read(r->source, k, p, why) ||
        (row ? roster_read(r->source, k, row, p, why) : read_bodies(r, k, p, why)) ||
        flow_tables_read(r->source, k, p, why) || law_tables_read(r->source, k, p, why))
        goto end;
    p->step = r->step[k], p->t = r->time[k];
    if (packing_varies(p) && (r->repeats[0] || r->repeats[1] || r->repeats[2]))
        why_set(why, EX_DATAERR, "bodies that come and go in a cell that repeats: not known");
    else if (!cell_tables_read(r->source, k, r->repeats, p, why))
        packing_check(p, why);
end:
    free(row);
    return why->status;
}

static int read_foreign(struct frame_read *r, struct frame *f, struct why *why)
{
    struct source *source = r->source;
    if (fclib_read(&f->problem, source, why)) return why->status;
    f->foreign = true;
    struct delassus *W = &f->problem.W;
    if (fclib_load_solution(&f->problem, source, W->r, why)) return why->status;
    if (source_has(source, "/solution/u")) {
        uint64_t n = (uint64_t)(W->d * W->n);
        f->u = calloc(n + 1, sizeof *f->u);
        if (!f->u) return why_set(why, EX_SOFTWARE, "no memory for the solution");
        if (source_read(source, "/solution/u", COLUMN_F64, n, f->u, why)) return why->status;
    }
    return report_rows_read(&r->reports, 0, r->frames == 1, &f->report, &f->reported, why);
}

int frame_read_moment(struct frame_read *r, int64_t k, struct frame *f, struct why *why)
{
    f->history = source_text(r->source, "/nsd/history", NULL, why);
    if (why->status) return why->status;
    if (!r->step) return read_foreign(r, f, why);
    if (read_packing(r, k, &f->packing, why)) return why->status;
    f->packed = true;
    if (contact_rows_read(&r->contacts, f, why)) return why->status;
    return report_rows_read(&r->reports, r->step[k], r->frames == 1, &f->report, &f->reported, why);
}
