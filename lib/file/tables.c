#include "file/tables.h"

#include "file/h5.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int check_finite(const char *path, const struct field *c, int64_t n, const void *data,
                        struct failure *failure)
{
    const double *x = data;
    for (int64_t k = 0; c->type == COLUMN_F64 && k < n * c->width; k++)
        if (!isfinite(x[k]))
            return failure_set(failure, EX_DATAERR, "%s: a number is not finite", path);
    return 0;
}

/* Has the document the field? Of those that follow each other and have one predicate, the first decides. */
static bool tables_has(struct source *s, const char *path, const struct field *f,
                       const struct records *o, bool before)
{
    if (!f->when && !(f->traits & FIELD_OPTIONAL)) return true;
    if (f->when && o->of) return f->when(o->of);
    const bool follows = f->when && f > o->fields && f[-1].when == f->when;
    return follows ? before : source_has(s, path);
}

static int tables_read_columns(struct source *s, const char *group, const char *tail, int64_t start,
                               struct records o, bool finite, struct failure *failure)
{
    bool there = true;
    for (const struct field *c = o.fields; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "%s/%s%s", group, c->name, tail);
        if (!(there = tables_has(s, path, c, &o, there))) continue;
        char *data = calloc((size_t)o.n + 1, field_bytes(c));
        if (!data) return failure_set(failure, EX_SOFTWARE, "%s: no memory", path);
        int e = source_rows(s, path, (struct slab){ c->type, start, o.n, c->width }, data, failure);
        if (!e && finite) e = check_finite(path, c, o.n, data, failure);
        if (!e) field_scatter(c, o.n, data, o.structs, o.stride);
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

int table_read_frame(struct source *s, const char *group, int64_t k, struct records o,
                     struct failure *failure)
{
    for (const struct field *c = o.fields; c->name; c++) {
        char path[80];
        uint64_t shape[4];
        snprintf(path, sizeof path, "%s/%s/value", group, c->name);
        // no memory is allocated for rows that are not there
        if (source_shape(s, path, shape) != (c->width == 1 ? 2 : 3) || shape[1] != (uint64_t)o.n)
            return failure_set(failure, EX_DATAERR, "%s: not of shape frames x %lld x %d", path,
                               (long long)o.n, c->width);
        char *row = calloc((size_t)o.n + 1, field_bytes(c));
        if (!row) return failure_set(failure, EX_SOFTWARE, "%s: no memory", path);
        if (!source_rows(s, path, (struct slab){ c->type, k, 1, o.n * c->width }, row, failure))
            field_scatter(c, o.n, row, o.structs, o.stride);
        free(row);
        if (failure->status) return failure->status;
    }
    return 0;
}

int table_read_list(struct source *s, struct table_spans table, int64_t k, struct list_of list,
                    struct records rows, struct failure *failure)
{
    struct span span;
    if (table_read_span(s, table, k, &span, failure)) return failure->status;
    if (!(rows.structs = calloc((size_t)span.count + 1, rows.stride)))
        return failure_set(failure, EX_SOFTWARE, "%s: no memory", table.group);
    memcpy(list.rows, &rows.structs, sizeof rows.structs);
    *list.n = span.count, *list.room = span.count + 1;
    rows.n = span.count;
    return table_read_columns(s, table.group, "", span.start, rows, failure);
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

int64_t *table_read_steps(struct source *source, const char *path, int64_t *n,
                          struct failure *failure)
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

/* Room for bodies to come, in datasets of [frames][bodies]; in frames before they came, their rows
   say so: their id is -1, their numbers are no numbers. */
static void tables_make_room(const struct table_write *s, const struct dataset *o, hsize_t most[4],
                             hsize_t chunk[4], hid_t plist)
{
    const double none = NAN;
    const int32_t nobody = -1;
    size_t n = strlen(o->path);
    bool frames = !strncmp(o->path, "/particles/all/", 15) && !strcmp(o->path + n - 6, "/value");
    if (!s->most_bodies || o->rank < 2 || !frames) return;
    most[1] = s->most_bodies, chunk[1] = s->chunk_bodies;
    H5Pset_fill_value(plist, column_native(o->type),
                      o->type == COLUMN_F64 ? (const void *)&none : (const void *)&nobody);
}

static hid_t tables_create(const struct table_write *s, const struct dataset *o,
                           struct failure *failure)
{
    const char *path = o->path;
    const hsize_t *shape = o->shape;
    const int rank = o->rank;
    bool later = !o->data;
    hsize_t empty[4] = { 0 }, most[4] = { H5S_UNLIMITED }, chunk[4] = { o->chunk_rows };
    for (int k = 1; k < rank; k++) {
        empty[k] = most[k] = shape[k];
        chunk[k] = shape[k] < 1 ? 1 : shape[k] > CHUNK_BODIES ? CHUNK_BODIES : shape[k];
    }
    hid_t file = s->file, plist = h5_dataset_plist();
    for (int k = 0; k < rank; k++) later = later && shape[k];
    if (later) h5_fill_later(plist);
    tables_make_room(s, o, most, chunk, plist);
    char parent[80];
    snprintf(parent, sizeof parent, "%.*s", (int)(strrchr(path, '/') - path), path);
    if (h5_group(file, parent, failure)) {
        H5Pclose(plist);
        return -1;
    }
    hid_t space = H5Screate_simple(rank, empty, most);
    hid_t disk = H5Tcopy(column_native(o->type));
    H5Tset_order(disk, H5T_ORDER_LE);
    H5Pset_chunk(plist, rank, chunk);
    hid_t uncached =
        H5Pcreate(H5P_DATASET_ACCESS); // so that numbers reach the disk before the shape does
    H5Pset_chunk_cache(uncached, 0, 0, 0);
    hid_t set = H5Dcreate2(file, path, disk, space, H5P_DEFAULT, plist, uncached);
    H5Tclose(disk), H5Pclose(plist), H5Pclose(uncached), H5Sclose(space);
    if (set < 0) return failure_set(failure, EX_IOERR, "%s: cannot be made", path), -1;
    if (!o->units || !h5_attr_text(file, path, "units", o->units, failure)) return set;
    H5Dclose(set);
    return -1;
}

static hid_t tables_find(const struct table_write *s, const char *path)
{
    for (int i = 0; i < s->count; i++)
        if (!strcmp(s->open[i].path, path)) return s->open[i].set;
    return -1;
}

bool table_write_grows(const struct table_write *s, const char *path)
{
    return tables_find(s, path) >= 0;
}

static int tables_append(hid_t set, const struct dataset *o)
{
    const int rank = o->rank;
    const hsize_t *shape = o->shape;
    hsize_t size[4], start[4] = { 0 };
    hid_t space = H5Dget_space(set);
    bool known = H5Sget_simple_extent_dims(space, size, NULL) == rank;
    if (space >= 0) H5Sclose(space);
    if (!known) return -1;
    start[0] = size[0];
    size[0] += shape[0];
    for (int k = 1; k < rank; k++) size[k] = shape[k] > size[k] ? shape[k] : size[k];
    if (H5Dset_extent(set, size) < 0) return -1;
    hid_t disk = H5Dget_space(set), memory = H5Screate_simple(rank, shape, NULL);
    bool good = disk >= 0 && memory >= 0 &&
                H5Sselect_hyperslab(disk, H5S_SELECT_SET, start, NULL, shape, NULL) >= 0;
    if (good && o->data && H5Sget_simple_extent_npoints(memory) > 0)
        good = H5Dwrite(set, column_native(o->type), memory, disk, H5P_DEFAULT, o->data) >= 0;
    if (memory >= 0) H5Sclose(memory);
    if (disk >= 0) H5Sclose(disk);
    return good ? 0 : -1;
}

int table_write_rows(struct table_write *s, struct dataset o, struct failure *failure)
{
    if (!s->growing)
        return h5_write(s->file, o.path, h5_array(column_native(o.type), o.rank, o.shape, o.data),
                        o.units, failure);
    hid_t set = tables_find(s, o.path);
    if (set < 0) {
        if (s->count == GROWING_DATASETS)
            return failure_set(failure, EX_SOFTWARE, "%s: too many datasets", o.path);
        set = tables_create(s, &o, failure);
        if (set < 0) return failure->status;
        snprintf(s->open[s->count].path, sizeof s->open[0].path, "%s", o.path);
        s->open[s->count++].set = set;
    }
    return tables_append(set, &o)
               ? failure_set(failure, EX_IOERR, "%s: cannot be written (disk full?)", o.path)
               : 0;
}

int table_write_number(struct table_write *s, const char *path, enum column_type type,
                       const void *number, const char *units, struct failure *failure)
{
    const hsize_t one = 1;
    const struct dataset o = { path, type, 1, &one, CHUNK_FRAMES, number, units };
    return table_write_rows(s, o, failure);
}

int table_write_span(struct table_write *s, const char *group, int64_t start, int64_t count,
                     struct failure *failure)
{
    char path[80];
    snprintf(path, sizeof path, "%s/start", group);
    if (table_write_number(s, path, COLUMN_I64, &start, NULL, failure)) return failure->status;
    snprintf(path, sizeof path, "%s/count", group);
    return table_write_number(s, path, COLUMN_I64, &count, NULL, failure);
}

/* Frames that the dataset has, less one */
static int64_t last_frame(const struct table_write *s, const char *path)
{
    hsize_t size[4] = { 1 };
    hid_t set = tables_find(s, path), space = set < 0 ? -1 : H5Dget_space(set);
    if (space >= 0) H5Sget_simple_extent_dims(space, size, NULL), H5Sclose(space);
    return (int64_t)size[0] - 1;
}

static int write_body_column(struct table_write *s, const struct field *b, const struct packing *p,
                             struct failure *failure)
{
    const struct field *c = b;
    const hsize_t n = (hsize_t)(s->distributed ? s->distributed->n : p->n);
    const hsize_t shape[3] = { 1, n, (hsize_t)c->width };
    const void *data = s->distributed ? NULL : field_array(c, p);
    bool moves = b->traits & FIELD_MOVES;
    char path[80];
    layout_body_path(b, path);
    if (moves ? table_write_rows(s, (struct dataset){ path, c->type, 3, shape, 1, data, c->units },
                                 failure)
              : h5_write(s->file, path,
                         h5_array(column_native(c->type), c->width == 1 ? 1 : 2, shape + 1, data),
                         c->units, failure))
        return failure->status;
    if (!s->distributed) return 0;
    if (s->places == DISTRIBUTED_PLACES)
        return failure_set(failure, EX_SOFTWARE, "%s: too many columns", path);
    struct unfilled *o = &s->place[s->places++];
    *o = (struct unfilled){ .column = c, .frame = moves ? last_frame(s, path) : -1 };
    snprintf(o->path, sizeof o->path, "%s", path);
    return 0;
}

int table_write_bodies(struct table_write *s, bool moving, const struct packing *p,
                       struct failure *failure)
{
    for (const struct field *b = body_columns; b->name; b++)
        if (field_array(b, p) && !(b->traits & FIELD_MOVES) == !moving &&
            write_body_column(s, b, p, failure))
            return failure->status;
    return 0;
}

int table_write_columns(struct table_write *s, const char *where, const char *tail,
                        struct records o, hsize_t chunk_rows, struct failure *failure)
{
    for (const struct field *c = o.fields; c->name; c++) {
        char path[80];
        if (!field_is_kept(c, &o)) continue;
        snprintf(path, sizeof path, "%s/%s%s", where, c->name, tail);
        void *data = malloc((size_t)(o.n + 1) * field_bytes(c));
        if (!data) return failure_set(failure, EX_SOFTWARE, "no memory for %s", path);
        field_gather(c, o.n, o.structs, o.stride, data);
        const bool matrix = c->width == 9;
        const hsize_t shape[3] = { (hsize_t)o.n, matrix ? 3 : (hsize_t)c->width, 3 };
        const int rank = c->width == 1 ? 1 : matrix ? 3 : 2;
        int e = table_write_rows(
            s, (struct dataset){ path, c->type, rank, shape, chunk_rows, data, c->units }, failure);
        free(data);
        if (e) return e;
    }
    return 0;
}

int table_write_frame(struct table_write *s, const char *group, struct records o,
                      hsize_t chunk_frames, struct failure *failure)
{
    for (const struct field *c = o.fields; !failure->status && c->name; c++) {
        char path[80];
        const hsize_t shape[3] = { 1, (hsize_t)o.n, (hsize_t)c->width };
        void *row = malloc((size_t)(o.n + 1) * field_bytes(c));
        snprintf(path, sizeof path, "%s/%s/value", group, c->name);
        if (!row) return failure_set(failure, EX_SOFTWARE, "no memory for %s", path);
        field_gather(c, o.n, o.structs, o.stride, row);
        table_write_rows(s,
                         (struct dataset){ path, c->type, c->width == 1 ? 2 : 3, shape,
                                           chunk_frames, row, c->units },
                         failure);
        free(row);
    }
    return failure->status;
}

int table_write_list(struct table_write *s, const char *group, int64_t *so_far, struct records rows,
                     struct failure *failure)
{
    if (table_write_span(s, group, *so_far, rows.n, failure) ||
        table_write_columns(s, group, "", rows, CHUNK_CONTACTS, failure))
        return failure->status;
    if (s->growing) *so_far += rows.n;
    return 0;
}

int table_write_once(struct table_write *s, const char *group, struct records rows,
                     struct failure *failure)
{
    const bool growing = s->growing;
    s->growing = false;
    table_write_columns(s, group, "", rows, 0, failure);
    s->growing = growing;
    return failure->status;
}

int table_write_close(struct table_write *s)
{
    herr_t e = 0;
    for (int i = 0; i < s->count; i++) e |= H5Dclose(s->open[i].set);
    s->count = 0;
    return e < 0 ? -1 : 0;
}

int table_write_link(struct table_write *s, const char *from, const char *name, const char *where,
                     const struct field *c, struct failure *failure)
{
    char to[80];
    for (; c->name; c++) {
        snprintf(to, sizeof to, "%s/%s/%s", where, c->name, name);
        if (h5_has(s->file, to)) continue; // this is where it was written
        if (H5Lcreate_hard(s->file, from, s->file, to, H5P_DEFAULT, H5P_DEFAULT) < 0)
            return failure_set(failure, EX_IOERR, "%s: cannot be linked", to);
    }
    return 0;
}

/* A number of the frame, WHERE/name, that is linked to the columns when it is first written */
static int write_clock(struct table_write *s, const char *where, const struct field *columns,
                       struct dataset o, struct failure *failure)
{
    char path[80];
    snprintf(path, sizeof path, "%s/%s", where, o.path);
    bool linked = table_write_grows(s, path);
    if (table_write_number(s, path, o.type, o.data, o.units, failure)) return failure->status;
    return linked ? 0 : table_write_link(s, path, o.path, where, columns, failure);
}

int table_write_clocks(struct table_write *s, const char *where, const struct field *columns,
                       int64_t step, double time, struct failure *failure)
{
    const struct dataset steps = { .path = "step", .type = COLUMN_I64, .data = &step };
    const struct dataset times = {
        .path = "time", .type = COLUMN_F64, .data = &time, .units = "s"
    };
    return write_clock(s, where, columns, steps, failure) ||
                   write_clock(s, where, columns, times, failure)
               ? failure->status
               : 0;
}
