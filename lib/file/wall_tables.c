#include "file/wall_tables.h"

#include "file/h5.h"
#include "file/tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WALLS_HOME "/particles/boundary"

/* /particles/boundary/NAME [B][width], where any moves NAME/value [F][B][width]: where they are. It
   follows from the tables above, and is not read. */
struct wall_motion {
    vec3 x; /* m: the point of reference */
    quat q; /* from the orientation in which the shape is described */
    vec3 v; /* m/s: of that point */
    vec3 w; /* rad/s */
};
static const struct field wall_motion_fields[] = {
    FIELD(struct wall_motion, x, F64, 3, "position", "m", FIELD_MOVES),
    FIELD(struct wall_motion, q, F64, 4, "orientation", "1", FIELD_MOVES),
    FIELD(struct wall_motion, v, F64, 3, "velocity", "m s-1", FIELD_MOVES),
    FIELD(struct wall_motion, w, F64, 3, "angular_velocity", "rad s-1", FIELD_MOVES),
    { 0 },
};

/* ---- from a document ---- */

/* The loads as they are in frame k, in `group` */
static int read_loads(struct source *r, const char *group, int64_t k, struct packing *p,
                      struct failure *failure)
{
    if (!source_has(r, group)) return 0;
    if (table_read_columns(r, group, "", 0, RECORDS(load_fields, p->walls, p->wall), failure))
        return failure->status;
    return table_read_frame(r, group, k, RECORDS(load_motion_fields, p->walls, p->wall), failure);
}

/* The number of rows of a dataset of so many dimensions */
static int wall_tables_count_rows(struct source *r, const char *path, int rank, int32_t *n,
                                  struct failure *failure)
{
    uint64_t shape[4];
    if (source_shape(r, path, shape) != rank || shape[0] > 1 << 24)
        return failure_set(failure, EX_DATAERR, "%s: not of %d dimensions", path, rank);
    *n = (int32_t)shape[0];
    return 0;
}

/* Signals in time of walls, of which each counts its own from the first one */
struct signals {
    const char *group;   /* where they are stored */
    size_t drives;       /* where they are in struct packing, */
    size_t first, count; /* and in struct wall the first and the number of its own */
};

static const struct signals signals_drive = { WALLS_HOME "/drive", offsetof(struct packing, drives),
                                              offsetof(struct wall, first_drive),
                                              offsetof(struct wall, drives) },
                            signals_push = { WALLS_HOME "/push", offsetof(struct packing, pushes),
                                             offsetof(struct wall, first_push),
                                             offsetof(struct wall, pushes) };

int signal_tables_read(struct source *r, const char *group, const struct field *fields,
                       struct drives *d, struct failure *failure)
{
    char first[60], rows[60];
    int32_t n = 0, m = 0;
    snprintf(first, sizeof first, "%s/%s", group, fields[0].name);
    snprintf(rows, sizeof rows, "%s/row", group);
    if (!source_has(r, group)) return 0;
    if (wall_tables_count_rows(r, first, 1, &n, failure) ||
        wall_tables_count_rows(r, rows, 2, &m, failure) || drives_alloc(d, n, m, failure) ||
        table_read_columns(r, group, "", 0, RECORDS(fields, n, d->drive), failure))
        return failure->status;
    return source_rows(r, rows, (struct slab){ COLUMN_F64, 0, m, 2 }, d->row, failure);
}

static int read_signals(struct source *r, const struct signals *of, struct packing *p,
                        struct failure *failure)
{
    struct drives *d = (struct drives *)(void *)((char *)p + of->drives);
    if (signal_tables_read(r, of->group, drive_fields, d, failure)) return failure->status;
    for (int32_t k = 0; k < d->n; k++) {
        int32_t w = d->drive[k].wall;
        if (w < 0 || w >= p->walls || (k && w < d->drive[k - 1].wall))
            return failure_set(failure, EX_DATAERR, "%s/boundary: not in the order of the walls",
                               of->group);
        int32_t *had = (int32_t *)(void *)((char *)&p->wall[w] + of->count);
        if (!(*had)++) *(int32_t *)(void *)((char *)&p->wall[w] + of->first) = k;
    }
    return 0;
}

static int read_drives(struct source *r, struct packing *p, struct failure *failure)
{
    return read_signals(r, &signals_drive, p, failure) || read_signals(r, &signals_push, p, failure)
               ? failure->status
               : 0;
}

static int wall_tables_read_mesh(struct source *r, struct packing *p, struct failure *failure)
{
    const char *vertex = WALLS_HOME "/mesh/vertex", *element = WALLS_HOME "/mesh/element";
    int32_t n = 0, m = 0;
    if (!source_has(r, WALLS_HOME "/mesh")) return 0;
    if (wall_tables_count_rows(r, vertex, 2, &n, failure) ||
        wall_tables_count_rows(r, element, 2, &m, failure) || mesh_alloc(&p->mesh, n, m, failure) ||
        source_rows(r, vertex, (struct slab){ COLUMN_F64, 0, n, 3 }, p->mesh.vertex, failure) ||
        source_rows(r, element, (struct slab){ COLUMN_I32, 0, m, 3 }, p->mesh.element, failure))
        return failure->status;
    return 0;
}

/* Planes, as version 1 had them */
static int read_planes(struct source *r, int64_t k, struct packing *p, struct failure *failure)
{
    int32_t n = 0;
    if (!source_has(r, "/walls/plane")) return 0;
    if (wall_tables_count_rows(r, "/walls/plane/point", 2, &n, failure) ||
        packing_alloc_walls(p, n, failure) ||
        table_read_columns(r, "/walls/plane", "", 0, RECORDS(wall_fields, n, p->wall), failure))
        return failure->status;
    return read_loads(r, "/walls/load", k, p, failure);
}

int wall_tables_read(struct source *r, int64_t k, struct packing *p, struct failure *failure)
{
    const char *body = WALLS_HOME "/body";
    int32_t n = 0;
    if (!source_has(r, body)) return read_planes(r, k, p, failure);
    if (wall_tables_count_rows(r, WALLS_HOME "/body/point", 2, &n, failure) ||
        packing_alloc_walls(p, n, failure) ||
        table_read_columns(r, body, "", 0, RECORDS(wall_fields, n, p->wall), failure) ||
        read_loads(r, WALLS_HOME "/load", k, p, failure) || read_drives(r, p, failure) ||
        wall_tables_read_mesh(r, p, failure))
        return failure->status;
    return 0;
}

/* ---- to a document ---- */

static bool any_loads(const struct packing *p)
{
    for (int32_t w = 0; w < p->walls; w++)
        if (p->wall[w].load.way) return true;
    return false;
}

bool wall_tables_move(const struct packing *p)
{
    for (int32_t w = 0; w < p->walls; w++)
        if (v3_norm(p->wall[w].v) > 0 || p->wall[w].load.way) return true;
    return p->drives.n > 0;
}

/* Or may it, in frames to come? */
static bool any_may_move(const struct packing *p)
{
    return p->outside.steered || wall_tables_move(p);
}

/* [walls]; NULL: no memory */
static struct wall_motion *motions(const struct packing *p, struct failure *failure)
{
    struct wall_motion *m = calloc((size_t)p->walls + 1, sizeof *m);
    if (!m) failure_set(failure, EX_SOFTWARE, "no memory for the motion of the walls");
    for (int32_t w = 0; m && w < p->walls; w++) {
        const struct wall *wall = &p->wall[w];
        vec3 x = wall_at(p, wall, p->t);
        m[w] = (struct wall_motion){ x, wall_pose(p, wall, p->t).q, wall_velocity(p, wall, x),
                                     wall_spin(p, wall) };
    }
    return m;
}

int signal_tables_write(struct table_write *s, const char *group, const struct field *fields,
                        const struct drives *d, const char *units, struct failure *failure)
{
    const hsize_t shape[2] = { (hsize_t)d->rows, 2 };
    char rows[60];
    snprintf(rows, sizeof rows, "%s/row", group);
    if (!d->n || table_write_once(s, group, RECORDS(fields, d->n, d->drive), failure))
        return failure->status;
    return h5_write(s->file, rows, h5_array(H5T_NATIVE_DOUBLE, 2, shape, d->row), units, failure);
}

static int write_drives(struct table_write *s, const struct packing *p, struct failure *failure)
{
    if (signal_tables_write(s, WALLS_HOME "/drive", drive_fields, &p->drives, "s; m, rad", failure))
        return failure->status;
    return signal_tables_write(s, WALLS_HOME "/push", drive_fields, &p->pushes, "s; N, N m",
                               failure);
}

static int write_mesh(struct table_write *s, const struct packing *p, struct failure *failure)
{
    const hsize_t vertices[2] = { (hsize_t)p->mesh.vertices, 3 },
                  elements[2] = { (hsize_t)p->mesh.elements, 3 };
    if (!p->mesh.elements) return 0;
    if (h5_write(s->file, WALLS_HOME "/mesh/vertex",
                 h5_array(H5T_NATIVE_DOUBLE, 2, vertices, p->mesh.vertex), "m", failure))
        return failure->status;
    return h5_write(s->file, WALLS_HOME "/mesh/element",
                    h5_array(H5T_NATIVE_INT32, 2, elements, p->mesh.element), NULL, failure);
}

int wall_tables_write_static(struct table_write *s, const struct packing *p,
                             struct failure *failure)
{
    struct wall_motion *m = NULL;
    if (!table_write_once(s, WALLS_HOME "/body", RECORDS_OF(p, wall_fields, p->walls, p->wall),
                          failure) &&
        !write_drives(s, p, failure) && !write_mesh(s, p, failure) && any_loads(p))
        table_write_once(s, WALLS_HOME "/load", RECORDS(load_fields, p->walls, p->wall), failure);
    s->at_rest = !any_may_move(p);
    if (!failure->status && s->at_rest && (m = motions(p, failure)))
        table_write_once(s, WALLS_HOME, RECORDS(wall_motion_fields, p->walls, m), failure);
    free(m);
    return failure->status;
}

int wall_tables_write(struct table_write *s, const struct packing *p, struct failure *failure)
{
    if (!any_may_move(p) || (s->at_rest && !wall_tables_move(p))) return 0;
    if (s->at_rest)
        return failure_set(
            failure, EX_DATAERR,
            "walls move, and in the first frame none could: begin another trajectory");
    struct wall_motion *m = motions(p, failure);
    if (m &&
        !table_write_frame(s, WALLS_HOME, RECORDS(wall_motion_fields, p->walls, m), CHUNK_FRAMES,
                           failure) &&
        !table_write_clocks(s, WALLS_HOME, wall_motion_fields, p->step, p->t, failure) &&
        any_loads(p) &&
        !table_write_frame(s, WALLS_HOME "/load", RECORDS(load_motion_fields, p->walls, p->wall),
                           CHUNK_FRAMES, failure))
        table_write_clocks(s, WALLS_HOME "/load", load_motion_fields, p->step, p->t, failure);
    free(m);
    return failure->status;
}

#define NAMES_HOME "/nsd/names"
static const char text_path[] = NAMES_HOME "/text";

int name_tables_write(struct table_write *s, const struct packing *p, struct failure *failure)
{
    const struct names *names = &p->names;
    size_t length = 1;
    if (!names->n) return 0;
    for (int32_t k = 0; k < names->n; k++) length += strlen(names->text[k]) + 1;
    char *text = calloc(length, 1), *at = text;
    if (!text) return failure_set(failure, EX_SOFTWARE, "no memory for the names");
    for (int32_t k = 0; k < names->n; k++) {
        size_t n = strlen(names->text[k]);
        memcpy(at, names->text[k], n), at[n] = '\n', at += n + 1;
    }
    if (!h5_write_text(s->file, text_path, text, failure) && names->rows)
        table_write_once(s, NAMES_HOME, RECORDS(named_fields, names->rows, names->row), failure);
    free(text);
    return failure->status;
}

static int read_rows(struct source *r, struct packing *p, struct failure *failure)
{
    const char *path = NAMES_HOME "/boundary";
    uint64_t shape[4];
    if (!source_has(r, path)) return 0;
    if (source_shape(r, path, shape) != 1 || shape[0] > NAMED_MOST)
        return failure_set(failure, EX_DATAERR, "%s: not of one dimension, or of more than %d rows",
                           path, NAMED_MOST);
    p->names.row = calloc((size_t)shape[0] + 1, sizeof *p->names.row);
    if (!p->names.row) return failure_set(failure, EX_SOFTWARE, "no memory for the names");
    p->names.rows = (int32_t)shape[0];
    return table_read_columns(r, NAMES_HOME, "", 0,
                              RECORDS(named_fields, p->names.rows, p->names.row), failure);
}

int name_tables_read(struct source *r, struct packing *p, struct failure *failure)
{
    if (!source_has(r, text_path)) return 0;
    char *text = source_text(r, text_path, NULL, failure);
    for (char *at = text, *end; at && *at && !failure->status; at = end + 1) {
        int32_t had = p->names.n, which;
        if (!(end = strchr(at, '\n'))) {
            failure_set(failure, EX_DATAERR, "%s: the last name does not end", text_path);
            break;
        }
        *end = 0;
        if (names_add(&p->names, at, &which, failure))
            failure_set(failure, EX_DATAERR, "%s: a name that is no name", text_path);
        else if (p->names.n == had)
            failure_set(failure, EX_DATAERR, "%s: \"%s\" occurs twice", text_path, at);
    }
    free(text);
    return failure->status ? failure->status : read_rows(r, p, failure);
}
