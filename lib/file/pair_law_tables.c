#include "file/pair_law_tables.h"

#include "file/h5.h"
#include "file/tables.h"

#include <stdio.h>
#include <stdlib.h>

static const char law[] = "/nsd/law", bonds[] = "/nsd/bonds";

/* ---- from a document ---- */

/* Both halves of a table say the same. */
static int check_symmetric(const struct packing *p, const struct field *c, const double *table,
                           struct failure *failure)
{
    for (int32_t a = 0; a < p->materials; a++)
        for (int32_t b = 0; b < a; b++)
            if (!(table[a * p->materials + b] == table[b * p->materials + a]))
                return failure_set(failure, EX_DATAERR, "%s/%s: %s and %s have two values", law,
                                   c->name, p->material_name[b], p->material_name[a]);
    return 0;
}

static int pair_law_tables_read_laws(struct source *s, struct packing *p, struct failure *failure)
{
    int64_t n = (int64_t)p->materials * p->materials;
    if (packing_alloc_laws(p, failure)) return failure->status;
    double *table = malloc((size_t)n * sizeof *table + 1);
    if (!table) return failure_set(failure, EX_SOFTWARE, "no memory for the laws");
    for (const struct field *c = law_fields; !failure->status && c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "%s/%s", law, c->name);
        if (c->traits & FIELD_OPTIONAL && !source_has(s, path)) continue;
        if (source_read(s, path, COLUMN_F64, (uint64_t)n, table, failure) ||
            check_symmetric(p, c, table, failure))
            break;
        field_scatter(c, n, table, p->law, sizeof *p->law);
    }
    free(table);
    return failure->status;
}

static int read_bonds(struct source *s, int64_t k, struct packing *p, struct failure *failure)
{
    struct bonds *b = &p->bonds;
    return table_read_list(s, (struct table_spans){ bonds, "body", 2 }, k,
                           (struct list_of){ &b->bond, &b->n, &b->room },
                           RECORDS(bond_fields, 0, b->bond), failure);
}

int pair_law_tables_read(struct source *s, int64_t k, struct packing *p, struct failure *failure)
{
    if (!source_has(s, law)) return 0;
    if (pair_law_tables_read_laws(s, p, failure)) return failure->status;
    return source_has(s, bonds) ? read_bonds(s, k, p, failure) : 0;
}

/* ---- to a document ---- */

int pair_law_tables_write_static(hid_t file, const struct packing *p, struct failure *failure)
{
    const struct records laws = RECORDS(law_fields, (int64_t)p->materials * p->materials, p->law);
    const hsize_t square[2] = { (hsize_t)p->materials, (hsize_t)p->materials };
    if (!p->law) return 0;
    double *table = malloc((size_t)laws.n * sizeof *table + 1);
    if (!table) return failure_set(failure, EX_SOFTWARE, "no memory for the laws");
    for (const struct field *c = law_fields; !failure->status && c->name; c++) {
        char path[80];
        if (!field_is_kept(c, &laws)) continue;
        snprintf(path, sizeof path, "%s/%s", law, c->name);
        field_gather(c, laws.n, p->law, sizeof *p->law, table);
        h5_write(file, path, h5_array(H5T_NATIVE_DOUBLE, 2, square, table), c->units, failure);
    }
    free(table);
    return failure->status;
}

int pair_law_tables_write(struct table_write *s, const struct packing *p, struct failure *failure)
{
    const struct records rows = RECORDS_OF(p, bond_fields, p->bonds.n, p->bonds.bond);
    return p->law ? table_write_list(s, bonds, &s->bonds, rows, failure) : 0;
}
