#include "io/fields_write.h"

#include "base/output.h"
#include "io/table_write.h"

#include <stdio.h>
#include <stdlib.h>

struct fields_file {
    const char *path;
    struct table_write tables;
    struct output output;
};

static int write_head(hid_t file, const struct fields *f, const char *history, struct why *why)
{
    const int32_t version[2] = { 1, 1 };
    const int64_t points[3] = { f->n[0], f->n[1], f->n[2] };
    const double origin[3] = { f->origin.x, f->origin.y, f->origin.z };
    const double step[3] = { f->step.x, f->step.y, f->step.z };
    int e = h5_group(file, "/h5md/author", why) || h5_group(file, "/h5md/creator", why) ||
            h5_group(file, "/nsd", why) || h5_group(file, "/fields", why);
    if (!e) e = h5_attr(file, "/h5md", "version", h5_vector(H5T_NATIVE_INT32, 2, version), why);
    if (!e) e = h5_attr_text(file, "/h5md/author", "name", "", why);
    if (!e) e = h5_attr_text(file, "/h5md/creator", "name", "nsd", why);
    if (!e) e = h5_attr_text(file, "/h5md/creator", "version", NSD_VERSION, why);
    if (!e) e = h5_attr(file, "/nsd", "version", h5_scalar(H5T_NATIVE_INT32, version), why);
    if (!e) e = h5_attr_text(file, "/nsd", "kind", "fields", why);
    if (!e) e = h5_write_text(file, "/nsd/history", history, why);
    if (!e) e = h5_attr_text(file, "/fields", "function", "gauss", why);
    if (!e) e = h5_attr(file, "/fields", "width", h5_scalar(H5T_NATIVE_DOUBLE, &f->width), why);
    if (!e) e = h5_write(file, "/fields/points", h5_vector(H5T_NATIVE_INT64, 3, points), "1", why);
    if (!e) e = h5_write(file, "/fields/origin", h5_vector(H5T_NATIVE_DOUBLE, 3, origin), "m", why);
    if (!e) h5_write(file, "/fields/spacing", h5_vector(H5T_NATIVE_DOUBLE, 3, step), "m", why);
    return why->status;
}

int fields_file_open(struct fields_file **out, const char *path, const struct fields *fields,
                     const char *history, struct why *why)
{
    struct fields_file *s = *out = calloc(1, sizeof *s);
    if (!s) return why_set(why, EX_SOFTWARE, "no memory");
    h5_start();
    s->path = path, s->tables.growing = true;
    if (output_open(&s->output, path, why)) return why->status;
    char open_already[40];
    snprintf(open_already, sizeof open_already, "/proc/self/fd/%d", s->output.fd);
    hid_t plist = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_obj_track_times(plist, false);
    s->tables.file = H5Fcreate(open_already, H5F_ACC_TRUNC, plist, H5P_DEFAULT);
    H5Pclose(plist);
    if (s->tables.file < 0) return why_set(why, EX_IOERR, "%s: cannot be written", path);
    return write_head(s->tables.file, fields, history, why);
}

int fields_file_add(struct fields_file *s, const struct fields *f, int64_t step, double t,
                    struct why *why)
{
    if (table_write_number(&s->tables, "/fields/step", COLUMN_I64, &step, NULL, why) ||
        table_write_number(&s->tables, "/fields/time", COLUMN_F64, &t, "s", why))
        return why->status;
    for (int k = 0; k < FIELD_COUNT; k++) {
        const struct quantity *q = &field_quantity[k];
        const hsize_t shape[3] = { 1, (hsize_t)fields_points(f), (hsize_t)q->width };
        char path[80];
        snprintf(path, sizeof path, "/fields/%s/value", q->name);
        if (table_write_rows(&s->tables,
                             (struct dataset){ path, COLUMN_F64, q->width == 1 ? 2 : 3, shape, 1,
                                               f->x[k], q->unit },
                             why))
            return why->status;
    }
    return H5Fflush(s->tables.file, H5F_SCOPE_GLOBAL) < 0
               ? why_set(why, EX_IOERR, "%s: cannot be written (disk full?)", s->path)
               : 0;
}

int fields_file_close(struct fields_file *s, struct why *why)
{
    if (table_write_close(&s->tables) | (H5Fclose(s->tables.file) < 0))
        why_set(why, EX_IOERR, "%s: cannot be written (disk full?)", s->path);
    output_close(&s->output, why);
    free(s);
    return why->status;
}
