#include "file/wall_load_tables.h"

#include "file/h5.h"
#include "file/layout.h"
#include "state/wall_faces.h"

#include <stdio.h>
#include <stdlib.h>

#define SUMS_HOME "/particles/boundary/sums"

enum { FEW = 64 /* faces: a chunk has many frames of these, else one */ };

static void path_of(const struct field *c, char path[80])
{
    snprintf(path, 80, SUMS_HOME "/%s/value", c->name);
}

int sum_tables_write_static(struct table_write *s, const struct packing *p, struct failure *failure)
{
    if (!p->sums.n) return 0;
    s->sums_since = p->sums.since;
    if (h5_group(s->file, SUMS_HOME, failure)) return failure->status;
    return h5_attr(s->file, SUMS_HOME, "since", h5_scalar(H5T_NATIVE_DOUBLE, &p->sums.since),
                   failure);
}

/* May the trajectory take a frame with sums, or without? They are there from its first frame on, or in none. */
static int check_kept(const struct table_write *s, const struct packing *p, struct failure *failure)
{
    char path[80];
    path_of(sum_fields, path);
    bool first = !table_write_grows(s, "/particles/all/position/step");
    if (!s->growing || first) return 0;
    if (p->sums.n && p->sums.since != s->sums_since)
        return failure_set(
            failure, EX_DATAERR,
            "sums of walls that began at %g s, and before at %g s: begin another trajectory",
            p->sums.since, s->sums_since);
    if (table_write_grows(s, path) == (p->sums.n > 0)) return 0;
    return failure_set(failure, EX_DATAERR,
                       "sums of walls in some frames, and not in others: begin another trajectory");
}

int sum_tables_write(struct table_write *s, const struct packing *p, struct failure *failure)
{
    const int32_t n = p->sums.n;
    if (check_kept(s, p, failure) || !n) return failure->status;
    table_write_frame(s, SUMS_HOME, RECORDS(sum_fields, n, p->sums.face),
                      n < FEW ? CHUNK_FRAMES : 1, failure);
    return failure->status ? failure->status
                           : table_write_clocks(s, SUMS_HOME, sum_fields, p->step, p->t, failure);
}

int sum_tables_read(struct source *r, int64_t k, struct packing *p, struct failure *failure)
{
    uint64_t shape[4];
    char path[80];
    path_of(sum_fields, path);
    struct wall_faces faces;
    if (!source_has(r, path)) return 0;
    if (wall_faces_init(&faces, p->walls, p->wall, NULL, failure)) return failure->status;
    const int32_t n = faces.n;
    wall_faces_free(&faces);
    // no memory is allocated for faces without sums
    if (source_shape(r, path, shape) != 3 || shape[1] != (uint64_t)n)
        return failure_set(failure, EX_DATAERR, "%s: not of shape frames x %d faces x 3", path, n);
    if (sums_begin(&p->sums, p->walls, p->wall, p->t, failure)) return failure->status;
    if (table_read_frame(r, SUMS_HOME, k, RECORDS(sum_fields, n, p->sums.face), failure))
        return failure->status;
    return source_attribute(r, SUMS_HOME, "since",
                            (struct numbers){ COLUMN_F64, -1, &p->sums.since }, failure);
}
