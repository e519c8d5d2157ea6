#include "file/roster.h"

#include "file/h5.h"
#include "file/tables.h"
#include "scene/inlet.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    CHUNKS = 256,              /* of a frame, at most as a rule */
    LEAST_CHUNK = 128,         /* rows */
    UNBOUNDED_LEAST = 1 << 17, /* rows, where nothing bounds a pour, */
    UNBOUNDED_TIMES = 16       /* or as many times the first bodies */
};

/* How many bodies a pour can bring in all; infinite where the scene sets no end to it */
static double roster_most_of(const struct scene_pour *o)
{
    double by_time = o->by_mass ? INFINITY : floor(o->rate * fmax(o->until - o->from, 0)) + 1;
    return fmin(o->count, by_time);
}

void roster_bounds(const struct packing *p, int64_t *most, int64_t *chunk, struct failure *failure)
{
    struct flow flow;
    double bound = (double)p->n;
    *most = *chunk = 0;
    if (flow_read(&flow, p, failure)) return;
    for (int32_t k = 0; k < flow.scene.pours; k++) bound += roster_most_of(&flow.scene.pour[k]);
    flow_free(&flow);
    if (isinf(bound) || p->breakage) bound = fmax(UNBOUNDED_LEAST, UNBOUNDED_TIMES * (double)p->n);
    bound = fmin(fmax(bound, 1), INT32_MAX);
    double rows = fmin(fmax(bound / CHUNKS, LEAST_CHUNK), CHUNK_BODIES);
    *chunk = (int64_t)ceil(rows);
    *most = ((int64_t)bound + *chunk - 1) / *chunk * *chunk;
}

void roster_free(struct roster *r)
{
    free(r->id), free(r->fixed);
    *r = (struct roster){ 0 };
}

static int roster_grow(struct roster *r, struct failure *failure)
{
    if (r->rows < r->room) return 0;
    if (!r->bytes)
        for (const struct field *b = body_columns; b->name; b++)
            r->bytes += b->traits & FIELD_SAME ? field_bytes(b) : 0;
    size_t room = r->room ? 2 * (size_t)r->room : 256;
    int32_t *id = realloc(r->id, room * sizeof *id);
    if (id) r->id = id;
    char *fixed = realloc(r->fixed, room * r->bytes + 1);
    if (fixed) r->fixed = fixed;
    if (!id || !fixed) return failure_set(failure, EX_SOFTWARE, "no memory for the roster");
    r->room = (int64_t)room;
    return 0;
}

/* Keeps the numbers of body i that do not move in a row, or says in which of them it differs from that row: NULL: in none */
static const char *roster_fixed(struct roster *r, const struct packing *p, int64_t i, int64_t row,
                                bool keep)
{
    char *at = r->fixed + (size_t)row * r->bytes;
    for (const struct field *b = body_columns; b->name; b++) {
        const size_t bytes = b->traits & FIELD_SAME ? field_bytes(b) : 0;
        const char none[sizeof(quat)] = { 0 }, *x = field_array(b, p) ? field_row(b, p, i) : none;
        if (keep && bytes) memcpy(at, x, bytes);
        if (memcmp(at, x, bytes) != 0) return b->name;
        at += bytes;
    }
    return NULL;
}

/* The row of body i, at or after `from`: bodies keep their order. New ones get the next. */
static int64_t roster_row_of(struct roster *r, const struct packing *p, int64_t i, int64_t from,
                             struct failure *failure)
{
    while (from < r->rows && r->id[from] != p->id[i]) from++;
    if (from < r->rows) {
        const char *differs = roster_fixed(r, p, i, from, false);
        if (!differs) return from;
        return failure_set(failure, EX_DATAERR,
                           "other bodies than the trajectory's: their %s differs", differs),
               -1;
    }
    if (roster_grow(r, failure)) return -1;
    for (int64_t k = r->rows - 1; k >= 0 && r->id[k] >= p->id[i]; k--)
        if (r->id[k] == p->id[i])
            return failure_set(failure, EX_DATAERR,
                               "bodies in another order than the trajectory's"),
                   -1;
    r->id[r->rows] = p->id[i];
    roster_fixed(r, p, i, r->rows, true);
    return r->rows++;
}

/* Has the column a dataset of [frames][rows]? That of ids says which bodies a frame has. */
static bool roster_moves(const struct field *b)
{
    return b->traits & FIELD_MOVES || b == &body_columns[BODY_id];
}

/* The tables of bodies go on with those from `first` on, the last ones of the packing. */
static int write_new(struct table_write *s, const struct packing *p, int64_t first,
                     struct failure *failure)
{
    const hsize_t n = (hsize_t)(p->n - first);
    for (const struct field *b = body_columns; b->name; b++) {
        const struct field *c = b;
        const hsize_t shape[2] = { n, (hsize_t)c->width };
        char path[80];
        if (roster_moves(b) || !field_array(c, p)) continue;
        layout_body_path(b, path);
        if (table_write_rows(s,
                             (struct dataset){ path, c->type, c->width == 1 ? 1 : 2, shape,
                                               s->chunk_bodies, field_row(c, p, first), c->units },
                             failure))
            return failure->status;
    }
    return 0;
}

int roster_enter(struct roster *r, struct table_write *s, const struct packing *p, int64_t **row,
                 struct failure *failure)
{
    int64_t had = r->rows, first = p->n, at = 0;
    *row = malloc(((size_t)p->n + 1) * sizeof **row);
    if (!*row) return failure_set(failure, EX_SOFTWARE, "no memory for the roster");
    for (int64_t i = 0; i < p->n; i++) {
        (*row)[i] = roster_row_of(r, p, i, at, failure);
        if (failure->status) return failure->status;
        if ((*row)[i] >= had && first == p->n) first = i;
        at = (*row)[i] + 1;
    }
    if (r->rows > (int64_t)s->most_bodies)
        return failure_set(
            failure, EX_DATAERR,
            p->breakage ? "the trajectory has rows for %lld bodies, and more were broken or "
                          "poured: begin a new trajectory"
                        : "the trajectory has rows for %lld bodies, and more were poured: give the "
                          "pour a count, or "
                          "begin a new trajectory",
            (long long)s->most_bodies);
    int64_t chunk = (int64_t)s->chunk_bodies;
    while (r->width < r->rows || !r->width) r->width += chunk;
    if (first < p->n || !had) return write_new(s, p, first, failure);
    return 0;
}

static void moving_path(const struct field *b, char path[80])
{
    snprintf(path, 80, "/particles/all/%s/value", b->name);
}

/* A column of bodies that move, of body i in row[i] */
static int write_spread(struct roster *r, struct table_write *s, const struct field *b,
                        const struct packing *p, const int64_t *row, struct failure *failure)
{
    const struct field *c = b;
    const char *data = field_array(c, p);
    char path[80];
    moving_path(b, path);
    size_t number = field_size(c->type), bytes = field_bytes(c);
    char *all = malloc((size_t)r->width * bytes);
    if (!all) return failure_set(failure, EX_SOFTWARE, "no memory for %s", path);
    const double none = NAN;
    const int32_t nobody = -1;
    const void *empty = c->type == COLUMN_F64 ? (const void *)&none : (const void *)&nobody;
    for (size_t k = 0; k < (size_t)r->width * (size_t)c->width; k++)
        memcpy(all + k * number, empty, number);
    for (int64_t i = 0; i < p->n; i++)
        memcpy(all + (size_t)row[i] * bytes, data + (size_t)i * bytes, bytes);
    const hsize_t shape[3] = { 1, (hsize_t)r->width, (hsize_t)c->width };
    int e = table_write_rows(
        s, (struct dataset){ path, c->type, c->width == 1 ? 2 : 3, shape, 1, all, c->units },
        failure);
    free(all);
    return e;
}

int roster_write(struct roster *r, struct table_write *s, const struct packing *p,
                 const int64_t *row, struct failure *failure)
{
    for (const struct field *b = body_columns; b->name; b++) {
        if (!roster_moves(b) || !field_array(b, p)) continue;
        if (write_spread(r, s, b, p, row, failure)) return failure->status;
    }
    return 0;
}

/* ---- from a document ---- */

int roster_find(struct source *source, int64_t k, int64_t **row, int64_t *n,
                struct failure *failure)
{
    uint64_t shape[4];
    const char *ids = "/particles/all/id/value";
    *row = NULL;
    if (source_shape(source, "/particles/all/radius", shape) != 1 || shape[0] > INT32_MAX)
        return failure_set(failure, EX_DATAERR, "/particles/all/radius: not a list of numbers");
    *n = (int64_t)shape[0];
    if (!source_has(source, ids)) return 0;
    if (source_shape(source, ids, shape) != 2 || shape[1] > INT32_MAX)
        return failure_set(failure, EX_DATAERR, "%s: not of shape frames x bodies", ids);
    int64_t rows = (int64_t)shape[1];
    int32_t *id = malloc(((size_t)rows + 1) * sizeof *id);
    *row = calloc((size_t)rows + 1, sizeof **row);
    *n = 0;
    if (!id || !*row) {
        free(id);
        return failure_set(failure, EX_SOFTWARE, "no memory for %lld bodies", (long long)rows);
    }
    if (!source_rows(source, ids, (struct slab){ COLUMN_I32, k, 1, rows }, id, failure))
        for (int64_t i = 0; i < rows; i++)
            if (id[i] >= 0) (*row)[(*n)++] = i;
    free(id);
    return failure->status;
}

/* A column of p's bodies, of body i from row[i]: of frame k, or of a table that all frames share */
static int read_spread(struct source *s, int64_t k, const int64_t *row, const struct field *b,
                       struct packing *p, struct failure *failure)
{
    const struct field *c = b;
    const int64_t n = p->n;
    char path[80], *out = field_array(c, p);
    if (roster_moves(b))
        moving_path(b, path);
    else
        layout_body_path(b, path);
    if (b->traits & FIELD_OPTIONAL && !source_has(s, path)) return 0;
    uint64_t shape[4];
    int rank = source_shape(s, path, shape);
    const bool moving = roster_moves(b);
    if (rank < 1 + moving)
        return failure_set(failure, EX_DATAERR, "%s: no dataset of bodies", path);
    int64_t rows = (int64_t)shape[moving], most = n ? row[n - 1] + 1 : 0; // rows ascend
    if (rows < most || rows > INT32_MAX)
        return failure_set(failure, EX_DATAERR, "%s: fewer rows than bodies", path);
    size_t bytes = (size_t)c->width * field_size(c->type);
    char *all = malloc((size_t)rows * bytes + 1);
    if (!all) return failure_set(failure, EX_SOFTWARE, "%s: no memory", path);
    int e =
        moving ? source_rows(s, path, (struct slab){ c->type, k, 1, rows * c->width }, all, failure)
               : source_rows(s, path, (struct slab){ c->type, 0, rows, c->width }, all, failure);
    for (int64_t i = 0; !e && i < n; i++)
        memcpy(out + (size_t)i * bytes, all + (size_t)row[i] * bytes, bytes);
    free(all);
    return e;
}

int roster_read(struct source *source, int64_t k, const int64_t *row, struct packing *p,
                struct failure *failure)
{
    for (const struct field *b = body_columns; b->name; b++) {
        if (field_array(b, p) && read_spread(source, k, row, b, p, failure)) return failure->status;
    }
    return 0;
}

static const char flow[] = "/nsd/flow", events[] = "/nsd/flow/events";

#define NUMBERS "/nsd/flow/numbers"

/* Frames after bodies were added by another program than the scene's pours, which are numbered after them */
static int write_numbers(struct table_write *s, const struct packing *p, struct failure *failure)
{
    if (p->first_id == s->first_id) return 0;
    if (table_write_number(s, NUMBERS "/step", COLUMN_I64, &p->step, NULL, failure))
        return failure->status;
    return table_write_number(s, NUMBERS "/first_id", COLUMN_I32, &p->first_id, NULL, failure);
}

int flow_write(struct table_write *s, const struct packing *p, struct failure *failure)
{
    if (!packing_varies(p)) return 0;
    bool first = !table_write_grows(s, "/nsd/flow/events/id");
    if ((p->pours && table_write_frame(s, flow, RECORDS(poured_fields, p->pours, p->poured),
                                       CHUNK_FRAMES, failure)) ||
        (p->removals && table_write_frame(s, flow, RECORDS(removed_fields, p->removals, p->removed),
                                          CHUNK_FRAMES, failure)) ||
        table_write_list(s, events, &s->events, RECORDS(event_fields, p->events.n, p->events.e),
                         failure))
        return failure->status;
    if (!first) return write_numbers(s, p, failure);
    s->first_id = p->first_id;
    return h5_attr(s->file, flow, "first_id", h5_scalar(H5T_NATIVE_INT32, &p->first_id), failure);
}

/* The clock of the particles, for columns in a group */
static int link_clocks(struct table_write *s, const char *where, const struct field *c,
                       struct failure *failure)
{
    return table_write_link(s, "/particles/all/position/step", "step", where, c, failure) ||
                   table_write_link(s, "/particles/all/position/time", "time", where, c, failure)
               ? failure->status
               : 0;
}

int flow_link(struct table_write *s, const struct packing *p, struct failure *failure)
{
    static const struct field ids[] = { { .name = "id" }, { 0 } };
    if ((p->pours > 0 && link_clocks(s, flow, poured_fields, failure)) ||
        (p->removals > 0 && link_clocks(s, flow, removed_fields, failure)))
        return failure->status;
    return s->roster ? link_clocks(s, "/particles/all", ids, failure) : 0;
}

/* ---- reading ---- */

/* How many pours, or removals, there are: the width of their datasets; -1: not as it should be */
static int32_t roster_count_of(struct source *s, const char *path, struct failure *failure)
{
    uint64_t shape[4];
    int rank = source_shape(s, path, shape);
    if (rank < 0 && !source_has(s, path)) return 0;
    if (rank == 2 && shape[1] <= 1000) return (int32_t)shape[1];
    return failure_set(failure, EX_DATAERR, "%s: not of shape frames x pours or removals", path),
           -1;
}

static int read_passages(struct source *s, int64_t k, const struct field *fields, int32_t n,
                         struct flow_count *to, struct failure *failure)
{
    if (n && table_read_frame(s, flow, k, RECORDS(fields, n, to), failure)) return failure->status;
    return records_check(RECORDS(fields, n, to), flow, failure);
}

static int read_events(struct source *s, int64_t k, struct packing *p, struct failure *failure)
{
    if (table_read_list(s, (struct table_spans){ events, "id", 1 }, k,
                        (struct list_of){ &p->events.e, &p->events.n, &p->events.room },
                        RECORDS(event_fields, 0, p->events.e), failure))
        return failure->status;
    return records_check(RECORDS(event_fields, p->events.n, p->events.e), "event", failure);
}

int flow_tables_read_numbers(struct source *s, struct packing *p, struct failure *failure)
{
    if (!packing_varies(p)) return 0;
    int64_t row = table_read_row_at(s, NUMBERS "/step", p->step, failure);
    if (failure->status || row < 0) return failure->status;
    if (source_rows(s, NUMBERS "/first_id", (struct slab){ COLUMN_I32, row, 1, 1 }, &p->first_id,
                    failure))
        return failure->status;
    return p->first_id < 0 ? failure_set(failure, EX_DATAERR, NUMBERS "/first_id: is negative") : 0;
}

int flow_tables_read(struct source *s, int64_t k, struct packing *p, struct failure *failure)
{
    if (!source_has(s, flow)) return 0;
    int32_t pours = roster_count_of(s, "/nsd/flow/poured/value", failure);
    int32_t removals = pours < 0 ? -1 : roster_count_of(s, "/nsd/flow/removed/value", failure);
    if (removals < 0 || packing_alloc_passages(p, pours, removals, failure)) return failure->status;
    if (source_attribute(s, flow, "first_id", (struct numbers){ COLUMN_I32, -1, &p->first_id },
                         failure) ||
        read_passages(s, k, poured_fields, pours, p->poured, failure) ||
        read_passages(s, k, removed_fields, removals, p->removed, failure))
        return failure->status;
    if (p->first_id < 0) return failure_set(failure, EX_DATAERR, "%s@first_id: is negative", flow);
    return read_events(s, k, p, failure);
}
