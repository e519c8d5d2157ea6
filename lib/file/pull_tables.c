#include "file/pull_tables.h"

#include "file/layout.h"

#define FORCE_HOME "/nsd/force"

int pull_tables_read(struct source *s, struct packing *p, struct failure *failure)
{
    uint64_t n[4], m[4];
    if (!source_has(s, FORCE_HOME)) return 0;
    if (source_shape(s, FORCE_HOME "/id", n) != 1 || source_shape(s, FORCE_HOME "/row", m) != 2 ||
        n[0] > 1 << 24 || m[0] > 1 << 24)
        return failure_set(failure, EX_DATAERR, FORCE_HOME ": not a table of forces");
    if (drives_alloc(&p->pulls, (int32_t)n[0], (int32_t)m[0], failure) ||
        table_read_columns(s, FORCE_HOME, "", 0, RECORDS(layout_pull, p->pulls.n, p->pulls.drive), failure) ||
        source_rows(s, FORCE_HOME "/row", (struct slab){ COLUMN_F64, 0, p->pulls.rows, 2 }, p->pulls.row,
                    failure))
        return failure->status;
    return source_attribute(s, FORCE_HOME, "acceleration",
                            (struct numbers){ COLUMN_F64, -1, &p->pulls_most }, failure);
}

int pull_tables_write(struct table_write *t, const struct packing *p, struct failure *failure)
{
    const hsize_t shape[2] = { (hsize_t)p->pulls.rows, 2 };
    const bool growing = t->growing;
    if (!p->pulls.n) return 0;
    t->growing = false;
    if (!table_write_columns(t, FORCE_HOME, "", RECORDS(layout_pull, p->pulls.n, p->pulls.drive), 0,
                             failure) &&
        !h5_write(t->file, FORCE_HOME "/row", h5_array(H5T_NATIVE_DOUBLE, 2, shape, p->pulls.row),
                  "s; N, N m", failure))
        h5_attr(t->file, FORCE_HOME, "acceleration", h5_scalar(H5T_NATIVE_DOUBLE, &p->pulls_most), failure);
    t->growing = growing;
    return failure->status;
}
