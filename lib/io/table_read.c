#include "io/table_read.h"

#include "io/h5.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The dataset's place among the open ones, where it is put if need be; -1 on failure. */
static int find(struct table_read *r, const char *path, struct why *why)
{
    int i = 0;
    while (i < r->count && strcmp(r->open[i].path, path) != 0) i++;
    if (i < r->count) return i;
    if (i == OPEN_DATASETS) return why_set(why, EX_SOFTWARE, "%s: too many datasets", path), -1;
    hid_t set = H5Dopen2(r->file, path, H5P_DEFAULT);
    if (set < 0) return why_set(why, EX_DATAERR, "%s: no such dataset", path), -1;
    snprintf(r->open[i].path, sizeof r->open[i].path, "%s", path);
    r->open[i].set = set;
    r->open[i].rank = h5_shape(r->file, path, r->open[i].shape);
    return r->count++;
}

int table_read_rows(struct table_read *r, const char *path, enum column_type type, int64_t start,
                    int64_t n, int64_t width, void *out, struct why *why)
{
    int i = find(r, path, why);
    if (i < 0) return why->status;
    hsize_t *shape = r->open[i].shape, row = 1;
    hsize_t first[4] = { (hsize_t)start }, count[4] = { (hsize_t)n };
    for (int k = 1; k < r->open[i].rank; k++) row *= count[k] = shape[k];
    if (r->open[i].rank < 1 || shape[0] < (hsize_t)(start + n) || row != (hsize_t)width)
        return why_set(why, EX_DATAERR, "%s: not of %lld rows of %lld numbers", path,
                       (long long)(start + n), (long long)width);
    if (!n || !width) return 0;
    hid_t space = H5Dget_space(r->open[i].set),
          memory = H5Screate_simple(r->open[i].rank, count, NULL);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, first, NULL, count, NULL);
    herr_t e = H5Dread(r->open[i].set, column_native(type), memory, space, H5P_DEFAULT, out);
    H5Sclose(memory), H5Sclose(space);
    return e < 0 ? why_set(why, EX_DATAERR, "%s: cannot be read as numbers", path) : 0;
}

int table_read_columns(struct table_read *r, const char *where, const char *tail,
                       const struct column *c, int64_t start, int64_t n, void *structs,
                       size_t stride, struct why *why)
{
    for (; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "%s/%s%s", where, c->name, tail);
        char *data = calloc((size_t)n + 1, (size_t)c->width * column_size(c->type));
        if (!data) return why_set(why, EX_SOFTWARE, "%s: no memory", path);
        int e = table_read_rows(r, path, c->type, start, n, c->width, data, why);
        if (!e) column_scatter(c, n, data, structs, stride);
        free(data);
        if (e) return e;
    }
    return 0;
}

void table_read_close(struct table_read *r)
{
    for (int i = 0; i < r->count; i++) H5Dclose(r->open[i].set);
    r->count = 0;
}
