#include "convert/fields_file.h"

#include "base/output.h"
#include "file/tables.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

struct fields_file {
    const char *path;
    struct table_write tables;
    struct output output;
};

static int write_head(hid_t file, const struct fields *f, const char *history,
                      struct failure *failure)
{
    const int32_t version[2] = { 1, 1 };
    const int64_t points[3] = { f->n[0], f->n[1], f->n[2] };
    const double origin[3] = { f->origin.x, f->origin.y, f->origin.z };
    const double step[3] = { f->step.x, f->step.y, f->step.z };
    int e = h5_group(file, "/h5md/author", failure) || h5_group(file, "/h5md/creator", failure) ||
            h5_group(file, "/nsd", failure) || h5_group(file, "/fields", failure);
    if (!e) e = h5_attr(file, "/h5md", "version", h5_vector(H5T_NATIVE_INT32, 2, version), failure);
    if (!e) e = h5_attr_text(file, "/h5md/author", "name", "", failure);
    if (!e) e = h5_attr_text(file, "/h5md/creator", "name", "nsd", failure);
    if (!e) e = h5_attr_text(file, "/h5md/creator", "version", NSD_VERSION, failure);
    if (!e) e = h5_attr(file, "/nsd", "version", h5_scalar(H5T_NATIVE_INT32, version), failure);
    if (!e) e = h5_attr_text(file, "/nsd", "kind", "fields", failure);
    if (!e) e = h5_write_text(file, "/nsd/history", history, failure);
    if (!e) e = h5_attr_text(file, "/fields", "function", "gauss", failure);
    if (!e) e = h5_attr(file, "/fields", "width", h5_scalar(H5T_NATIVE_DOUBLE, &f->width), failure);
    if (!e)
        e = h5_write(file, "/fields/points", h5_vector(H5T_NATIVE_INT64, 3, points), "1", failure);
    if (!e)
        e = h5_write(file, "/fields/origin", h5_vector(H5T_NATIVE_DOUBLE, 3, origin), "m", failure);
    if (!e) h5_write(file, "/fields/spacing", h5_vector(H5T_NATIVE_DOUBLE, 3, step), "m", failure);
    return failure->status;
}

int fields_file_open(struct fields_file **out, const char *path, const struct fields *fields,
                     const char *history, struct failure *failure)
{
    struct fields_file *s = *out = calloc(1, sizeof *s);
    if (!s) return failure_set(failure, EX_SOFTWARE, "no memory");
    h5_start();
    s->path = path, s->tables.growing = true;
    if (output_open(&s->output, path, failure)) return failure->status;
    char open_already[40];
    snprintf(open_already, sizeof open_already, "/proc/self/fd/%d", s->output.fd);
    hid_t plist = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_obj_track_times(plist, false);
    s->tables.file = H5Fcreate(open_already, H5F_ACC_TRUNC, plist, H5P_DEFAULT);
    H5Pclose(plist);
    if (s->tables.file < 0) return failure_set(failure, EX_IOERR, "%s: cannot be written", path);
    return write_head(s->tables.file, fields, history, failure);
}

int fields_file_add(struct fields_file *s, const struct fields *f, int64_t step, double t,
                    struct failure *failure)
{
    if (table_write_number(&s->tables, "/fields/step", COLUMN_I64, &step, NULL, failure) ||
        table_write_number(&s->tables, "/fields/time", COLUMN_F64, &t, "s", failure))
        return failure->status;
    for (int k = 0; k < CONTINUUM_COUNT; k++) {
        const struct quantity *q = &field_quantity[k];
        const hsize_t shape[3] = { 1, (hsize_t)fields_points(f), (hsize_t)q->width };
        char path[80];
        snprintf(path, sizeof path, "/fields/%s/value", q->name);
        if (table_write_rows(&s->tables,
                             (struct dataset){ path, COLUMN_F64, q->width == 1 ? 2 : 3, shape, 1,
                                               f->x[k], q->unit },
                             failure))
            return failure->status;
    }
    return H5Fflush(s->tables.file, H5F_SCOPE_GLOBAL) < 0
               ? failure_set(failure, EX_IOERR, "%s: cannot be written (disk full?)", s->path)
               : 0;
}

int fields_file_close(struct fields_file *s, struct failure *failure)
{
    if (table_write_close(&s->tables) | (H5Fclose(s->tables.file) < 0))
        failure_set(failure, EX_IOERR, "%s: cannot be written (disk full?)", s->path);
    output_close(&s->output, failure);
    free(s);
    return failure->status;
}

static uint64_t fields_file_size_of(const struct fields *f, int k)
{
    return (uint64_t)fields_points(f) * (uint64_t)field_quantity[k].width * sizeof(double);
}

void vti_write(FILE *out, const struct fields *f, int64_t step, double t)
{
    const uint16_t one = 1;
    const char *order = *(const char *)&one ? "LittleEndian" : "BigEndian";
    char extent[100];
    uint64_t offset = 0;
    snprintf(extent, sizeof extent, "0 %" PRId64 " 0 %" PRId64 " 0 %" PRId64, f->n[0] - 1,
             f->n[1] - 1, f->n[2] - 1);
    fprintf(out,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
            "byte_order=\"%s\" header_type=\"UInt64\">\n<ImageData WholeExtent=\"%s\" "
            "Origin=\"%.17g %.17g %.17g\" Spacing=\"%.17g %.17g %.17g\">\n<FieldData>\n"
            "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">"
            "%.17g</DataArray>\n"
            "<DataArray type=\"Int64\" Name=\"step\" NumberOfTuples=\"1\" format=\"ascii\">"
            "%" PRId64 "</DataArray>\n</FieldData>\n<Piece Extent=\"%s\">\n<PointData>\n",
            order, extent, f->origin.x, f->origin.y, f->origin.z, f->step.x, f->step.y, f->step.z,
            t, step, extent);
    for (int k = 0; k < CONTINUUM_COUNT; k++) {
        fprintf(out,
                "<DataArray type=\"Float64\" Name=\"%s\" NumberOfComponents=\"%d\" "
                "format=\"appended\" offset=\"%" PRIu64 "\"/>\n",
                field_quantity[k].name, field_quantity[k].width, offset);
        offset += sizeof offset + fields_file_size_of(f, k);
    }
    fprintf(out, "</PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_");
    for (int k = 0; k < CONTINUUM_COUNT; k++) {
        uint64_t size = fields_file_size_of(f, k);
        fwrite(&size, sizeof size, 1, out);
        fwrite(f->x[k], 1, size, out);
    }
    fprintf(out, "\n</AppendedData>\n</VTKFile>\n");
}
