#include "io/table_read.h"

#include <stdio.h>
#include <stdlib.h>

int table_read_columns(struct source *s, const char *group, const char *tail,
                       const struct column *c, int64_t start, int64_t n, void *structs,
                       size_t stride, struct why *why)
{
    for (; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "%s/%s%s", group, c->name, tail);
        char *data = calloc((size_t)n + 1, (size_t)c->width * column_size(c->type));
        if (!data) return why_set(why, EX_SOFTWARE, "%s: no memory", path);
        int e = source_rows(s, path, c->type, start, n, c->width, data, why);
        if (!e) column_scatter(c, n, data, structs, stride);
        free(data);
        if (e) return e;
    }
    return 0;
}

int64_t *table_read_steps(struct source *source, const char *path, int64_t *n, struct why *why)
{
    uint64_t count = 0;
    int64_t *steps = source_read_all(source, path, COLUMN_I64, &count, why);
    *n = (int64_t)count;
    return steps;
}

int64_t table_read_row(const int64_t *steps, int64_t n, int64_t step, int64_t guess)
{
    if (guess < n && steps[guess] == step) return guess;
    while (--n >= 0 && steps[n] != step) continue;
    return n;
}
