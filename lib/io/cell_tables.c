#include "io/cell_tables.h"

#include "hdf5/h5.h"

#include <stdlib.h>
#include <string.h>

int cell_tables_open(struct source *source, bool repeats[3], struct why *why)
{
    const char *box = "/particles/all/box";
    char boundary[3][16];
    bool there = source_texts(source, box, "boundary", 3, boundary, why);
    if (why->status) return why->status;
    bool edges = source_has(source, "/particles/all/box/edges");
    for (int k = 0; there && k < 3; k++) {
        repeats[k] = !strcmp(boundary[k], "periodic");
        if (!repeats[k] && strcmp(boundary[k], "none") != 0)
            return why_set(why, EX_DATAERR, "%s@boundary: '%s' is neither periodic nor none", box,
                           boundary[k]);
        if (repeats[k] && !edges)
            return why_set(why, EX_DATAERR, "%s: periodic without edges", box);
    }
    if (!there && edges)
        return why_set(why, EX_DATAERR, "%s@boundary: not three strings of fixed length", box);
    return 0;
}

/* Edges, constant or of frame k: three lengths, or three vectors */
static int cell_tables_read_edges(struct source *source, int64_t k, struct cell *c, struct why *why)
{
    const char *moving = "/particles/all/box/edges/value", *still = "/particles/all/box/edges";
    uint64_t shape[4];
    double edge[9];
    if (source_has(source, moving)) {
        int rank = source_shape(source, moving, shape);
        if (rank != 2 && rank != 3)
            return why_set(why, EX_DATAERR, "%s: not of shape frames x 3 (x 3)", moving);
        if (source_rows(source, moving, (struct slab){ COLUMN_F64, k, 1, rank == 2 ? 3 : 9 }, edge,
                        why))
            return why->status;
        shape[0] = rank == 2 ? 3 : 9;
    } else {
        int rank = source_shape(source, still, shape);
        if (rank == 2) shape[0] *= shape[1];
        if ((rank != 1 && rank != 2) || shape[0] != (rank == 1 ? 3 : 9))
            return why_set(why, EX_DATAERR, "%s: not of shape 3 (x 3)", still);
        if (source_read(source, still, COLUMN_F64, shape[0], edge, why)) return why->status;
    }
    for (int i = 0; i < 3; i++)
        c->edge[i] = shape[0] == 9
                         ? v3(edge[3 * i], edge[3 * i + 1], edge[3 * i + 2])
                         : v3(i == 0 ? edge[0] : 0, i == 1 ? edge[1] : 0, i == 2 ? edge[2] : 0);
    return 0;
}

/* What moves the edges, and what they yield to */
static int cell_tables_read_drive(struct source *doc, struct cell *c, struct why *why)
{
    uint64_t n = 0;
    if (!source_has(doc, "/nsd/cell")) return 0;
    double *t = source_read_all(doc, "/nsd/cell/time", COLUMN_F64, &n, why);
    double *L = t && n < 1 << 24 ? calloc(9 * n + 1, sizeof *L) : NULL;
    c->gradient = L ? calloc(n + 1, sizeof *c->gradient) : NULL;
    if (t && !c->gradient) why_set(why, EX_SOFTWARE, "no memory for the cell's gradient");
    if (c->gradient && !source_read(doc, "/nsd/cell/gradient", COLUMN_F64, 9 * n, L, why))
        for (c->gradients = 0; c->gradients < (int32_t)n; c->gradients++) {
            struct cell_gradient *g = &c->gradient[c->gradients];
            g->t = t[c->gradients];
            memcpy(g->L, L + 9 * (size_t)c->gradients, sizeof g->L);
        }
    free(t), free(L);
    if (why->status) return why->status;
    return source_read(doc, "/nsd/cell/mass", COLUMN_F64, 9, c->mass, why) ||
                   source_read(doc, "/nsd/cell/stress", COLUMN_F64, 9, c->stress, why)
               ? why->status
               : 0;
}

/* What its size yields to, and the factors of loads in time, where there are any */
static int read_size(struct source *doc, struct cell *c, struct why *why)
{
    const char *factor = "/nsd/cell/factor";
    uint64_t shape[4];
    if (source_has(doc, "/nsd/cell/size_mass") &&
        (source_read(doc, "/nsd/cell/size_mass", COLUMN_F64, 1, &c->size_mass, why) ||
         source_read(doc, "/nsd/cell/mean", COLUMN_F64, 1, &c->mean, why)))
        return why->status;
    if (!source_has(doc, factor)) return 0;
    if (source_shape(doc, factor, shape) != 2 || shape[1] != 2 || shape[0] >= 1 << 24)
        return why_set(why, EX_DATAERR, "%s: not of shape moments x 2", factor);
    if (!(c->factor = calloc(shape[0] + 1, sizeof *c->factor)))
        return why_set(why, EX_SOFTWARE, "no memory for the cell's loads");
    c->factors = (int32_t)shape[0];
    return source_rows(doc, factor, (struct slab){ COLUMN_F64, 0, (int64_t)shape[0], 2 }, c->factor,
                       why);
}

int cell_tables_read(struct source *source, int64_t k, const bool repeats[3], struct packing *p,
                     struct why *why)
{
    const char *origin = "/particles/all/box/origin", *rate = "/particles/all/box/rate/value";
    struct cell *c = &p->cell;
    memcpy(c->repeats, repeats, sizeof c->repeats);
    if (!cell_repeats(c)) return 0;
    if (cell_tables_read_edges(source, k, c, why) || cell_tables_read_drive(source, c, why) || read_size(source, c, why) ||
        packing_alloc_images(p, why) ||
        (source_has(source, origin) && source_read(source, origin, COLUMN_F64, 3, &c->origin, why)))
        return why->status;
    cell_set_rate(c, p->t);
    return source_has(source, rate)
               ? source_rows(source, rate, (struct slab){ COLUMN_F64, k, 1, 9 }, c->rate, why)
               : 0;
}

/* ---- to a document ---- */

/* What moves the cell's edges, and what they yield to */
static int write_drive(hid_t file, const struct cell *c, struct why *why)
{
    const hsize_t shape[3] = { (hsize_t)c->gradients, 3, 3 }, *square = shape + 1;
    size_t n = (size_t)c->gradients;
    double *t = calloc(n + 1, sizeof *t), (*L)[9] = calloc(n + 1, sizeof *L);
    if (t && L)
        for (size_t k = 0; k < n; k++) {
            t[k] = c->gradient[k].t;
            memcpy(L[k], c->gradient[k].L, sizeof L[k]);
        }
    else
        why_set(why, EX_SOFTWARE, "no memory for the cell");
    bool bad =
        why->status ||
        h5_write(file, "/nsd/cell/time", h5_vector(H5T_NATIVE_DOUBLE, shape[0], t), "s", why) ||
        h5_write(file, "/nsd/cell/gradient", h5_array(H5T_NATIVE_DOUBLE, 3, shape, L), "s-1",
                 why) ||
        h5_write(file, "/nsd/cell/mass", h5_array(H5T_NATIVE_DOUBLE, 2, square, c->mass), "kg",
                 why) ||
        h5_write(file, "/nsd/cell/stress", h5_array(H5T_NATIVE_DOUBLE, 2, square, c->stress), "Pa",
                 why);
    free(t), free(L);
    return bad ? why->status : 0;
}

static int write_size(hid_t file, const struct cell *c, struct why *why)
{
    const hsize_t shape[2] = { (hsize_t)c->factors, 2 };
    if (c->size_mass > 0 &&
        (h5_write(file, "/nsd/cell/size_mass", h5_vector(H5T_NATIVE_DOUBLE, 1, &c->size_mass),
                  "kg m2", why) ||
         h5_write(file, "/nsd/cell/mean", h5_vector(H5T_NATIVE_DOUBLE, 1, &c->mean), "Pa", why)))
        return why->status;
    return c->factors ? h5_write(file, "/nsd/cell/factor",
                                 h5_array(H5T_NATIVE_DOUBLE, 2, shape, c->factor), "s; 1", why)
                      : 0;
}

int cell_tables_write_box(hid_t file, const struct cell *c, struct why *why)
{
    const int dimension = 3; // positions have three components in the plane too
    const char none[3][5] = { "none", "none", "none" };
    const char *box = "/particles/all/box";
    if (h5_group(file, box, why) ||
        h5_attr(file, box, "dimension", h5_scalar(H5T_NATIVE_INT, &dimension), why))
        return why->status;
    char boundary[3][9] = { "none", "none", "none" };
    for (int k = 0; k < 3; k++)
        if (c->repeats[k]) memcpy(boundary[k], "periodic", sizeof boundary[k]);
    bool repeats = cell_repeats(c);
    hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, repeats ? sizeof boundary[0] : sizeof none[0]);
    int e = h5_attr(file, box, "boundary",
                    h5_vector(text, 3, repeats ? (const void *)boundary : (const void *)none), why);
    H5Tclose(text);
    if (e || !repeats) return e;
    return h5_write(file, "/particles/all/box/origin", h5_vector(H5T_NATIVE_DOUBLE, 3, &c->origin),
                    "m", why) ||
                   write_drive(file, c, why) || write_size(file, c, why)
               ? why->status
               : 0;
}

int cell_tables_write(struct table_write *s, const struct packing *p, struct why *why)
{
    for (const struct column *c = layout_cell; cell_repeats(&p->cell) && c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s/value", c->name);
        const hsize_t shape[3] = { 1, 3, 3 };
        if (table_write_rows(s,
                             (struct dataset){ path, c->type, 3, shape, CHUNK_FRAMES,
                                               (const char *)&p->cell + c->offset, c->units },
                             why))
            return why->status;
    }
    return 0;
}
