#include "file/cell_tables.h"

#include "file/h5.h"
#include "state/fields.h"

#include <stdlib.h>
#include <string.h>

int cell_tables_open(struct source *source, bool repeats[3], struct failure *failure)
{
    const char *box = "/particles/all/box";
    char boundary[3][16];
    bool there = source_texts(source, box, "boundary", 3, boundary, failure);
    if (failure->status) return failure->status;
    bool edges = source_has(source, "/particles/all/box/edges");
    for (int k = 0; there && k < 3; k++) {
        repeats[k] = !strcmp(boundary[k], "periodic");
        if (!repeats[k] && strcmp(boundary[k], "none") != 0)
            return failure_set(failure, EX_DATAERR,
                               "%s@boundary: '%s' is neither periodic nor none", box, boundary[k]);
        if (repeats[k] && !edges)
            return failure_set(failure, EX_DATAERR, "%s: periodic without edges", box);
    }
    if (!there && edges)
        return failure_set(failure, EX_DATAERR, "%s@boundary: not three strings of fixed length",
                           box);
    return 0;
}

/* Edges, constant or of frame k: three lengths, or three vectors */
static int cell_tables_read_edges(struct source *source, int64_t k, struct cell *c,
                                  struct failure *failure)
{
    const char *moving = "/particles/all/box/edges/value", *still = "/particles/all/box/edges";
    uint64_t shape[4];
    double edge[9];
    if (source_has(source, moving)) {
        int rank = source_shape(source, moving, shape);
        if (rank != 2 && rank != 3)
            return failure_set(failure, EX_DATAERR, "%s: not of shape frames x 3 (x 3)", moving);
        if (source_rows(source, moving, (struct slab){ COLUMN_F64, k, 1, rank == 2 ? 3 : 9 }, edge,
                        failure))
            return failure->status;
        shape[0] = rank == 2 ? 3 : 9;
    } else {
        int rank = source_shape(source, still, shape);
        if (rank == 2) shape[0] *= shape[1];
        if ((rank != 1 && rank != 2) || shape[0] != (rank == 1 ? 3 : 9))
            return failure_set(failure, EX_DATAERR, "%s: not of shape 3 (x 3)", still);
        if (source_read(source, still, COLUMN_F64, shape[0], edge, failure)) return failure->status;
    }
    for (int i = 0; i < 3; i++)
        c->edge[i] = shape[0] == 9
                         ? v3(edge[3 * i], edge[3 * i + 1], edge[3 * i + 2])
                         : v3(i == 0 ? edge[0] : 0, i == 1 ? edge[1] : 0, i == 2 ? edge[2] : 0);
    return 0;
}

/* Rows of a table whose first field is `one`, into a new array. Returns 0, EX_DATAERR or EX_SOFTWARE. */
static int cell_tables_read_rows(struct source *doc, const char *one, void *array, int32_t *n,
                                 struct records rows, struct failure *failure)
{
    uint64_t shape[4];
    if (source_shape(doc, one, shape) != (rows.fields->width == 1 ? 1 : 2) || shape[0] >= 1 << 24)
        return failure_set(failure, EX_DATAERR, "%s: not of shape moments x %d", one,
                           rows.fields->width);
    if (!(rows.structs = calloc(shape[0] + 1, rows.stride)))
        return failure_set(failure, EX_SOFTWARE, "no memory for the moments of the cell");
    memcpy(array, &rows.structs, sizeof rows.structs);
    rows.n = *n = (int32_t)shape[0];
    return table_read_columns(doc, "/nsd/cell", "", 0, rows, failure);
}

/* What moves the edges, and what they and the size yield to; the factors of loads in time, where there are any */
static int cell_tables_read_drive(struct source *doc, struct cell *c, struct failure *failure)
{
    const char *size = "/nsd/cell/size_mass", *factor = "/nsd/cell/factor";
    if (source_has(doc, "/nsd/cell") &&
        (cell_tables_read_rows(doc, "/nsd/cell/time", &c->gradient, &c->gradients,
                               RECORDS(gradient_fields, 0, c->gradient), failure) ||
         source_read(doc, "/nsd/cell/mass", COLUMN_F64, 9, c->mass, failure) ||
         source_read(doc, "/nsd/cell/stress", COLUMN_F64, 9, c->stress, failure)))
        return failure->status;
    if (source_has(doc, size) &&
        (source_read(doc, size, COLUMN_F64, 1, &c->size_mass, failure) ||
         source_read(doc, "/nsd/cell/mean", COLUMN_F64, 1, &c->mean, failure)))
        return failure->status;
    return source_has(doc, factor)
               ? cell_tables_read_rows(doc, factor, &c->factor, &c->factors,
                                       RECORDS(factor_fields, 0, c->factor), failure)
               : 0;
}

int cell_tables_read(struct source *source, int64_t k, const bool repeats[3], struct packing *p,
                     struct failure *failure)
{
    const char *origin = "/particles/all/box/origin", *rate = "/particles/all/box/rate/value";
    struct cell *c = &p->cell;
    memcpy(c->repeats, repeats, sizeof c->repeats);
    if (!cell_repeats(c)) return 0;
    if (cell_tables_read_edges(source, k, c, failure) ||
        cell_tables_read_drive(source, c, failure) || packing_alloc_images(p, failure) ||
        (source_has(source, origin) &&
         source_read(source, origin, COLUMN_F64, 3, &c->origin, failure)))
        return failure->status;
    cell_set_rate(c, p->t);
    return source_has(source, rate)
               ? source_rows(source, rate, (struct slab){ COLUMN_F64, k, 1, 9 }, c->rate, failure)
               : 0;
}

/* ---- to a document ---- */

/* What moves the cell's edges, and what they and its size yield to */
static int write_drive(hid_t file, const struct cell *c, struct failure *failure)
{
    struct table_write w = { .file = file };
    const hsize_t square[2] = { 3, 3 };
    if (table_write_once(&w, "/nsd/cell", RECORDS(gradient_fields, c->gradients, c->gradient),
                         failure) ||
        h5_write(file, "/nsd/cell/mass", h5_array(H5T_NATIVE_DOUBLE, 2, square, c->mass), "kg",
                 failure) ||
        h5_write(file, "/nsd/cell/stress", h5_array(H5T_NATIVE_DOUBLE, 2, square, c->stress), "Pa",
                 failure) ||
        (c->size_mass > 0 &&
         (h5_write(file, "/nsd/cell/size_mass", h5_vector(H5T_NATIVE_DOUBLE, 1, &c->size_mass),
                   "kg m2", failure) ||
          h5_write(file, "/nsd/cell/mean", h5_vector(H5T_NATIVE_DOUBLE, 1, &c->mean), "Pa",
                   failure))))
        return failure->status;
    return c->factors ? table_write_once(&w, "/nsd/cell",
                                         RECORDS(factor_fields, c->factors, c->factor), failure)
                      : 0;
}

int cell_tables_write_box(hid_t file, const struct cell *c, struct failure *failure)
{
    const int dimension = 3; // positions have three components in the plane too
    const char none[3][5] = { "none", "none", "none" };
    const char *box = "/particles/all/box";
    if (h5_group(file, box, failure) ||
        h5_attr(file, box, "dimension", h5_scalar(H5T_NATIVE_INT, &dimension), failure))
        return failure->status;
    char boundary[3][9] = { "none", "none", "none" };
    for (int k = 0; k < 3; k++)
        if (c->repeats[k]) memcpy(boundary[k], "periodic", sizeof boundary[k]);
    bool repeats = cell_repeats(c);
    hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, repeats ? sizeof boundary[0] : sizeof none[0]);
    int e =
        h5_attr(file, box, "boundary",
                h5_vector(text, 3, repeats ? (const void *)boundary : (const void *)none), failure);
    H5Tclose(text);
    if (e || !repeats) return e;
    return h5_write(file, "/particles/all/box/origin", h5_vector(H5T_NATIVE_DOUBLE, 3, &c->origin),
                    "m", failure) ||
                   write_drive(file, c, failure)
               ? failure->status
               : 0;
}

int cell_tables_write(struct table_write *s, const struct packing *p, struct failure *failure)
{
    for (const struct field *c = box_fields; cell_repeats(&p->cell) && c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s/value", c->name);
        const hsize_t shape[3] = { 1, 3, 3 };
        if (table_write_rows(s,
                             (struct dataset){ path, c->type, 3, shape, CHUNK_FRAMES,
                                               (const char *)&p->cell + c->offset, c->units },
                             failure))
            return failure->status;
    }
    return 0;
}
