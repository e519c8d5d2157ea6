/*
 * convert/vtk.c: VTK's XML files of polygons (.vtp) and of cells (.vtu), for ParaView: a text that says
 * what there is, and behind it the numbers as they are in memory, each array after its length
 * [VTK file formats, "appended", encoding "raw"]. What is a row of the sheet's columns becomes data
 * of points or of cells; the time is in the field TimeValue, the step in `step`.
 */
#include "convert/vtk.h"

#include "convert/format.h"
#include "convert/sheet.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { DETAIL = 1 /* of what is round: 80 triangles a ball */ };

static const enum part part_of[] = { PART_SURFACES, PART_WALLS };
static const char *const path_of[] = { "/VTKHDF/surfaces", "/VTKHDF/walls" };

/* Columns that say which grain or wall a cell is of; what else a sheet has is in the grains. */
static bool vtk_is_wanted(const struct sheet_column *c)
{
    static const char *const wanted[] = { "id", "material", "shape", "wall" };
    bool any = false;
    for (size_t k = 0; c->whole && k < sizeof wanted / sizeof *wanted; k++)
        any |= !strcmp(c->name, wanted[k]);
    return any;
}

static int vtk_make(struct vtkhdf_cells *cells, const struct packing *p, int k, void **made,
                    struct failure *failure)
{
    const struct export_frame m = { .packing = p, .detail = DETAIL };
    struct sheet *s = *made = calloc(1, sizeof *s);
    if (!s) return failure_set(failure, EX_SOFTWARE, "no memory for an export");
    if (sheet_of(s, part_of[k], &m, failure)) return failure->status;
    *cells = (struct vtkhdf_cells){ .points = s->points,
                                    .cells = s->cells,
                                    .corners = s->corners,
                                    .x = s->x,
                                    .corner = s->corner,
                                    .end = s->end,
                                    .lines = s->shape == SHEET_LINE };
    for (int i = 0; i < s->columns && cells->columns < VTKHDF_COLUMNS; i++) {
        if (!vtk_is_wanted(&s->column[i])) continue;
        cells->column[cells->columns].name = s->column[i].name;
        cells->column[cells->columns++].value = s->column[i].whole;
    }
    return 0;
}

static void vtk_done(void *made)
{
    if (made) sheet_free(made);
    free(made);
}

const struct vtkhdf_parts vtk_parts = { 2, path_of, vtk_make, vtk_done };

static const char head[] =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n"
    "<Collection>\n";
static const char tail[] = "</Collection>\n</VTKFile>\n";

/* The list takes the place of the one before in one stroke: who reads a file that is written over may get a part of both. */
static int pvd_write(const struct pvd *l, const char *path, struct failure *failure)
{
    struct output file;
    FILE *out = output_stream(&file, path, failure);
    if (!out) return failure->status;
    fprintf(out, "%s%s%s", head, l->entries, tail);
    return output_stream_close(&file, out, failure);
}

int pvd_add(struct pvd *l, const char *path, const char *name, double time, struct failure *failure)
{
    char entry[160];
    const size_t n = (size_t)snprintf(
        entry, sizeof entry, "<DataSet timestep=\"%.17g\" part=\"0\" file=\"%s\"/>\n", time, name);
    if (l->length + n + 1 > l->room) {
        const size_t room = 2 * l->room + sizeof entry;
        char *more = realloc(l->entries, room);
        if (!more) return failure_set(failure, EX_SOFTWARE, "%s: no memory for the list", path);
        l->entries = more, l->room = room;
    }
    memcpy(l->entries + l->length, entry, n + 1);
    l->length += n;
    return pvd_write(l, path, failure);
}

void pvd_free(struct pvd *l)
{
    free(l->entries);
    *l = (struct pvd){ 0 };
}

/* An array in the appended part: what it is called there and where it is */
struct vtk_block {
    const char *name, *type;
    int width;
    uint64_t size; /* bytes */
    const void *data;
};

enum { BLOCKS = SHEET_COLUMNS + 4 };

static void name_block(FILE *out, const struct vtk_block *b, uint64_t *offset)
{
    fprintf(out,
            "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"appended\" "
            "offset=\"%" PRIu64 "\"/>\n",
            b->type, b->name, b->width, *offset);
    *offset += sizeof b->size + b->size;
}

static void vtk_put_block(FILE *out, const struct vtk_block *b)
{
    fwrite(&b->size, sizeof b->size, 1, out);
    if (b->size) fwrite(b->data, 1, b->size, out);
}

static void open_file(FILE *out, const char *type, const struct export_frame *m)
{
    const uint16_t one = 1;
    const char *order = *(const char *)&one ? "LittleEndian" : "BigEndian";
    fprintf(out,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"%s\" version=\"1.0\" byte_order=\"%s\" "
            "header_type=\"UInt64\">\n<%s>\n<FieldData>\n"
            "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">"
            "%.17g</DataArray>\n"
            "<DataArray type=\"Int64\" Name=\"step\" NumberOfTuples=\"1\" format=\"ascii\">"
            "%" PRId64 "</DataArray>\n</FieldData>\n",
            type, order, type, m->packing->t, m->packing->step);
}

/* Points, their data and that of the cells; b[0] is the points, b[1] ... the columns. */
static void name_columns(FILE *out, const struct sheet *s, const struct vtk_block *b,
                         uint64_t *offset)
{
    fprintf(out, "<Points>\n");
    name_block(out, &b[0], offset);
    fprintf(out, "</Points>\n<%s>\n", s->of_points ? "PointData" : "CellData");
    for (int k = 0; k < s->columns; k++) name_block(out, &b[1 + k], offset);
    fprintf(out, "</%s>\n", s->of_points ? "PointData" : "CellData");
}

/* The arrays that both kinds of file begin with; returns how many. */
static int list_blocks(struct vtk_block *b, const struct sheet *s)
{
    int n = 0;
    const uint64_t rows = (uint64_t)sheet_rows(s);
    b[n++] = (struct vtk_block){ "Points", "Float64", 3, (uint64_t)s->points * sizeof *s->x, s->x };
    for (int k = 0; k < s->columns; k++) {
        const struct sheet_column *c = &s->column[k];
        uint64_t numbers = rows * (uint64_t)c->width;
        b[n++] = c->real ? (struct vtk_block){ c->name, "Float64", c->width, 8 * numbers, c->real }
                         : (struct vtk_block){ c->name, "Int32", c->width, 4 * numbers, c->whole };
    }
    b[n++] = (struct vtk_block){ "connectivity", "Int64", 1, (uint64_t)s->corners * 8, s->corner };
    b[n++] = (struct vtk_block){ "offsets", "Int64", 1, (uint64_t)s->cells * 8, s->end };
    return n;
}

static void close_file(FILE *out, const char *type, const struct vtk_block *b, int blocks)
{
    fprintf(out, "</Piece>\n</%s>\n<AppendedData encoding=\"raw\">\n_", type);
    for (int k = 0; k < blocks; k++) vtk_put_block(out, &b[k]);
    fprintf(out, "\n</AppendedData>\n</VTKFile>\n");
}

static void write_poly(FILE *out, const struct export_frame *m, const struct sheet *s)
{
    struct vtk_block b[BLOCKS];
    int blocks = list_blocks(b, s);
    uint64_t offset = 0;
    const char *cells = s->shape == SHEET_POINT  ? "Verts"
                        : s->shape == SHEET_LINE ? "Lines"
                                                 : "Polys";
    open_file(out, "PolyData", m);
    fprintf(out, "<Piece NumberOfPoints=\"%" PRId64 "\" NumberOf%s=\"%" PRId64 "\">\n", s->points,
            cells, s->cells);
    name_columns(out, s, b, &offset);
    fprintf(out, "<%s>\n", cells);
    for (int k = blocks - 2; k < blocks; k++) name_block(out, &b[k], &offset);
    fprintf(out, "</%s>\n", cells);
    close_file(out, "PolyData", b, blocks);
}

static int write_cells(FILE *out, const struct export_frame *m, const struct sheet *s,
                       struct failure *failure)
{
    struct vtk_block b[BLOCKS];
    int blocks = list_blocks(b, s);
    uint64_t offset = 0;
    uint8_t *types = malloc((size_t)s->cells + 1);
    if (!types) return failure_set(failure, EX_SOFTWARE, "no memory for an export");
    for (int64_t k = 0; k < s->cells; k++) types[k] = (uint8_t)s->shape;
    b[blocks++] = (struct vtk_block){ "types", "UInt8", 1, (uint64_t)s->cells, types };
    open_file(out, "UnstructuredGrid", m);
    fprintf(out, "<Piece NumberOfPoints=\"%" PRId64 "\" NumberOfCells=\"%" PRId64 "\">\n",
            s->points, s->cells);
    name_columns(out, s, b, &offset);
    fprintf(out, "<Cells>\n");
    for (int k = blocks - 3; k < blocks; k++) name_block(out, &b[k], &offset);
    fprintf(out, "</Cells>\n");
    close_file(out, "UnstructuredGrid", b, blocks);
    free(types);
    return 0;
}

static int vtp(FILE *out, const struct export_frame *m, enum part part, bool first,
               struct failure *failure)
{
    struct sheet s;
    (void)first;
    if (sheet_of(&s, part, m, failure)) return failure->status;
    write_poly(out, m, &s);
    sheet_free(&s);
    return 0;
}

static int vtu(FILE *out, const struct export_frame *m, enum part part, bool first,
               struct failure *failure)
{
    struct sheet s;
    (void)first;
    if (sheet_of(&s, part, m, failure)) return failure->status;
    write_cells(out, m, &s, failure);
    sheet_free(&s);
    return failure->status;
}

const struct format format_vtp = {
    .name = "vtp",
    .ending = "vtp",
    .help = "VTK polygons and lines, for ParaView",
    .parts = true,
    .binary = true,
    .collected = true,
    .write = vtp,
};

const struct format format_vtu = {
    .name = "vtu",
    .ending = "vtu",
    .help = "VTK unstructured grid, for ParaView",
    .parts = true,
    .binary = true,
    .collected = true,
    .write = vtu,
};
