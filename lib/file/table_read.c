#include "file/table_read.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static int check_finite(const char *path, const struct column *c, int64_t n, const void *data,
                        struct failure *failure)
{
    const double *x = data;
    for (int64_t k = 0; c->type == COLUMN_F64 && k < n * c->width; k++)
        if (!isfinite(x[k])) return failure_set(failure, EX_DATAERR, "%s: a number is not finite", path);
    return 0;
}

static int tables_read_columns(struct source *s, const char *group, const char *tail, int64_t start,
                        struct records o, bool finite, struct failure *failure)
{
    for (const struct column *c = o.columns; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "%s/%s%s", group, c->name, tail);
        char *data = calloc((size_t)o.n + 1, column_bytes(c));
        if (!data) return failure_set(failure, EX_SOFTWARE, "%s: no memory", path);
        int e = source_rows(s, path, (struct slab){ c->type, start, o.n, c->width }, data, failure);
        if (!e && finite) e = check_finite(path, c, o.n, data, failure);
        if (!e) column_scatter(c, o.n, data, o.structs, o.stride);
        free(data);
        if (e) return e;
    }
    return 0;
}

int table_read_columns(struct source *s, const char *group, const char *tail, int64_t start,
                       struct records o, struct failure *failure)
{
    return tables_read_columns(s, group, tail, start, o, false, failure);
}

int table_read_finite(struct source *s, const char *group, const char *tail, int64_t start,
                      struct records o, struct failure *failure)
{
    return tables_read_columns(s, group, tail, start, o, true, failure);
}

int table_read_span(struct source *r, struct table_spans table, int64_t k, struct span *span,
                    struct failure *failure)
{
    const struct slab number = { COLUMN_I64, k, 1, 1 };
    char path[80];
    uint64_t shape[4];
    snprintf(path, sizeof path, "%s/start", table.group);
    if (source_rows(r, path, number, &span->start, failure)) return failure->status;
    snprintf(path, sizeof path, "%s/count", table.group);
    if (source_rows(r, path, number, &span->count, failure)) return failure->status;
    snprintf(path, sizeof path, "%s/%s", table.group, table.one);
    if (source_shape(r, path, shape) != table.rank || span->start < 0 || span->count < 0 ||
        span->start > INT32_MAX || span->count > INT32_MAX ||
        (uint64_t)(span->start + span->count) > shape[0])
        return failure_set(failure, EX_DATAERR, "%s: start or count is out of range", table.group);
    return 0;
}

int64_t *table_read_steps(struct source *source, const char *path, int64_t *n, struct failure *failure)
{
    uint64_t count = 0;
    int64_t *steps = source_read_all(source, path, COLUMN_I64, &count, failure);
    *n = (int64_t)count;
    return steps;
}

int64_t table_read_rising(const int64_t *steps, int64_t n)
{
    int64_t rising = n > 0;
    while (rising < n && steps[rising] > steps[rising - 1]) rising++;
    return rising;
}

int64_t table_read_row(const int64_t *steps, int64_t n, int64_t step)
{
    int64_t lo = 0, hi = n; // steps[lo - 1] < step <= steps[hi]
    while (lo < hi) {
        int64_t middle = lo + (hi - lo) / 2;
        *(steps[middle] < step ? &lo : &hi) = steps[middle] < step ? middle + 1 : middle;
    }
    return lo < n && steps[lo] == step ? lo : -1;
}

int64_t table_read_row_at(struct source *s, const char *path, int64_t step, struct failure *failure)
{
    int64_t n = 0;
    if (!source_has(s, path)) return -1;
    int64_t *steps = table_read_steps(s, path, &n, failure);
    int64_t row = steps ? table_read_row(steps, table_read_rising(steps, n), step) : -1;
    free(steps);
    return row;
}
