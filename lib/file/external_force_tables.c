#include "file/external_force_tables.h"

#include "file/h5.h"
#include "file/layout.h"
#include "file/tables.h"
#include "file/wall_tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXTERNAL_HOME "/nsd/outside"

/* What frames have a row of: a dataset [frames][n] or, where vectors are, [frames][n][3] */
struct frame_row {
    const char *name, *units;
    double *x;
    int64_t n;
    int width; /* 1 or 3 */
};

static int frame_row_write(struct table_write *s, struct frame_row r, struct failure *failure)
{
    const hsize_t shape[3] = { 1, (hsize_t)r.n, 3 };
    char path[80];
    snprintf(path, sizeof path, EXTERNAL_HOME "/%s", r.name);
    return table_write_rows(s,
                            (struct dataset){ path, COLUMN_F64, r.width == 1 ? 2 : 3, shape,
                                              CHUNK_FRAMES, r.x, r.units },
                            failure);
}

static int frame_row_read(struct source *s, int64_t row, struct frame_row r,
                          struct failure *failure)
{
    char path[80];
    snprintf(path, sizeof path, EXTERNAL_HOME "/%s", r.name);
    return source_rows(s, path, (struct slab){ COLUMN_F64, row, 1, r.n * r.width }, r.x, failure);
}

/* What a program may change of a frame, gathered */
struct steered {
    double g[3];
    vec3 *x, *v; /* of walls */
    double *push;
};
enum { STEERED_ROWS = 5 };

static int steered_init(struct steered *y, const struct packing *p, struct failure *failure)
{
    const size_t n = (size_t)p->walls;
    *y = (struct steered){ .g = { p->g.x, p->g.y, p->g.z } };
    y->x = calloc(2 * n + 1, sizeof *y->x), y->push = calloc(n + 1, sizeof *y->push);
    if (!y->x || !y->push) return failure_set(failure, EX_SOFTWARE, "no memory for the walls");
    y->v = y->x + n;
    for (size_t w = 0; w < n; w++) {
        y->x[w] = p->wall[w].x, y->v[w] = p->wall[w].v;
        if (p->outside.push) y->push[w] = p->outside.push[w];
    }
    return 0;
}

static struct frame_row steered_row(const struct steered *y, const struct packing *p, int k)
{
    const int64_t pairs = (int64_t)p->materials * p->materials;
    const struct frame_row rows[STEERED_ROWS] = {
        { "gravity", "m s-2", (double *)y->g, 3, 1 },
        { "friction", NULL, p->mu, pairs, 1 },
        { "point", "m", (double *)y->x, p->walls, 3 },
        { "velocity", "m s-1", (double *)y->v, p->walls, 3 },
        { "push", "N, N m", y->push, p->walls, 1 },
    };
    return rows[k];
}

static void steered_free(struct steered *y)
{
    free(y->x), free(y->push);
}

/* ---- to a document ---- */

/* Rows of the group's list, of which there are *so_far: n forces and torques; NULL: all are 0 */
static int external_force_tables_write_forces(struct table_write *s, const char *group, int64_t n,
                                              const vec3 *const of[2], int64_t *so_far,
                                              struct failure *failure)
{
    static const char *const name[] = { "force", "torque" }, *const units[] = { "N", "N m" };
    const hsize_t shape[2] = { (hsize_t)n, 3 };
    vec3 *none = calloc((size_t)n + 1, sizeof *none);
    if (!none) return failure_set(failure, EX_SOFTWARE, "no memory for forces");
    table_write_span(s, group, *so_far, n, failure);
    for (int k = 0; k < 2 && !failure->status; k++) {
        char path[80];
        snprintf(path, sizeof path, "%s/%s", group, name[k]);
        table_write_rows(s,
                         (struct dataset){ path, COLUMN_F64, 2, shape, CHUNK_CONTACTS,
                                           n && of[k] ? of[k] : none, units[k] },
                         failure);
    }
    free(none);
    if (s->growing) *so_far += n;
    return failure->status;
}

static int external_force_tables_write_words(struct table_write *s, const struct external_force *o,
                                             struct failure *failure)
{
    const hsize_t length = (hsize_t)o->length;
    if (table_write_span(s, EXTERNAL_HOME "/answer", s->words, o->length, failure) ||
        table_write_rows(s,
                         (struct dataset){ EXTERNAL_HOME "/answer/text", COLUMN_I8, 1, &length,
                                           CHUNK_CONTACTS, o->length ? o->words : "", NULL },
                         failure))
        return failure->status;
    if (s->growing) s->words += o->length;
    return 0;
}

/* Forces that last, of frames that have them; they have their own steps. */
static int write_lasting(struct table_write *s, const struct packing *p, struct failure *failure)
{
    const struct lasting *o = &p->outside.lasts;
    const int64_t n = o->force || o->torque ? p->n : 0;
    if (!n && !o->push) return 0;
    double *rest = calloc((size_t)p->walls + 1, sizeof *rest);
    if (!rest) return failure_set(failure, EX_SOFTWARE, "no memory for forces that last");
    const struct frame_row push = { "lasting/push", "N, N m", o->push ? o->push : rest, p->walls,
                                    1 };
    if (!table_write_number(s, EXTERNAL_HOME "/lasting/step", COLUMN_I64, &p->step, NULL,
                            failure) &&
        !frame_row_write(s, push, failure))
        external_force_tables_write_forces(s, EXTERNAL_HOME "/lasting", n,
                                           (const vec3 *const[]){ o->force, o->torque },
                                           &s->lasting, failure);
    free(rest);
    return failure->status;
}

int external_force_tables_write(struct table_write *s, const struct frame *f,
                                struct failure *failure)
{
    const struct packing *p = &f->packing;
    const struct external_force *o = &p->outside;
    struct steered y;
    if (!f->distributed && write_lasting(s, p, failure)) return failure->status;
    bool forces = f->detected && (o->force || o->torque) && !f->distributed;
    if (!o->steered && !forces && !o->length && !(f->detected && o->push)) return 0;
    if (!steered_init(&y, p, failure))
        table_write_number(s, EXTERNAL_HOME "/step", COLUMN_I64, &p->step, NULL, failure);
    for (int k = 0; k < STEERED_ROWS && !failure->status; k++)
        frame_row_write(s, steered_row(&y, p, k), failure);
    steered_free(&y);
    if (failure->status || external_force_tables_write_forces(
                               s, EXTERNAL_HOME "/body", forces ? p->n : 0,
                               (const vec3 *const[]){ o->force, o->torque }, &s->forces, failure))
        return failure->status;
    return external_force_tables_write_words(s, o, failure);
}

/* ---- from a document ---- */

/* NULL where all are 0 */
static void drop_zeros(double **x, int64_t n)
{
    for (int64_t i = 0; *x && i < n; i++)
        if ((*x)[i] != 0) return;
    free(*x);
    *x = NULL;
}

static void drop_vectors(vec3 **x, int64_t n)
{
    double *at = (double *)*x;
    drop_zeros(&at, 3 * n);
    if (!at) *x = NULL;
}

static int read_steered(struct source *s, int64_t row, struct packing *p, struct failure *failure)
{
    struct steered y;
    if (external_force_alloc_push(&p->outside, p->walls, failure)) return failure->status;
    steered_init(&y, p, failure);
    for (int k = 0; k < STEERED_ROWS && !failure->status; k++)
        frame_row_read(s, row, steered_row(&y, p, k), failure);
    for (int32_t w = 0; w < p->walls && !failure->status; w++) {
        if (!v3_finite(y.x[w]) || !v3_finite(y.v[w]))
            failure_set(failure, EX_DATAERR, EXTERNAL_HOME ": the motion of wall %d is not finite",
                        w);
        p->wall[w].x = y.x[w], p->wall[w].v = y.v[w], p->outside.push[w] = y.push[w];
    }
    drop_zeros(&p->outside.push, p->walls);
    p->g = v3(y.g[0], y.g[1], y.g[2]);
    steered_free(&y);
    return failure->status;
}

/* The span of the frame, which is to be within what is stored and at most `most` long */
static int read_span(struct source *s, const char *name, int64_t row, int64_t most,
                     struct span *span, struct failure *failure)
{
    const struct slab number = { COLUMN_I64, row, 1, 1 };
    char path[80];
    snprintf(path, sizeof path, EXTERNAL_HOME "/%s/start", name);
    if (source_rows(s, path, number, &span->start, failure)) return failure->status;
    snprintf(path, sizeof path, EXTERNAL_HOME "/%s/count", name);
    if (source_rows(s, path, number, &span->count, failure)) return failure->status;
    if (span->start >= 0 && span->count >= 0 && span->count <= most) return 0;
    return failure_set(failure, EX_DATAERR, "%s: %lld from %lld on is out of range", path,
                       (long long)span->count, (long long)span->start);
}

/* The forces and torques of all bodies, into new arrays, or of none */
static int read_forces(struct source *s, const char *name, int64_t row, int64_t n, vec3 **force,
                       vec3 **torque, struct failure *failure)
{
    struct span span = { 0, 0 };
    char path[80];
    if (read_span(s, name, row, n, &span, failure) || !span.count) return failure->status;
    const struct slab rows = { COLUMN_F64, span.start, span.count, 3 };
    if (span.count != n)
        return failure_set(failure, EX_DATAERR,
                           EXTERNAL_HOME "/%s/count: forces of %lld bodies, and there are %lld",
                           name, (long long)span.count, (long long)n);
    if (external_force_alloc(force, n, failure) || external_force_alloc(torque, n, failure))
        return failure->status;
    snprintf(path, sizeof path, EXTERNAL_HOME "/%s/force", name);
    if (source_rows(s, path, rows, *force, failure)) return failure->status;
    snprintf(path, sizeof path, EXTERNAL_HOME "/%s/torque", name);
    return source_rows(s, path, rows, *torque, failure);
}

static int read_lasting(struct source *s, struct packing *p, struct failure *failure)
{
    struct lasting *o = &p->outside.lasts;
    int64_t row = table_read_row_at(s, EXTERNAL_HOME "/lasting/step", p->step, failure);
    if (failure->status || row < 0) return failure->status;
    if (!(o->push = calloc((size_t)p->walls + 1, sizeof *o->push)))
        return failure_set(failure, EX_SOFTWARE, "no memory for forces that last");
    const struct frame_row push = { "lasting/push", NULL, o->push, p->walls, 1 };
    if (frame_row_read(s, row, push, failure) ||
        read_forces(s, "lasting", row, p->n, &o->force, &o->torque, failure))
        return failure->status;
    drop_zeros(&o->push, p->walls);
    if (o->force) drop_vectors(&o->force, p->n), drop_vectors(&o->torque, p->n);
    return 0;
}

static int read_words(struct source *s, int64_t row, struct external_force *o,
                      struct failure *failure)
{
    uint64_t shape[4];
    struct span span = { 0, 0 };
    if (source_shape(s, EXTERNAL_HOME "/answer/text", shape) != 1)
        return failure_set(failure, EX_DATAERR, EXTERNAL_HOME "/answer/text: not of one dimension");
    if (read_span(s, "answer", row, (int64_t)shape[0], &span, failure) || !span.count)
        return failure->status;
    const int64_t start = span.start, count = span.count;
    if (!(o->words = malloc((size_t)count)))
        return failure_set(failure, EX_SOFTWARE, "no memory for the answer");
    o->length = o->room = count;
    return source_rows(s, EXTERNAL_HOME "/answer/text", (struct slab){ COLUMN_I8, start, count, 1 },
                       o->words, failure);
}

int external_force_tables_read(struct source *s, struct packing *p, struct failure *failure)
{
    struct external_force *o = &p->outside;
    if (read_lasting(s, p, failure)) return failure->status;
    int64_t row = table_read_row_at(s, EXTERNAL_HOME "/step", p->step, failure);
    if (failure->status || row < 0) return failure->status;
    if (read_steered(s, row, p, failure) ||
        read_forces(s, "body", row, p->n, &o->force, &o->torque, failure))
        return failure->status;
    if (o->force) external_force_measure(o, p->mass, p->n);
    if (read_words(s, row, o, failure)) return failure->status;
    o->steered = true;
    for (int32_t a = 0; a < p->materials; a++)
        for (int32_t b = 0; b < a; b++)
            if (p->mu[a * p->materials + b] != p->mu[b * p->materials + a])
                return failure_set(failure, EX_DATAERR, EXTERNAL_HOME "/friction: not symmetric");
    return 0;
}

#define FORCE_HOME "/nsd/force"

int pull_tables_read(struct source *s, struct packing *p, struct failure *failure)
{
    if (!source_has(s, FORCE_HOME)) return 0;
    if (signal_tables_read(s, FORCE_HOME, pull_fields, &p->pulls, failure)) return failure->status;
    return source_attribute(s, FORCE_HOME, "acceleration",
                            (struct numbers){ COLUMN_F64, -1, &p->pulls_most }, failure);
}

int pull_tables_write(struct table_write *t, const struct packing *p, struct failure *failure)
{
    if (!p->pulls.n ||
        signal_tables_write(t, FORCE_HOME, pull_fields, &p->pulls, "s; N, N m", failure))
        return failure->status;
    return h5_attr(t->file, FORCE_HOME, "acceleration",
                   h5_scalar(H5T_NATIVE_DOUBLE, &p->pulls_most), failure);
}
