#include "file/memory_rows.h"

#include "file/h5.h"

#include <stdlib.h>

static const char group[] = "/nsd/memory";

/* Has a row of this packing a feature? */
static bool features(const struct packing *p)
{
    return p->mesh.elements || p->shape;
}

int memory_rows_open(struct memory_rows *r, struct source *source, struct failure *failure)
{
    int64_t n, m;
    uint64_t shape[4];
    *r = (struct memory_rows){ .source = source };
    if (!source_has(source, group)) return 0;
    r->step = table_read_steps(source, "/nsd/memory/step", &r->blocks, failure);
    if (failure->status) return failure->status;
    n = source_shape(source, "/nsd/memory/start", shape) == 1 ? (int64_t)shape[0] : 0;
    m = source_shape(source, "/nsd/memory/count", shape) == 1 ? (int64_t)shape[0] : 0;
    if (r->blocks > n) r->blocks = n; // a killed writer may have extended only some columns
    if (r->blocks > m) r->blocks = m;
    r->blocks = table_read_rising(r->step, r->blocks);
    return 0;
}

int memory_rows_read(struct memory_rows *r, struct packing *p, struct failure *failure)
{
    int64_t at = table_read_row(r->step, r->blocks, p->step);
    struct span span = { 0, 0 };
    // before its first contact a document has no rows
    bool any = source_has(r->source, "/nsd/memory/body");
    if (at < 0) return 0;
    if (any && table_read_span(r->source, (struct table_spans){ group, "body", 2 }, at, &span, failure))
        return failure->status;
    const int64_t start = span.start, count = span.count;
    struct memory *m = &p->memory;
    m->recall = calloc((size_t)count + 1, sizeof *m->recall);
    if (!m->recall) return failure_set(failure, EX_SOFTWARE, "no memory for the last reactions");
    m->on = true, m->n = count, m->room = count + 1;
    if (!any) return 0;
    struct source *s = r->source;
    if (table_read_columns(s, group, "", start, RECORDS(layout_memory, count, m->recall), failure) ||
        (features(p) &&
         table_read_columns(s, group, "", start, RECORDS(layout_memory_features, count, m->recall),
                            failure)) ||
        (cell_repeats(&p->cell) &&
         table_read_columns(s, group, "", start, RECORDS(layout_memory_shifts, count, m->recall),
                            failure)) ||
        (packing_rolls(p) &&
         table_read_columns(s, group, "", start, RECORDS(layout_memory_moments, count, m->recall),
                            failure)))
        return failure->status;
    return memory_check(m, p->n, p->walls, failure);
}

void memory_rows_close(struct memory_rows *r)
{
    free(r->step);
    *r = (struct memory_rows){ 0 };
}

/* ---- to a document ---- */

int memory_rows_write(struct table_write *s, const struct packing *p, struct failure *failure)
{
    const struct memory *m = &p->memory;
    if (!m->on) return 0;
    if (table_write_span(s, "/nsd/memory", s->memory, m->n, failure) ||
        table_write_columns(s, group, "", RECORDS(layout_memory, m->n, m->recall), CHUNK_CONTACTS,
                            failure) ||
        (features(p) &&
         table_write_columns(s, group, "", RECORDS(layout_memory_features, m->n, m->recall),
                             CHUNK_CONTACTS, failure)) ||
        (cell_repeats(&p->cell) &&
         table_write_columns(s, group, "", RECORDS(layout_memory_shifts, m->n, m->recall),
                             CHUNK_CONTACTS, failure)) ||
        (packing_rolls(p) &&
         table_write_columns(s, group, "", RECORDS(layout_memory_moments, m->n, m->recall),
                             CHUNK_CONTACTS, failure)) ||
        table_write_number(s, "/nsd/memory/step", COLUMN_I64, &p->step, NULL, failure))
        return failure->status;
    if (s->growing) s->memory += m->n;
    return 0;
}
