#include "file/vtkhdf.h"

#include "base/array.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    TOPOLOGIES = 4, /* of PolyData, in this order: */
    VERTICES = 0,
    LINES = 1,
    POLYGONS = 2,
    MINOR = 1,        /* of the version 2.1 of VTKHDF, the first with collections */
    PARTS_MOST = 4,   /* with the grains */
    CHUNK_ROWS = 4096 /* of what grows: 96 KiB of points */
};

static const char *const topology_name[TOPOLOGIES] = { "Vertices", "Lines", "Polygons", "Strips" };

/* Columns of bodies, in this order */
static const int8_t columns[] = { BODY_v,    BODY_w,  BODY_q,        BODY_radius,
                                  BODY_mass, BODY_id, BODY_material, BODY_shape };
enum { VTK_COLUMNS = sizeof columns };

/* A moment of a block: where its points and cells begin in the datasets; part -1: it has none */
struct step {
    int64_t part, point, cell, corner;
};

/* A PolyData that grows */
struct vtkhdf_block {
    const char *name;
    int topology;
    int64_t steps, room;
    struct step *step;
    int64_t parts, parts_room, points, cells, corners;
    struct vtkhdf_extent {
        int64_t points, cells, corners;
    } * part;      /* [parts] */
    uint64_t hash; /* of the last part's cells and columns */
    bool single;   /* points are in single precision */
};

struct vtkhdf {
    const struct vtkhdf_parts *parts;
    struct vtkhdf_block block[PARTS_MOST]; /* 0: grains, where bodies come and go */
    int64_t frames, bodies;
    bool varies, shapes;
};

int vtkhdf_begin(struct vtkhdf **vtk, const struct vtkhdf_parts *parts, struct failure *failure)
{
    *vtk = calloc(1, sizeof **vtk);
    if (!*vtk) return failure_set(failure, EX_SOFTWARE, "no memory");
    (*vtk)->parts = parts;
    return 0;
}

static void reset(struct vtkhdf *v)
{
    for (int k = 0; k < PARTS_MOST; k++) free(v->block[k].step), free(v->block[k].part);
    *v = (struct vtkhdf){ .parts = v->parts };
}

void vtkhdf_free(struct vtkhdf *v)
{
    if (!v) return;
    reset(v);
    free(v);
}

static int vtkhdf_failed(const char *path, struct failure *failure)
{
    return failure_set(failure, EX_IOERR, "%s: cannot be written (disk full?)", path);
}

/* ---- groups, and datasets that grow ---- */

/* A group in which VTK finds blocks in the order of their making */
static int vtkhdf_group(hid_t file, const char *path, struct failure *failure)
{
    if (h5_has(file, path)) return 0;
    hid_t plist = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_obj_track_times(plist, false);
    H5Pset_link_creation_order(plist, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    hid_t group = H5Gcreate2(file, path, H5P_DEFAULT, plist, H5P_DEFAULT);
    H5Pclose(plist);
    return group >= 0 && H5Gclose(group) >= 0 ? 0 : vtkhdf_failed(path, failure);
}

/* VTK takes texts in ASCII, of just their length. */
static int ascii(hid_t file, const char *path, const char *name, const char *text,
                 struct failure *failure)
{
    hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, strlen(text)), H5Tset_strpad(type, H5T_STR_NULLPAD);
    hid_t at =
        H5Acreate_by_name(file, path, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    bool good = at >= 0 && H5Awrite(at, type, text) >= 0;
    if (at >= 0) good &= H5Aclose(at) >= 0;
    H5Tclose(type), H5Sclose(space);
    return good ? 0 : vtkhdf_failed(path, failure);
}

/* Its type, and the version 2.minor of VTKHDF */
static int vtkhdf_type(hid_t file, const char *path, const char *type, int minor,
                       struct failure *failure)
{
    const int64_t version[2] = { 2, minor };
    return ascii(file, path, "Type", type, failure) ||
           h5_attr(file, path, "Version", h5_vector(H5T_NATIVE_INT64, 2, version), failure);
}

/* The group that an object is in. HDF5 itself would make it with its time. */
static int make_parent(hid_t file, const char *path, struct failure *failure)
{
    char parent[160];
    snprintf(parent, sizeof parent, "%.*s", (int)(strrchr(path, '/') - path), path);
    return h5_group(file, parent, failure);
}

static hid_t make_growing(hid_t file, const char *path, hid_t disk, int width,
                          struct failure *failure)
{
    const hsize_t none[2] = { 0, (hsize_t)width }, most[2] = { H5S_UNLIMITED, (hsize_t)width },
                  chunk[2] = { CHUNK_ROWS, (hsize_t)width };
    if (make_parent(file, path, failure)) return -1;
    hid_t plist = h5_dataset_plist();
    hid_t space = H5Screate_simple(width > 1 ? 2 : 1, none, most);
    H5Pset_chunk(plist, width > 1 ? 2 : 1, chunk);
    hid_t set = H5Dcreate2(file, path, disk, space, H5P_DEFAULT, plist, H5P_DEFAULT);
    H5Pclose(plist), H5Sclose(space);
    if (set < 0) vtkhdf_failed(path, failure);
    return set;
}

/* Rows of numbers */
struct added {
    hid_t type; /* of memory */
    int width;
    int64_t n;
    const void *data; /* [n][width] */
};

/* Rows at the end of a dataset of rows, which is made, of type `disk`, where there is none */
static int vtkhdf_append(hid_t file, const char *path, hid_t disk, struct added o,
                         struct failure *failure)
{
    const int width = o.width;
    const int64_t n = o.n;
    hsize_t size[2] = { 0, (hsize_t)width }, rows[2] = { (hsize_t)n, (hsize_t)width };
    hid_t set = h5_has(file, path) ? H5Dopen2(file, path, H5P_DEFAULT)
                                   : make_growing(file, path, disk, width, failure);
    if (set < 0) return failure->status ? failure->status : vtkhdf_failed(path, failure);
    hid_t space = H5Dget_space(set);
    H5Sget_simple_extent_dims(space, size, NULL), H5Sclose(space);
    const hsize_t start[2] = { size[0], 0 };
    size[0] += (hsize_t)n;
    bool good = H5Dset_extent(set, size) >= 0;
    if (good && n) {
        hid_t to = H5Dget_space(set), from = H5Screate_simple(width > 1 ? 2 : 1, rows, NULL);
        good = H5Sselect_hyperslab(to, H5S_SELECT_SET, start, NULL, rows, NULL) >= 0 &&
               H5Dwrite(set, o.type, from, to, H5P_DEFAULT, o.data) >= 0;
        H5Sclose(to), H5Sclose(from);
    }
    if (H5Dclose(set) < 0) good = false;
    return good ? 0 : vtkhdf_failed(path, failure);
}

static int append_to(const struct vtkhdf_block *b, hid_t file, const char *name, struct added o,
                     struct failure *failure)
{
    char path[120];
    snprintf(path, sizeof path, "%s/%s", b->name, name);
    return vtkhdf_append(file, path, o.type, o, failure);
}

/* ---- blocks that grow ---- */

static uint64_t hash_more(uint64_t h, const void *data, size_t size)
{
    const unsigned char *b = data;
    for (uint64_t word; size >= 8; b += 8, size -= 8)
        memcpy(&word, b, 8), h = (h ^ word) * 0x100000001b3;
    for (; size; b++, size--) h = (h ^ *b) * 0x100000001b3;
    return h;
}

static int vtkhdf_add_step(struct vtkhdf_block *b, struct step s, struct failure *failure)
{
    if (!array_grow(&b->step, &b->room, b->steps + 1, sizeof *b->step))
        return failure_set(failure, EX_SOFTWARE, "no memory for /VTKHDF");
    b->step[b->steps++] = s;
    return 0;
}

static int vtkhdf_add_part(struct vtkhdf_block *b, int64_t points, int64_t cells, int64_t corners,
                           struct failure *failure)
{
    if (!array_grow(&b->part, &b->parts_room, b->parts + 1, sizeof *b->part))
        return failure_set(failure, EX_SOFTWARE, "no memory for /VTKHDF");
    if (b->part) b->part[b->parts++] = (struct vtkhdf_extent){ points, cells, corners };
    return 0;
}

/* Offsets of the cells: from 0, one more than there are cells; and one 0 of the other kinds of cells */
static int append_offsets(const struct vtkhdf_block *b, hid_t file, int64_t cells,
                          const int64_t *end, struct failure *failure)
{
    const int64_t zero = 0;
    for (int k = 0; k < TOPOLOGIES; k++) {
        char name[40];
        snprintf(name, sizeof name, "%s/Offsets", topology_name[k]);
        if (append_to(b, file, name, (struct added){ H5T_NATIVE_INT64, 1, 1, &zero }, failure) ||
            (k == b->topology &&
             append_to(b, file, name, (struct added){ H5T_NATIVE_INT64, 1, cells, end }, failure)))
            return failure->status;
    }
    return 0;
}

/* Single precision is for what is looked at, where it shows a thousandth of the smallest grain. */
static bool single_will_do(const struct packing *p)
{
    double least = INFINITY, far = 0;
    for (int64_t i = 0; i < p->n; i++) {
        least = fmin(least, p->radius[i]);
        far = fmax(far, fmax(fabs(p->x[i].x), fmax(fabs(p->x[i].y), fabs(p->x[i].z))));
    }
    return p->n && 6e-8 * (far + least) < 1e-3 * least;
}

static int append_points(struct vtkhdf_block *b, hid_t file, int64_t n, const vec3 *x,
                         struct failure *failure)
{
    char path[120];
    snprintf(path, sizeof path, "%s/Points", b->name);
    hid_t disk = b->single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
    return vtkhdf_append(file, path, disk, (struct added){ H5T_NATIVE_DOUBLE, 3, n, x }, failure);
}

/* Moments without cells have the last part, which is empty: VTK 9.5 counts parts by the cells before. */
static int add_nothing(struct vtkhdf_block *b, struct failure *failure)
{
    return vtkhdf_add_step(b, (struct step){ .part = -1 }, failure);
}

static int end_nothing(struct vtkhdf_block *b, hid_t file, struct failure *failure)
{
    bool any = false;
    for (int64_t f = 0; f < b->steps; f++) {
        if (b->step[f].part >= 0) continue;
        any = true;
        b->step[f] = (struct step){ b->parts, b->points, b->cells, b->corners };
    }
    if (!any) return 0;
    char name[40];
    snprintf(name, sizeof name, "%s/Connectivity", topology_name[b->topology]);
    return append_offsets(b, file, 0, NULL, failure) || append_points(b, file, 0, NULL, failure) ||
           append_to(b, file, name, (struct added){ H5T_NATIVE_INT64, 1, 0, NULL }, failure) ||
           vtkhdf_add_part(b, 0, 0, 0, failure);
}

/* The moment's cells; where they are those of the moment before, only their points */
static int add_cells(struct vtkhdf_block *b, hid_t file, const struct vtkhdf_cells *c,
                     struct failure *failure)
{
    uint64_t hash = hash_more(0xcbf29ce484222325, c->corner, (size_t)c->corners * 8);
    hash = hash_more(hash, c->end, (size_t)c->cells * 8);
    for (int k = 0; k < c->columns; k++)
        hash = hash_more(hash, c->column[k].value, (size_t)c->cells * 4);
    if (!c->cells) return add_nothing(b, failure);
    struct step s = { b->parts, b->points, b->cells, b->corners };
    const struct vtkhdf_extent *last = b->parts ? &b->part[b->parts - 1] : NULL;
    bool same = last && last->points == c->points && last->cells == c->cells &&
                last->corners == c->corners && hash == b->hash;
    if (same)
        s.part--, s.cell -= c->cells, s.corner -= c->corners;
    else {
        char name[40];
        b->topology = c->lines ? LINES : POLYGONS, b->hash = hash;
        snprintf(name, sizeof name, "%s/Connectivity", topology_name[b->topology]);
        if (vtkhdf_add_part(b, c->points, c->cells, c->corners, failure) ||
            append_offsets(b, file, c->cells, c->end, failure) ||
            append_to(b, file, name, (struct added){ H5T_NATIVE_INT64, 1, c->corners, c->corner },
                      failure))
            return failure->status;
        for (int k = 0; k < c->columns; k++) {
            snprintf(name, sizeof name, "CellData/%s", c->column[k].name);
            if (append_to(b, file, name,
                          (struct added){ H5T_NATIVE_INT32, 1, c->cells, c->column[k].value },
                          failure))
                return failure->status;
        }
        b->cells += c->cells, b->corners += c->corners;
    }
    if (append_points(b, file, c->points, c->x, failure)) return failure->status;
    b->points += c->points;
    return vtkhdf_add_step(b, s, failure);
}

/* The grains of a frame where they come and go: a part each */
static int add_grains(struct vtkhdf_block *b, hid_t file, const struct packing *p,
                      struct failure *failure)
{
    b->topology = VERTICES;
    if (!p->n) return add_nothing(b, failure);
    int64_t *number = malloc(((size_t)p->n + 1) * sizeof *number);
    if (!number) return failure_set(failure, EX_SOFTWARE, "no memory for /VTKHDF");
    for (int64_t i = 0; i <= p->n; i++) number[i] = i;
    struct step s = { b->parts, b->points, b->cells, b->corners };
    if (!vtkhdf_add_step(b, s, failure) && !vtkhdf_add_part(b, p->n, p->n, p->n, failure) &&
        !append_offsets(b, file, p->n, number + 1, failure) &&
        !append_to(b, file, "Vertices/Connectivity",
                   (struct added){ H5T_NATIVE_INT64, 1, p->n, number }, failure))
        append_points(b, file, p->n, p->x, failure);
    free(number);
    b->points += p->n, b->cells += p->n, b->corners += p->n;
    for (int k = 0; k < VTK_COLUMNS && !failure->status; k++) {
        char name[60];
        const struct field *c = &body_columns[columns[k]];
        const void *array = field_array(c, p);
        snprintf(name, sizeof name, "PointData/%s", field_key(c));
        if (array)
            append_to(b, file, name,
                      (struct added){ column_native(c->type), c->width, p->n, array }, failure);
    }
    return failure->status;
}

static const char grains_alone[] = "/VTKHDF", grains_block[] = "/VTKHDF/grains";

static int begin_blocks(struct vtkhdf *v, hid_t file, const struct packing *p,
                        struct failure *failure)
{
    v->varies = packing_varies(p), v->bodies = p->n, v->shapes = p->shape != NULL;
    v->block[0].name = v->parts ? grains_block : grains_alone;
    if (vtkhdf_group(file, "/VTKHDF", failure) ||
        (v->parts && vtkhdf_group(file, grains_block, failure)))
        return failure->status;
    for (int k = 0; v->parts && k < v->parts->count; k++) {
        v->block[1 + k].name = v->parts->name[k];
        v->block[1 + k].single = single_will_do(p);
        v->block[1 + k].topology = POLYGONS;
        if (vtkhdf_group(file, v->parts->name[k], failure)) return failure->status;
    }
    return 0;
}

int vtkhdf_frame(struct vtkhdf *v, hid_t file, const struct packing *p, struct failure *failure)
{
    if (!v->frames && begin_blocks(v, file, p, failure)) return failure->status;
    v->frames++;
    if (v->varies && add_grains(&v->block[0], file, p, failure)) return failure->status;
    for (int k = 0; v->parts && k < v->parts->count; k++) {
        struct vtkhdf_cells c = { 0 };
        void *made = NULL;
        if (!v->parts->make(&c, p, k, &made, failure))
            add_cells(&v->block[1 + k], file, &c, failure);
        v->parts->done(made);
        if (failure->status) return failure->status;
    }
    return 0;
}

/* ---- what is told at the end ---- */

static struct h5_data vtkhdf_numbers(int64_t n, const int64_t *value)
{
    return h5_vector(H5T_NATIVE_INT64, (hsize_t)n, value);
}

/* [n][width]; of one number a row [n] */
static struct h5_data table(int64_t n, int width, const int64_t *value)
{
    const hsize_t shape[2] = { (hsize_t)n, (hsize_t)width };
    return h5_array(H5T_NATIVE_INT64, width > 1 ? 2 : 1, shape, value);
}

/* A dataset of the block */
static int vtkhdf_put(hid_t file, const char *block, const char *name, struct h5_data data,
                      struct failure *failure)
{
    char path[160];
    snprintf(path, sizeof path, "%s/%s", block, name);
    return h5_write(file, path, data, NULL, failure);
}

static int link_to(hid_t file, const char *from, const char *block, const char *name,
                   struct failure *failure)
{
    char path[160];
    snprintf(path, sizeof path, "%s/%s", block, name);
    if (make_parent(file, path, failure)) return failure->status;
    bool good = H5Lcreate_hard(file, from, file, path, H5P_DEFAULT, H5P_DEFAULT) >= 0;
    return good ? 0 : vtkhdf_failed(path, failure);
}

/* [frames][bodies][width] of /particles/all as [frames * bodies][width] of the grains, without its numbers */
static int make_virtual(const struct vtkhdf *v, hid_t file, const char *from, const char *name,
                        int width, struct failure *failure)
{
    const int64_t frames = v->frames, bodies = v->bodies;
    char path[160], source[80];
    snprintf(path, sizeof path, "%s/%s", v->block[0].name, name);
    snprintf(source, sizeof source, "/particles/all/%s/value", from);
    const hsize_t flat[2] = { (hsize_t)(frames * bodies), (hsize_t)width },
                  deep[3] = { (hsize_t)frames, (hsize_t)bodies, (hsize_t)width };
    if (!frames || !bodies)
        return h5_write(file, path, h5_array(H5T_NATIVE_DOUBLE, 2, flat, &frames), NULL, failure);
    if (make_parent(file, path, failure)) return failure->status;
    hid_t to = H5Screate_simple(2, flat, NULL), of = H5Screate_simple(3, deep, NULL);
    hid_t plist = h5_dataset_plist();
    bool good = H5Pset_virtual(plist, to, ".", source, of) >= 0;
    hid_t set =
        good ? H5Dcreate2(file, path, H5T_IEEE_F64LE, to, H5P_DEFAULT, plist, H5P_DEFAULT) : -1;
    H5Pclose(plist), H5Sclose(to), H5Sclose(of);
    return set >= 0 && H5Dclose(set) >= 0 ? 0 : vtkhdf_failed(path, failure);
}

static int put_values(hid_t file, const char *block, int64_t frames, struct failure *failure)
{
    char steps[120];
    int64_t n = frames;
    snprintf(steps, sizeof steps, "%s/Steps", block);
    return h5_group(file, steps, failure) ||
           h5_attr(file, steps, "NSteps", h5_scalar(H5T_NATIVE_INT64, &n), failure) ||
           link_to(file, "/particles/all/position/time", block, "Steps/Values", failure);
}

/* One part that all frames have, with a vertex for each body, and where the frames' numbers begin */
static int link_grains(const struct vtkhdf *v, hid_t file, struct failure *failure)
{
    const char *block = v->block[0].name;
    const int64_t F = v->frames, N = v->bodies;
    int64_t room = F > N ? F : N, *zero = calloc((size_t)(TOPOLOGIES * room) + 1, sizeof *zero),
            *number = calloc((size_t)room + 1, sizeof *number);
    if (!zero || !number) failure_set(failure, EX_SOFTWARE, "no memory for /VTKHDF");
    for (int64_t i = 0; !failure->status && i <= room; i++) number[i] = i;
    int bad = failure->status ||
              vtkhdf_put(file, block, "NumberOfPoints", vtkhdf_numbers(1, &N), failure);
    for (int k = 0; k < TOPOLOGIES && !bad; k++) {
        char name[60];
        const int64_t cells = k == VERTICES ? N : 0;
        const char *part[4] = { "NumberOfCells", "NumberOfConnectivityIds", "Connectivity",
                                "Offsets" };
        const int64_t rows[4] = { 1, 1, cells, cells + 1 };
        const int64_t *value[4] = { &cells, &cells, number, number };
        for (int j = 0; j < 4 && !bad; j++) {
            snprintf(name, sizeof name, "%s/%s", topology_name[k], part[j]);
            bad = vtkhdf_put(file, block, name, vtkhdf_numbers(rows[j], value[j]), failure);
        }
    }
    bad =
        bad || make_virtual(v, file, "position", "Points", 3, failure) ||
        put_values(file, block, F, failure) ||
        vtkhdf_put(file, block, "Steps/PartOffsets", vtkhdf_numbers(F, zero), failure) ||
        vtkhdf_put(file, block, "Steps/CellOffsets", table(F, TOPOLOGIES, zero), failure) ||
        vtkhdf_put(file, block, "Steps/ConnectivityIdOffsets", table(F, TOPOLOGIES, zero), failure);
    for (int k = 0; k < VTK_COLUMNS && !bad; k++) {
        char name[60], from[60], offsets[80];
        const struct field *c = &body_columns[columns[k]];
        if (!v->shapes && columns[k] == BODY_shape) continue;
        snprintf(name, sizeof name, "PointData/%s", field_key(c));
        snprintf(from, sizeof from, "/particles/all/%s", c->name);
        snprintf(offsets, sizeof offsets, "Steps/PointDataOffsets/%s", field_key(c));
        bad = c->traits & FIELD_MOVES
                  ? make_virtual(v, file, c->name, name, c->width, failure)
                  : link_to(file, from, block, name, failure) ||
                        vtkhdf_put(file, block, offsets, vtkhdf_numbers(F, zero), failure);
    }
    for (int64_t f = 0; !bad && f < F; f++) zero[f] = 1;
    bad = bad || vtkhdf_put(file, block, "Steps/NumberOfParts", vtkhdf_numbers(F, zero), failure);
    for (int64_t f = 0; !bad && f < F; f++) zero[f] = f * N;
    if (!bad) vtkhdf_put(file, block, "Steps/PointOffsets", vtkhdf_numbers(F, zero), failure);
    free(zero), free(number);
    return failure->status;
}

/* A block of which the numbers of parts and moments are written, by way of value[] */
struct ending {
    const struct vtkhdf_block *b;
    hid_t file;
    int64_t *value;
};

/* The numbers of one extent of all parts */
static int put_parts(const struct ending *o, const char *name, size_t member, bool there,
                     struct failure *failure)
{
    const struct vtkhdf_block *b = o->b;
    for (int64_t i = 0; i < b->parts; i++)
        o->value[i] = there ? *(const int64_t *)((const char *)&b->part[i] + member) : 0;
    return vtkhdf_put(o->file, b->name, name, vtkhdf_numbers(b->parts, o->value), failure);
}

/* One number of all moments, in column `at` of `width`, of which the others are 0 */
static int put_step_column(const struct ending *o, const char *name, size_t member, int width,
                           int at, struct failure *failure)
{
    const struct vtkhdf_block *b = o->b;
    memset(o->value, 0, (size_t)(b->steps * width) * sizeof *o->value);
    for (int64_t f = 0; f < b->steps; f++)
        o->value[f * width + at] = *(const int64_t *)((const char *)&b->step[f] + member);
    return vtkhdf_put(o->file, b->name, name, table(b->steps, width, o->value), failure);
}

static int end_block(struct vtkhdf_block *b, hid_t file, struct failure *failure)
{
    if (end_nothing(b, file, failure)) return failure->status;
    int64_t room = TOPOLOGIES * b->steps + b->parts,
            *value = malloc(((size_t)room + 1) * sizeof *value);
    if (!value) return failure_set(failure, EX_SOFTWARE, "no memory for /VTKHDF");
    const struct ending o = { b, file, value };
    int bad =
        put_parts(&o, "NumberOfPoints", offsetof(struct vtkhdf_extent, points), true, failure);
    for (int k = 0; k < TOPOLOGIES && !bad; k++) {
        char name[60];
        bool there = k == b->topology;
        snprintf(name, sizeof name, "%s/NumberOfCells", topology_name[k]);
        bad = put_parts(&o, name, offsetof(struct vtkhdf_extent, cells), there, failure);
        snprintf(name, sizeof name, "%s/NumberOfConnectivityIds", topology_name[k]);
        bad = bad || put_parts(&o, name, offsetof(struct vtkhdf_extent, corners), there, failure);
        snprintf(name, sizeof name, "%s/Connectivity", topology_name[k]);
        if (!bad && !there)
            bad = vtkhdf_put(file, b->name, name, vtkhdf_numbers(0, value), failure);
    }
    bad = bad || put_values(file, b->name, b->steps, failure) ||
          put_step_column(&o, "Steps/PartOffsets", offsetof(struct step, part), 1, 0, failure) ||
          put_step_column(&o, "Steps/PointOffsets", offsetof(struct step, point), 1, 0, failure) ||
          put_step_column(&o, "Steps/CellOffsets", offsetof(struct step, cell), TOPOLOGIES,
                          b->topology, failure) ||
          put_step_column(&o, "Steps/ConnectivityIdOffsets", offsetof(struct step, corner),
                          TOPOLOGIES, b->topology, failure);
    for (int64_t f = 0; !bad && f < b->steps; f++) value[f] = 1;
    if (!bad)
        vtkhdf_put(file, b->name, "Steps/NumberOfParts", vtkhdf_numbers(b->steps, value), failure);
    free(value);
    return failure->status;
}

/* The collection: the order of its blocks, and under which names VTK shows them */
static int collect(const struct vtkhdf *v, hid_t file, struct failure *failure)
{
    if (vtkhdf_group(file, "/VTKHDF/Assembly", failure)) return failure->status;
    for (int k = 0; k <= v->parts->count; k++) {
        const char *block = v->block[k].name;
        char path[120];
        snprintf(path, sizeof path, "/VTKHDF/Assembly/%s", strrchr(block, '/') + 1);
        int32_t index = k;
        if (vtkhdf_type(file, block, "PolyData", MINOR, failure) ||
            h5_attr(file, block, "Index", h5_scalar(H5T_NATIVE_INT32, &index), failure))
            return failure->status;
        if (H5Lcreate_soft(block, file, path, H5P_DEFAULT, H5P_DEFAULT) < 0)
            return vtkhdf_failed(path, failure);
    }
    return vtkhdf_type(file, "/VTKHDF", "PartitionedDataSetCollection", MINOR, failure);
}

int vtkhdf_end(struct vtkhdf *v, hid_t file, struct failure *failure)
{
    if (v->frames) {
        int bad =
            v->varies ? end_block(&v->block[0], file, failure) : link_grains(v, file, failure);
        for (int k = 1; !bad && v->parts && k <= v->parts->count; k++)
            bad = end_block(&v->block[k], file, failure);
        if (!bad && v->parts)
            collect(v, file, failure);
        else if (!bad)
            vtkhdf_type(file, grains_alone, "PolyData", MINOR, failure);
    }
    reset(v);
    return failure->status;
}
