#include "convert/vti.h"

#include <inttypes.h>

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
    for (int k = 0; k < FIELD_COUNT; k++) {
        fprintf(out,
                "<DataArray type=\"Float64\" Name=\"%s\" NumberOfComponents=\"%d\" "
                "format=\"appended\" offset=\"%" PRIu64 "\"/>\n",
                field_quantity[k].name, field_quantity[k].width, offset);
        offset += sizeof offset + fields_file_size_of(f, k);
    }
    fprintf(out, "</PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_");
    for (int k = 0; k < FIELD_COUNT; k++) {
        uint64_t size = fields_file_size_of(f, k);
        fwrite(&size, sizeof size, 1, out);
        fwrite(f->x[k], 1, size, out);
    }
    fprintf(out, "\n</AppendedData>\n</VTKFile>\n");
}
