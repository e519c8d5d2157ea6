#include "file/pair_law_tables.h"

#include "file/h5.h"
#include "file/tables.h"

#include <stdio.h>
#include <stdlib.h>

static const char law[] = "/nsd/law", bonds[] = "/nsd/bonds";

/* ---- from a document ---- */

/* Both halves of a table say the same. */
static int check_symmetric(const struct packing *p, const struct column *c, const double *table,
                           struct failure *failure)
{
    for (int32_t a = 0; a < p->kinds; a++)
        for (int32_t b = 0; b < a; b++)
            if (!(table[a * p->kinds + b] == table[b * p->kinds + a]))
                return failure_set(failure, EX_DATAERR, "%s/%s: %s and %s have two values", law,
                                   c->name, p->kind_name[b], p->kind_name[a]);
    return 0;
}

static int pair_law_tables_read_columns(struct source *s, const struct column *columns,
                                        struct packing *p, struct failure *failure)
{
    int64_t n = (int64_t)p->kinds * p->kinds;
    double *table = malloc((size_t)n * sizeof *table + 1);
    if (!table) return failure_set(failure, EX_SOFTWARE, "no memory for the laws");
    for (const struct column *c = columns; !failure->status && c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "%s/%s", law, c->name);
        if (source_read(s, path, COLUMN_F64, (uint64_t)n, table, failure) ||
            check_symmetric(p, c, table, failure))
            break;
        column_scatter(c, n, table, p->law, sizeof *p->law);
    }
    free(table);
    return failure->status;
}

static int pair_law_tables_read_laws(struct source *s, struct packing *p, struct failure *failure)
{
    if (packing_alloc_laws(p, failure) || pair_law_tables_read_columns(s, layout_law, p, failure))
        return failure->status;
    if (source_has(s, "/nsd/law/impact") &&
        pair_law_tables_read_columns(s, layout_impact, p, failure))
        return failure->status;
    return source_has(s, "/nsd/law/k_n")
               ? pair_law_tables_read_columns(s, layout_springs, p, failure)
               : 0;
}

static int read_bonds(struct source *s, int64_t k, struct packing *p, struct failure *failure)
{
    struct span span;
    if (table_read_span(s, (struct table_spans){ bonds, "body", 2 }, k, &span, failure))
        return failure->status;
    const int64_t start = span.start, count = span.count;
    p->bonds.bond = calloc((size_t)count + 1, sizeof *p->bonds.bond);
    if (!p->bonds.bond) return failure_set(failure, EX_SOFTWARE, "no memory for the bonds");
    p->bonds.n = count, p->bonds.room = count + 1;
    if (table_read_columns(s, bonds, "", start, RECORDS(layout_bonds, count, p->bonds.bond),
                           failure) ||
        (packing_has_springs(p) &&
         table_read_columns(s, bonds, "", start, RECORDS(layout_pressed, count, p->bonds.bond),
                            failure)) ||
        !source_has(s, "/nsd/bonds/area"))
        return failure->status;
    return table_read_columns(s, bonds, "", start, RECORDS(layout_anchors, count, p->bonds.bond),
                              failure);
}

int pair_law_tables_read(struct source *s, int64_t k, struct packing *p, struct failure *failure)
{
    if (!source_has(s, law)) return 0;
    if (pair_law_tables_read_laws(s, p, failure)) return failure->status;
    return source_has(s, bonds) ? read_bonds(s, k, p, failure) : 0;
}

/* ---- to a document ---- */

static int write_columns(hid_t file, const struct column *columns, const struct packing *p,
                         struct failure *failure)
{
    int64_t n = (int64_t)p->kinds * p->kinds;
    const hsize_t square[2] = { (hsize_t)p->kinds, (hsize_t)p->kinds };
    double *table = malloc((size_t)n * sizeof *table + 1);
    if (!table) return failure_set(failure, EX_SOFTWARE, "no memory for the laws");
    for (const struct column *c = columns; !failure->status && c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "%s/%s", law, c->name);
        column_gather(c, n, p->law, sizeof *p->law, table);
        h5_write(file, path, h5_array(H5T_NATIVE_DOUBLE, 2, square, table), c->units, failure);
    }
    free(table);
    return failure->status;
}

int pair_law_tables_write_static(hid_t file, const struct packing *p, struct failure *failure)
{
    bool impact = false;
    if (!p->law) return 0;
    for (int32_t k = 0; k < p->kinds * p->kinds; k++) impact = impact || p->law[k].impact > 0;
    if (write_columns(file, layout_law, p, failure)) return failure->status;
    if (impact && write_columns(file, layout_impact, p, failure)) return failure->status;
    return packing_has_springs(p) ? write_columns(file, layout_springs, p, failure) : 0;
}

int pair_law_tables_write(struct table_write *s, const struct packing *p, struct failure *failure)
{
    if (!p->law) return 0;
    if (table_write_span(s, "/nsd/bonds", s->bonds, p->bonds.n, failure) ||
        table_write_columns(s, bonds, "", RECORDS(layout_bonds, p->bonds.n, p->bonds.bond),
                            CHUNK_CONTACTS, failure) ||
        (packing_has_springs(p) &&
         table_write_columns(s, bonds, "", RECORDS(layout_pressed, p->bonds.n, p->bonds.bond),
                             CHUNK_CONTACTS, failure)) ||
        (p->shape &&
         table_write_columns(s, bonds, "", RECORDS(layout_anchors, p->bonds.n, p->bonds.bond),
                             CHUNK_CONTACTS, failure)))
        return failure->status;
    if (s->growing) s->bonds += p->bonds.n;
    return 0;
}
