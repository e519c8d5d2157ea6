#include "file/shape_tables.h"

#include "file/h5.h"
#include "file/tables.h"
#include "state/breakage.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SHAPE "/nsd/shape"

enum { PER_BYTE = 16 }; /* vertices that are seen behind a face while a byte is read */

/* What all shapes have, a row each: numbers, and how many of the rows of vertices and corners */
struct shape_tables_row {
    int32_t form, vertices, faces, corners;
    double round, volume, moment[3];
};

static const struct field shape_fields[] = {
    FIELD(struct shape_tables_row, form, I32, 1, "form", "1", 0),
    FIELD(struct shape_tables_row, vertices, I32, 1, "vertices", "1", 0),
    FIELD(struct shape_tables_row, faces, I32, 1, "faces", "1", 0),
    FIELD(struct shape_tables_row, corners, I32, 1, "corners", "1", 0),
    FIELD(struct shape_tables_row, round, F64, 1, "round", "1", 0),
    FIELD(struct shape_tables_row, volume, F64, 1, "volume", "1", 0),
    FIELD(struct shape_tables_row, moment, F64, 3, "moment", "1", 0),
    { 0 },
};

/* Where grains break: the id in the name of a fragment's shape, -1 of others; and how many shapes a frame has */
static const struct field fragment_field[] = {
    { .name = "fragment", .units = "1", .type = COLUMN_I32, .width = 1 }, { 0 }
};
#define COUNT SHAPE "/count/value"

/* ---- from a document ---- */

/* The lists that follow one another in the datasets of all shapes */
struct listing {
    vec3 *vertex;
    double *ball;
    int32_t *face, *corner; /* face: its number of corners */
    uint64_t vertices, faces, corners;
};

static int read_lists(struct source *r, struct listing *l, struct failure *failure)
{
    uint64_t balls, n[4];
    if (source_shape(r, SHAPE "/vertex", n) != 2 || n[0] > INT32_MAX)
        return failure_set(failure, EX_DATAERR, SHAPE "/vertex: not of shape vertices x 3");
    l->vertices = n[0];
    l->vertex = calloc((size_t)n[0] + 1, sizeof *l->vertex);
    if (!l->vertex) return failure_set(failure, EX_SOFTWARE, "no memory for the shapes");
    if (source_rows(r, SHAPE "/vertex", (struct slab){ COLUMN_F64, 0, (int64_t)n[0], 3 }, l->vertex,
                    failure))
        return failure->status;
    l->ball = source_read_all(r, SHAPE "/ball", COLUMN_F64, &balls, failure);
    l->face = source_read_all(r, SHAPE "/face", COLUMN_I32, &l->faces, failure);
    l->corner = source_read_all(r, SHAPE "/corner", COLUMN_I32, &l->corners, failure);
    if (!failure->status && balls != l->vertices)
        failure_set(failure, EX_DATAERR, SHAPE "/ball: not a number for each vertex");
    return failure->status;
}

static void listing_drop(struct listing *l)
{
    free(l->vertex), free(l->ball), free(l->face), free(l->corner);
}

/* Where the next shape begins in the lists */
struct shape_tables_place {
    const struct listing *of;
    uint64_t vertices, faces, corners;
};

/* The shape of a row, and the lists from `at` on, which moves on; nothing to free where it fails */
static int shape_tables_make_shape(struct source *r, struct shape *s,
                                   const struct shape_tables_row *row,
                                   struct shape_tables_place *at, int dim, struct failure *failure)
{
    const struct listing *l = at->of;
    if (row->vertices < 0 || row->faces < 0 || row->corners < 0 ||
        (uint64_t)row->vertices > l->vertices - at->vertices ||
        (uint64_t)row->faces > l->faces - at->faces ||
        (uint64_t)row->corners > l->corners - at->corners ||
        (row->vertices && !(l->vertex && l->ball)) || (row->faces && !l->face) ||
        (row->corners && !l->corner))
        return failure_set(failure, EX_DATAERR, "more vertices or faces than there are");
    if (source_draw(r, (uint64_t)row->vertices * (uint64_t)row->faces / PER_BYTE, failure))
        return failure->status; // of each face all vertices are behind
    if (shape_alloc(s, row->vertices, row->faces, row->corners, failure)) return failure->status;
    s->form = row->form, s->round = row->round, s->volume = row->volume;
    memcpy(s->moment, row->moment, sizeof s->moment);
    for (int32_t i = 0; i < row->vertices; i++, at->vertices++)
        s->vertex[i] = l->vertex[at->vertices], s->ball[i] = l->ball[at->vertices];
    for (int32_t f = 0; f < row->faces && !failure->status; f++) {
        int32_t n = l->face[at->faces++];
        if (n < 3 || n > s->corners - s->first[f])
            failure_set(failure, EX_DATAERR, "a face has %d corners", n);
        else
            s->first[f + 1] = s->first[f] + n;
    }
    for (int32_t i = 0; i < row->corners; i++) s->corner[i] = l->corner[at->corners++];
    if (failure->status || shape_finish(s, dim, failure)) shape_free(s);
    return failure->status;
}

/* The table of shapes */
struct shape_tables_table {
    int32_t n;
    const struct shape_tables_row *row; /* [n] */
    const char *names;                  /* a line each */
    const int32_t *fragment; /* [n] whose those are that have no line; NULL: all have one */
    struct listing lists;
};

/* The name of row k, to be freed, from *names on; NULL: it has none, or there is no memory */
static char *shape_tables_name(const struct shape_tables_table *t, int32_t k, const char **names,
                               struct failure *failure)
{
    char text[32];
    const char *end = strchr(*names, '\n');
    char *name = NULL;
    if (end && end > *names) {
        name = strndup(*names, (size_t)(end - *names));
        *names = end + 1;
    } else if (!end && t->fragment && t->fragment[k] >= 0) {
        snprintf(text, sizeof text, BREAKAGE_FRAGMENT, t->fragment[k]);
        name = strdup(text);
    } else {
        failure_set(failure, EX_DATAERR, SHAPE "@names: fewer names than shapes");
        return NULL;
    }
    if (!name) failure_set(failure, EX_SOFTWARE, "no memory for the shapes");
    return name;
}

/* Rows 1, 2 ... of the table; row 0 is the ball, which stands in no list. */
static int make_shapes(struct source *r, struct packing *p, const struct shape_tables_table *t,
                       struct failure *failure)
{
    const char *names = t->names;
    struct shape_tables_place at = { .of = &t->lists };
    for (int32_t k = 0; k < t->n && !failure->status; k++) {
        struct shape s = { 0 };
        struct failure trouble = { 0 };
        char *name = shape_tables_name(t, k, &names, failure);
        if (!name) return failure->status;
        shape_tables_make_shape(r, &s, &t->row[k], &at, p->dim, &trouble);
        if (trouble.status)
            failure_set(failure, trouble.status, SHAPE ": \"%s\": %s", name, trouble.text);
        if (trouble.status) free(name);
        s.name = trouble.status ? NULL : name;
        bool twice = !failure->status && shapes_find(&p->shapes, name) >= 0;
        if (!failure->status && shapes_add(&p->shapes, p->dim, &s, failure)) return failure->status;
        if (twice) failure_set(failure, EX_DATAERR, SHAPE "@names: two shapes have one name");
    }
    return failure->status;
}

/* How many of `rows` shapes frame k has, where more come with time */
static int read_count(struct source *r, int64_t k, uint64_t *rows, struct failure *failure)
{
    int32_t count = 0;
    if (!source_has(r, COUNT)) return 0;
    if (source_rows(r, COUNT, (struct slab){ COLUMN_I32, k, 1, 1 }, &count, failure))
        return failure->status;
    if (count < 1 || (uint64_t)count > *rows)
        return failure_set(failure, EX_DATAERR, COUNT ": more shapes than there are, or none");
    *rows = (uint64_t)count;
    return 0;
}

int shape_tables_read(struct source *r, int64_t k, struct packing *p, struct failure *failure)
{
    uint64_t n[4];
    struct shape_tables_table t = { 0 };
    if (!source_has(r, SHAPE)) return 0;
    if (source_shape(r, SHAPE "/form", n) != 1 || n[0] < 1 || n[0] >= SHAPES_MOST)
        return failure_set(failure, EX_DATAERR, SHAPE "/form: not a list of shapes");
    if (read_count(r, k, &n[0], failure)) return failure->status;
    struct shape_tables_row *row = calloc((size_t)n[0], sizeof *row);
    int32_t *fragment = calloc((size_t)n[0], sizeof *fragment);
    char *names = row && fragment ? source_text(r, SHAPE, "names", failure) : NULL;
    if (!row || !fragment || (!names && !failure->status))
        failure_set(failure, EX_SOFTWARE, "no memory for the shapes");
    t.n = (int32_t)n[0], t.row = row, t.names = names;
    if (!failure->status && source_has(r, SHAPE "/fragment") &&
        !source_rows(r, SHAPE "/fragment", (struct slab){ COLUMN_I32, 0, t.n, 1 }, fragment,
                     failure))
        t.fragment = fragment;
    if (!failure->status &&
        !table_read_columns(r, SHAPE, "", 0, RECORDS(shape_fields, t.n, row), failure) &&
        !read_lists(r, &t.lists, failure))
        make_shapes(r, p, &t, failure);
    listing_drop(&t.lists);
    free(row), free(fragment), free(names);
    return failure->status ? failure->status : packing_alloc_shapes(p, failure);
}

/* ---- to a document ---- */

enum { CHUNK_SHAPES = 64 }; /* rows a chunk of tables that grow */

/* Shapes `first` and those after it, into the tables */
static int shape_tables_write_rows(struct table_write *w, const struct shapes *t, int32_t first,
                                   struct failure *failure)
{
    const int64_t n = t->n - first;
    struct shape_tables_row *row = calloc((size_t)n + 1, sizeof *row);
    int32_t *fragment = calloc((size_t)n + 1, sizeof *fragment);
    if (!row || !fragment) {
        free(row), free(fragment);
        return failure_set(failure, EX_SOFTWARE, "no memory for the shapes");
    }
    for (int32_t k = first; k < t->n; k++) {
        const struct shape *s = &t->s[k];
        row[k - first] = (struct shape_tables_row){ s->form,
                                                    s->vertices,
                                                    s->faces,
                                                    s->corners,
                                                    s->round,
                                                    s->volume,
                                                    { s->moment[0], s->moment[1], s->moment[2] } };
        fragment[k - first] = breakage_fragment(s->name);
    }
    if (!table_write_columns(w, SHAPE, "", RECORDS(shape_fields, n, row), CHUNK_SHAPES, failure) &&
        w->shapes)
        table_write_columns(w, SHAPE, "", RECORDS(fragment_field, n, fragment), CHUNK_SHAPES,
                            failure);
    free(row), free(fragment);
    return failure->status;
}

static int write_list(struct table_write *w, const char *path, enum column_type type, uint64_t rows,
                      uint64_t width, const void *data, const char *units, struct failure *failure)
{
    const hsize_t shape[2] = { rows, width };
    return table_write_rows(
        w, (struct dataset){ path, type, width > 1 ? 2 : 1, shape, 8 * CHUNK_SHAPES, data, units },
        failure);
}

static int write_lists(struct table_write *w, const struct shapes *t, int32_t first,
                       struct failure *failure)
{
    struct listing l = { 0 };
    for (int32_t k = first; k < t->n; k++) {
        const struct shape *s = &t->s[k];
        l.vertices += (uint64_t)s->vertices, l.faces += (uint64_t)s->faces;
        l.corners += (uint64_t)s->corners;
    }
    l.vertex = calloc(l.vertices + 1, sizeof *l.vertex);
    l.ball = calloc(l.vertices + 1, sizeof *l.ball);
    l.face = calloc(l.faces + 1, sizeof *l.face);
    l.corner = calloc(l.corners + 1, sizeof *l.corner);
    uint64_t v = 0, f = 0, c = 0;
    if (!l.vertex || !l.ball || !l.face || !l.corner)
        failure_set(failure, EX_SOFTWARE, "no memory for the shapes");
    for (int32_t k = first; k < t->n && !failure->status; k++) {
        const struct shape *s = &t->s[k];
        for (int32_t i = 0; i < s->vertices; i++, v++)
            l.vertex[v] = s->vertex[i], l.ball[v] = s->ball[i];
        for (int32_t i = 0; i < s->faces; i++) l.face[f++] = s->first[i + 1] - s->first[i];
        for (int32_t i = 0; i < s->corners; i++) l.corner[c++] = s->corner[i];
    }
    bool bad = failure->status ||
               write_list(w, SHAPE "/vertex", COLUMN_F64, l.vertices, 3, l.vertex, "1", failure) ||
               write_list(w, SHAPE "/ball", COLUMN_F64, l.vertices, 1, l.ball, "1", failure) ||
               write_list(w, SHAPE "/face", COLUMN_I32, l.faces, 1, l.face, "1", failure) ||
               write_list(w, SHAPE "/corner", COLUMN_I32, l.corners, 1, l.corner, "1", failure);
    listing_drop(&l);
    return bad ? failure->status : 0;
}

static int write_names(hid_t file, const struct shapes *t, struct failure *failure)
{
    size_t length = 1;
    for (int32_t k = 1; k < t->n; k++) length += strlen(t->s[k].name) + 1;
    char *names = calloc(length, 1), *at = names;
    if (!names) return failure_set(failure, EX_SOFTWARE, "no memory for the shapes");
    for (int32_t k = 1; k < t->n; k++) at += sprintf(at, "%s\n", t->s[k].name);
    int e = h5_attr_text(file, SHAPE, "names", names, failure);
    free(names);
    return e;
}

int shape_tables_write_static(struct table_write *s, const struct packing *p,
                              struct failure *failure)
{
    const bool growing = s->growing;
    if (p->shapes.n < 2 || p->breakage) return 0;
    s->growing = false;
    if (!shape_tables_write_rows(s, &p->shapes, 1, failure) &&
        !write_lists(s, &p->shapes, 1, failure))
        write_names(s->file, &p->shapes, failure);
    s->growing = growing;
    return failure->status;
}

int shape_tables_write(struct table_write *s, const struct packing *p, struct failure *failure)
{
    const int32_t first = s->shapes ? s->shapes : 1, count = p->shapes.n - 1;
    const bool begins = !s->shapes;
    if (p->shapes.n < 2 || !p->breakage) return 0;
    s->shapes = p->shapes.n;
    if ((begins || p->shapes.n > first) &&
        (shape_tables_write_rows(s, &p->shapes, first, failure) ||
         write_lists(s, &p->shapes, first, failure)))
        return failure->status;
    if (begins && write_names(s->file, &p->shapes, failure)) return failure->status;
    return table_write_number(s, COUNT, COLUMN_I32, &count, NULL, failure);
}
