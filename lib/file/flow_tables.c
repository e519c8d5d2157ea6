#include "file/flow_tables.h"

#include "file/h5.h"
#include "file/table_read.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char flow[] = "/nsd/flow", events[] = "/nsd/flow/events";

/* A column of n passages, as one frame */
static int write_passages(struct table_write *s, const struct column *c, int32_t n,
                          const struct flow_count *from, struct failure *failure)
{
    for (; c->name && n > 0; c++) {
        char path[80];
        int64_t data[1000]; // as wide as a double; at most 1000 of each (scene_flow.c)
        snprintf(path, sizeof path, "%s/%s/value", flow, c->name);
        column_gather(c, n, from, sizeof *from, data);
        const hsize_t shape[2] = { 1, (hsize_t)n };
        if (table_write_rows(
                s, (struct dataset){ path, c->type, 2, shape, CHUNK_FRAMES, data, c->units }, failure))
            return failure->status;
    }
    return 0;
}

#define NUMBERS "/nsd/flow/numbers"

/* Frames after bodies were added by another program than the scene's pours, which are numbered after them */
static int write_numbers(struct table_write *s, const struct packing *p, struct failure *failure)
{
    if (p->first_id == s->first_id) return 0;
    if (table_write_number(s, NUMBERS "/step", COLUMN_I64, &p->step, NULL, failure)) return failure->status;
    return table_write_number(s, NUMBERS "/first_id", COLUMN_I32, &p->first_id, NULL, failure);
}

int flow_write(struct table_write *s, const struct packing *p, struct failure *failure)
{
    if (!packing_varies(p)) return 0;
    bool first = !table_write_grows(s, "/nsd/flow/events/id");
    if (write_passages(s, layout_poured, p->pours, p->poured, failure) ||
        write_passages(s, layout_removed, p->removals, p->removed, failure) ||
        table_write_span(s, "/nsd/flow/events", s->events, p->events.n, failure) ||
        table_write_columns(s, events, "", RECORDS(layout_events, p->events.n, p->events.e),
                            CHUNK_CONTACTS, failure))
        return failure->status;
    if (s->growing) s->events += p->events.n;
    if (!first) return write_numbers(s, p, failure);
    s->first_id = p->first_id;
    return h5_attr(s->file, flow, "first_id", h5_scalar(H5T_NATIVE_INT32, &p->first_id), failure);
}

/* The clock of the particles, for columns in a group */
static int link_clocks(struct table_write *s, const char *where, const struct column *c,
                       struct failure *failure)
{
    return table_write_link(s, "/particles/all/position/step", "step", where, c, failure) ||
                   table_write_link(s, "/particles/all/position/time", "time", where, c, failure)
               ? failure->status
               : 0;
}

int flow_link(struct table_write *s, const struct packing *p, struct failure *failure)
{
    static const struct column ids[] = { { .name = "id" }, { 0 } };
    if ((p->pours > 0 && link_clocks(s, flow, layout_poured, failure)) ||
        (p->removals > 0 && link_clocks(s, flow, layout_removed, failure)))
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
    return failure_set(failure, EX_DATAERR, "%s: not of shape frames x pours or removals", path), -1;
}

static int read_passages(struct source *s, int64_t k, const struct column *c, int32_t n,
                         struct flow_count *to, struct failure *failure)
{
    for (; c->name && n > 0; c++) {
        char path[80];
        int64_t data[1000];
        snprintf(path, sizeof path, "%s/%s/value", flow, c->name);
        if (source_rows(s, path, (struct slab){ c->type, k, 1, n }, data, failure)) return failure->status;
        column_scatter(c, n, data, to, sizeof *to);
    }
    for (int32_t i = 0; i < n; i++)
        if (to[i].bodies < 0 || !(to[i].mass >= 0 && isfinite(to[i].mass)))
            return failure_set(failure, EX_DATAERR, "%s: a number or mass of bodies is out of range", flow);
    return 0;
}

static int check_event(const struct event *e, struct failure *failure)
{
    bool good = isfinite(e->t) && (e->came == 0 || e->came == 1) && e->which >= 0 &&
                e->radius > 0 && isfinite(e->radius) && e->mass >= 0 && isfinite(e->mass) &&
                v3_finite(e->x) && v3_finite(e->v);
    return good ? 0 : failure_set(failure, EX_DATAERR, "%s: a number is out of range", events);
}

static int read_events(struct source *s, int64_t k, struct packing *p, struct failure *failure)
{
    struct span span;
    if (table_read_span(s, (struct table_spans){ events, "id", 1 }, k, &span, failure))
        return failure->status;
    const int64_t start = span.start, count = span.count;
    if (!(p->events.e = calloc((size_t)count + 1, sizeof *p->events.e)))
        return failure_set(failure, EX_SOFTWARE, "no memory for events");
    p->events.n = count, p->events.room = count + 1;
    if (table_read_columns(s, events, "", start, RECORDS(layout_events, count, p->events.e), failure))
        return failure->status;
    for (int64_t i = 0; i < count; i++)
        if (check_event(&p->events.e[i], failure)) return failure->status;
    return 0;
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
        read_passages(s, k, layout_poured, pours, p->poured, failure) ||
        read_passages(s, k, layout_removed, removals, p->removed, failure))
        return failure->status;
    if (p->first_id < 0) return failure_set(failure, EX_DATAERR, "%s@first_id: is negative", flow);
    return read_events(s, k, p, failure);
}
