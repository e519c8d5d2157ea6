#include "file/external_force_tables.h"

#include "file/h5.h"
#include "file/layout.h"
#include "file/tables.h"
#include "file/wall_tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXTERNAL_HOME "/nsd/outside"
#define LASTS         EXTERNAL_HOME "/lasting"

/* ---- to a document ---- */

/* A row of numbers of the frame */
static struct dataset external_force_tables_row_of(const char *path, int rank, const hsize_t *shape,
                                                   const void *data, const char *units)
{
    return (struct dataset){ path, COLUMN_F64, rank, shape, CHUNK_FRAMES, data, units };
}

static int write_walls(struct table_write *s, const struct packing *p, struct failure *failure)
{
    const hsize_t shape[3] = { 1, (hsize_t)p->walls, 3 };
    size_t n = (size_t)p->walls;
    vec3 *x = calloc(2 * n + 1, sizeof *x);
    double *push = calloc(n + 1, sizeof *push);
    if (!x || !push) {
        free(x), free(push);
        return failure_set(failure, EX_SOFTWARE, "no memory for the boundaries");
    }
    for (size_t w = 0; w < n; w++) {
        x[w] = p->wall[w].x, x[n + w] = p->wall[w].v;
        if (p->outside.push) push[w] = p->outside.push[w];
    }
    if (!table_write_rows(s, external_force_tables_row_of(EXTERNAL_HOME "/point", 3, shape, x, "m"),
                          failure) &&
        !table_write_rows(
            s, external_force_tables_row_of(EXTERNAL_HOME "/velocity", 3, shape, x + n, "m s-1"),
            failure))
        table_write_rows(
            s, external_force_tables_row_of(EXTERNAL_HOME "/push", 2, shape, push, "N, N m"),
            failure);
    free(x), free(push);
    return failure->status;
}

/* Of bodies, without which a column has 0 */
static int external_force_tables_write_forces(struct table_write *s, const struct packing *p,
                                              bool any, struct failure *failure)
{
    int64_t n = any ? p->n : 0;
    const hsize_t shape[2] = { (hsize_t)n, 3 };
    vec3 *none = calloc((size_t)n + 1, sizeof *none);
    if (!none) return failure_set(failure, EX_SOFTWARE, "no memory for forces");
    const vec3 *force = any && p->outside.force ? p->outside.force : none;
    const vec3 *torque = any && p->outside.torque ? p->outside.torque : none;
    if (!table_write_span(s, EXTERNAL_HOME "/body", s->forces, n, failure) &&
        !table_write_rows(s,
                          (struct dataset){ EXTERNAL_HOME "/body/force", COLUMN_F64, 2, shape,
                                            CHUNK_CONTACTS, force, "N" },
                          failure))
        table_write_rows(s,
                         (struct dataset){ EXTERNAL_HOME "/body/torque", COLUMN_F64, 2, shape,
                                           CHUNK_CONTACTS, torque, "N m" },
                         failure);
    free(none);
    if (s->growing) s->forces += n;
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
    const hsize_t walls[2] = { 1, (hsize_t)p->walls };
    const int64_t n = o->force || o->torque ? p->n : 0;
    const hsize_t shape[2] = { (hsize_t)n, 3 };
    if (!n && !o->push) return 0;
    vec3 *none = calloc((size_t)n + 1, sizeof *none);
    double *rest = calloc((size_t)p->walls + 1, sizeof *rest);
    if (!none || !rest)
        failure_set(failure, EX_SOFTWARE, "no memory for forces that last");
    else if (!table_write_number(s, LASTS "/step", COLUMN_I64, &p->step, NULL, failure) &&
             !table_write_rows(s,
                               external_force_tables_row_of(LASTS "/push", 2, walls,
                                                            o->push ? o->push : rest, "N, N m"),
                               failure) &&
             !table_write_span(s, EXTERNAL_HOME "/lasting", s->lasting, n, failure) &&
             !table_write_rows(s,
                               (struct dataset){ LASTS "/force", COLUMN_F64, 2, shape,
                                                 CHUNK_CONTACTS, o->force ? o->force : none, "N" },
                               failure))
        table_write_rows(s,
                         (struct dataset){ LASTS "/torque", COLUMN_F64, 2, shape, CHUNK_CONTACTS,
                                           o->torque ? o->torque : none, "N m" },
                         failure);
    free(none), free(rest);
    if (s->growing) s->lasting += n;
    return failure->status;
}

int external_force_tables_write(struct table_write *s, const struct frame *f,
                                struct failure *failure)
{
    const struct packing *p = &f->packing;
    const struct external_force *o = &p->outside;
    const hsize_t row[2] = { 1, 3 },
                  pairs[2] = { 1, (hsize_t)p->materials * (hsize_t)p->materials };
    const double g[3] = { p->g.x, p->g.y, p->g.z };
    if (!f->distributed && write_lasting(s, p, failure)) return failure->status;
    bool forces = f->detected && (o->force || o->torque) && !f->distributed;
    if (!o->steered && !forces && !o->length && !(f->detected && o->push)) return 0;
    if (table_write_number(s, EXTERNAL_HOME "/step", COLUMN_I64, &p->step, NULL, failure) ||
        table_write_rows(s,
                         external_force_tables_row_of(EXTERNAL_HOME "/gravity", 2, row, g, "m s-2"),
                         failure) ||
        table_write_rows(
            s, external_force_tables_row_of(EXTERNAL_HOME "/friction", 2, pairs, p->mu, NULL),
            failure) ||
        write_walls(s, p, failure) || external_force_tables_write_forces(s, p, forces, failure))
        return failure->status;
    return external_force_tables_write_words(s, o, failure);
}

/* ---- from a document ---- */

static int read_walls(struct source *s, int64_t row, struct packing *p, struct failure *failure)
{
    size_t n = (size_t)p->walls;
    vec3 *x = calloc(2 * n + 1, sizeof *x);
    if (!x) return failure_set(failure, EX_SOFTWARE, "no memory for the boundaries");
    if (!source_rows(s, EXTERNAL_HOME "/point", (struct slab){ COLUMN_F64, row, 1, 3 * p->walls },
                     x, failure) &&
        !source_rows(s, EXTERNAL_HOME "/velocity",
                     (struct slab){ COLUMN_F64, row, 1, 3 * p->walls }, x + n, failure) &&
        !external_force_alloc_push(&p->outside, p->walls, failure))
        source_rows(s, EXTERNAL_HOME "/push", (struct slab){ COLUMN_F64, row, 1, p->walls },
                    p->outside.push, failure);
    bool any = false;
    for (size_t w = 0; w < n && !failure->status; w++) {
        if (!v3_finite(x[w]) || !v3_finite(x[n + w]))
            failure_set(failure, EX_DATAERR, EXTERNAL_HOME ": the motion of wall %zu is not finite",
                        w);
        p->wall[w].x = x[w], p->wall[w].v = x[n + w];
        any = any || p->outside.push[w] != 0;
    }
    if (!any) free(p->outside.push), p->outside.push = NULL;
    free(x);
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

static int read_forces(struct source *s, int64_t row, struct packing *p, struct failure *failure)
{
    struct span span = { 0, 0 };
    if (read_span(s, "body", row, p->n, &span, failure) || !span.count) return failure->status;
    const int64_t start = span.start, count = span.count;
    if (count != p->n)
        return failure_set(failure, EX_DATAERR,
                           EXTERNAL_HOME "/body/count: forces of %lld bodies, and there are %lld",
                           (long long)count, (long long)p->n);
    if (external_force_alloc(&p->outside.force, p->n, failure) ||
        external_force_alloc(&p->outside.torque, p->n, failure) ||
        source_rows(s, EXTERNAL_HOME "/body/force", (struct slab){ COLUMN_F64, start, count, 3 },
                    p->outside.force, failure))
        return failure->status;
    if (source_rows(s, EXTERNAL_HOME "/body/torque", (struct slab){ COLUMN_F64, start, count, 3 },
                    p->outside.torque, failure))
        return failure->status;
    external_force_measure(&p->outside, p->mass, p->n);
    return 0;
}

/* NULL where all are 0 */
static void drop_zeros(double **x, int64_t n)
{
    for (int64_t i = 0; i < n; i++)
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

static int read_lasting(struct source *s, struct packing *p, struct failure *failure)
{
    struct lasting *o = &p->outside.lasts;
    struct span span = { 0, 0 };
    int64_t row = table_read_row_at(s, LASTS "/step", p->step, failure);
    if (failure->status || row < 0 || read_span(s, "lasting", row, p->n, &span, failure))
        return failure->status;
    const int64_t start = span.start, count = span.count;
    if (count && count != p->n)
        return failure_set(failure, EX_DATAERR,
                           LASTS "/count: forces of %lld bodies, and there are %lld",
                           (long long)count, (long long)p->n);
    if (!(o->push = calloc((size_t)p->walls + 1, sizeof *o->push)))
        return failure_set(failure, EX_SOFTWARE, "no memory for forces that last");
    if (source_rows(s, LASTS "/push", (struct slab){ COLUMN_F64, row, 1, p->walls }, o->push,
                    failure))
        return failure->status;
    drop_zeros(&o->push, p->walls);
    if (!count) return 0;
    if (external_force_alloc(&o->force, p->n, failure) ||
        external_force_alloc(&o->torque, p->n, failure) ||
        source_rows(s, LASTS "/force", (struct slab){ COLUMN_F64, start, count, 3 }, o->force,
                    failure) ||
        source_rows(s, LASTS "/torque", (struct slab){ COLUMN_F64, start, count, 3 }, o->torque,
                    failure))
        return failure->status;
    drop_vectors(&o->force, p->n), drop_vectors(&o->torque, p->n);
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
    double g[3];
    if (read_lasting(s, p, failure)) return failure->status;
    int64_t row = table_read_row_at(s, EXTERNAL_HOME "/step", p->step, failure);
    if (failure->status || row < 0) return failure->status;
    if (source_rows(s, EXTERNAL_HOME "/gravity", (struct slab){ COLUMN_F64, row, 1, 3 }, g,
                    failure) ||
        source_rows(s, EXTERNAL_HOME "/friction",
                    (struct slab){ COLUMN_F64, row, 1, (int64_t)p->materials * p->materials },
                    p->mu, failure) ||
        read_walls(s, row, p, failure) || read_forces(s, row, p, failure) ||
        read_words(s, row, &p->outside, failure))
        return failure->status;
    p->g = v3(g[0], g[1], g[2]);
    p->outside.steered = true;
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
