/*
 * convert/gsd.c: GSD, HOOMD-blue's format [gsd.readthedocs.io, file layer 2.0, schema hoomd 1.4], for HOOMD and
 * OVITO: a header, chunks of numbers, and behind them the names of the chunks and an index by frame and name.
 * A chunk that is the same as in frame 0 is left out, as the schema allows. Reals are of single precision.
 *
 * GSD gives a shape to a type of particles, not to a particle. Balls have the type of their material and a diameter
 * each; grains of another shape have a type for each material, shape and radius. The centre of the box is the
 * origin, so positions are relative to it, and within it along periodic edges, which `image` counts.
 */
#include "convert/format.h"

#include "base/array.h"
#include "base/text.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum gsd_type { U8 = 1, U32 = 3, U64 = 4, I8 = 5, I32 = 7, F32 = 9, F64 = 10 };

static size_t gsd_size_of(enum gsd_type t)
{
    return t == U64 || t == F64 ? 8 : t == U8 || t == I8 ? 1 : 4;
}

enum gsd_chunk {
    STEP,
    DIMENSIONS,
    BOX,
    COUNT,
    TYPES,
    TYPE_SHAPES,
    TYPE_ID,
    MASS,
    DIAMETER,
    MOMENT,
    POSITION,
    ORIENTATION,
    VELOCITY,
    ANGMOM,
    IMAGE,
    TIME,
    ID,
    CHUNKS
};

/* In the order of the index, which is sorted by their numbers in each frame */
static const struct {
    const char *name;
    enum gsd_type type;
} chunks[CHUNKS] = {
    { "configuration/step", U64 },   { "configuration/dimensions", U8 },
    { "configuration/box", F32 },    { "particles/N", U32 },
    { "particles/types", I8 },       { "particles/type_shapes", I8 },
    { "particles/typeid", U32 },     { "particles/mass", F32 },
    { "particles/diameter", F32 },   { "particles/moment_inertia", F32 },
    { "particles/position", F32 },   { "particles/orientation", F32 },
    { "particles/velocity", F32 },   { "particles/angmom", F32 },
    { "particles/image", I32 },      { "log/configuration/time", F64 },
    { "log/particles/nsd_id", I32 },
};

enum {
    NAME = 64,         /* bytes of the names of the application and the schema */
    TYPES_MOST = 4096, /* of grains that are no balls: JSON of each is in the file */
    SHAPES_BYTES_MOST = 1 << 28
};

struct header {
    uint64_t magic, index, index_entries, names, names_entries;
    uint32_t schema_version, file_version;
    char application[NAME], schema[NAME], reserved[80];
};
_Static_assert(sizeof(struct header) == 256, "the header of GSD");

struct index_entry {
    uint64_t frame, rows;
    int64_t at;
    uint32_t columns;
    uint16_t chunk;
    uint8_t type, flags;
};
_Static_assert(sizeof(struct index_entry) == 32, "an entry of GSD's index");

/* A file that is written */
struct gsd {
    FILE *out;
    int64_t at, frames, entries, room;
    struct index_entry *entry;
    struct {
        uint64_t rows, hash;
        uint32_t columns;
    } first[CHUNKS]; /* what frame 0 has */
};

/* FNV-1a, by 8 bytes where there are as many: to see whether a chunk has changed */
static uint64_t hash_of(const unsigned char *b, size_t n)
{
    uint64_t h = 0xcbf29ce484222325, word;
    for (; n >= 8; b += 8, n -= 8) memcpy(&word, b, 8), h = (h ^ word) * 0x100000001b3;
    for (; n; b++, n--) h = (h ^ *b) * 0x100000001b3;
    return h;
}

static int put_chunk(struct gsd *g, enum gsd_chunk k, int64_t rows, int64_t columns,
                     const void *data, struct failure *failure)
{
    const size_t size = (size_t)(rows * columns) * gsd_size_of(chunks[k].type);
    const uint64_t hash = hash_of(data, size);
    if (!g->frames)
        g->first[k].rows = (uint64_t)rows, g->first[k].columns = (uint32_t)columns,
        g->first[k].hash = hash;
    else if (k != STEP && g->first[k].rows == (uint64_t)rows &&
             g->first[k].columns == (uint32_t)columns && g->first[k].hash == hash)
        return 0;
    if (!array_grow(&g->entry, &g->room, g->entries + 1, sizeof *g->entry))
        return failure_set(failure, EX_SOFTWARE, "no memory for the index of a GSD file");
    g->entry[g->entries++] = (struct index_entry){ .frame = (uint64_t)g->frames,
                                                   .rows = (uint64_t)rows,
                                                   .at = g->at,
                                                   .columns = (uint32_t)columns,
                                                   .chunk = (uint16_t)k,
                                                   .type = (uint8_t)chunks[k].type };
    fwrite(data, 1, size, g->out);
    g->at += (int64_t)size;
    return 0;
}

/* ---- types ---- */

struct gsd_particle {
    int32_t material, shape; /* shape 0: balls of any radius */
    double radius;           /* m */
};

static int gsd_by_type(const void *one, const void *other)
{
    const struct gsd_particle *a = one, *b = other;
    if (a->shape != b->shape) return a->shape < b->shape ? -1 : 1;
    if (a->material != b->material) return a->material < b->material ? -1 : 1;
    return (a->radius > b->radius) - (a->radius < b->radius);
}

static struct gsd_particle gsd_particle_of(const struct packing *p, int64_t i)
{
    int32_t shape = p->shape ? p->shape[i] : 0;
    return (struct gsd_particle){ p->material[i], shape, shape ? p->radius[i] : 0 };
}

/* The types, sorted; those of balls come first, one for each material. To be freed. */
static struct gsd_particle *gsd_list_types(const struct packing *p, int64_t *types,
                                           struct failure *failure)
{
    struct gsd_particle *t = malloc(((size_t)p->n + (size_t)p->materials) * sizeof *t);
    int64_t n = 0, kept = 0;
    if (!t) return failure_set(failure, EX_SOFTWARE, "no memory for the types of an export"), NULL;
    for (int32_t k = 0; k < p->materials; k++) t[n++] = (struct gsd_particle){ k, 0, 0 };
    for (int64_t i = 0; i < p->n; i++)
        if (packing_shape(p, i)) t[n++] = gsd_particle_of(p, i);
    qsort(t, (size_t)n, sizeof *t, gsd_by_type);
    for (int64_t k = 0; k < n; k++)
        if (!kept || gsd_by_type(&t[kept - 1], &t[k])) t[kept++] = t[k];
    if (kept - p->materials > TYPES_MOST) {
        failure_set(failure, EX_DATAERR,
                    "%lld sizes of grains that are no balls: GSD has a type for each, at most %d; "
                    "--to vtp --part surfaces takes any number",
                    (long long)(kept - p->materials), TYPES_MOST);
        free(t);
        return NULL;
    }
    *types = kept;
    return t;
}

static void put_vertex(FILE *out, bool first, double r, vec3 x, int dim)
{
    fprintf(out, "%s[%.9g, %.9g", first ? "" : ", ", r * x.x, r * x.y);
    if (dim == 3) fprintf(out, ", %.9g", r * x.z);
    fputc(']', out);
}

/* As gsd's documentation of particles/type_shapes has them. A capsule is a line that is rounded. */
static void put_shape(FILE *out, const struct packing *p, const struct gsd_particle *k)
{
    const struct shape *s = &p->shapes.s[k->shape];
    const bool clump = k->shape && shape_is_union(s);
    if (!k->shape) {
        fputs("{}", out);
        return;
    }
    fprintf(out, "{\"type\": \"%s\", ",
            clump         ? "SphereUnion"
            : p->dim == 2 ? "Polygon"
                          : "ConvexPolyhedron");
    if (!clump) fprintf(out, "\"rounding_radius\": %.9g, ", k->radius * s->round);
    fputs(clump ? "\"centers\": [" : "\"vertices\": [", out);
    for (int32_t i = 0; i < s->vertices; i++) {
        bool ring = p->dim == 2 && shape_has_faces(s); // in the order around it
        put_vertex(out, !i, k->radius, s->vertex[ring ? s->corner[i] : i], clump ? 3 : p->dim);
    }
    fputs(clump ? "], \"diameters\": [" : "]", out);
    for (int32_t i = 0; clump && i < s->vertices; i++)
        fprintf(out, "%s%.9g", i ? ", " : "", 2 * k->radius * s->ball[i]);
    fputs(clump ? "]}" : "}", out);
}

/* The k-th type's name: its material, with the shape and, where there are several sizes of that, a number */
static void gsd_put_name(FILE *out, const struct packing *p, const struct gsd_particle *t,
                         int64_t types, int64_t k)
{
    int64_t first = k, last = k;
    fputs(p->material_name[t[k].material], out);
    if (!t[k].shape) return;
    fprintf(out, ":%s", p->shapes.s[t[k].shape].name);
    while (first > 0 && t[first - 1].shape == t[k].shape && t[first - 1].material == t[k].material)
        first--;
    while (last + 1 < types && t[last + 1].shape == t[k].shape &&
           t[last + 1].material == t[k].material)
        last++;
    if (last > first) fprintf(out, ":%" PRId64, k - first + 1);
}

/* Texts as rows of one width, ended by zeros */
static int gsd_put_texts(struct gsd *g, enum gsd_chunk c, char *const *text, int64_t n,
                         struct failure *failure)
{
    size_t width = 1;
    for (int64_t k = 0; k < n; k++)
        if (strlen(text[k]) >= width) width = strlen(text[k]) + 1;
    if ((double)width * (double)n > SHAPES_BYTES_MOST)
        return failure_set(failure, EX_DATAERR, "the shapes of all types take more than %d MB",
                           SHAPES_BYTES_MOST >> 20);
    char *rows = calloc((size_t)n + 1, width);
    if (!rows) return failure_set(failure, EX_SOFTWARE, "no memory for the types of an export");
    for (int64_t k = 0; k < n; k++) strcpy(rows + (size_t)k * width, text[k]);
    put_chunk(g, c, n, (int64_t)width, rows, failure);
    free(rows);
    return failure->status;
}

static int put_types(struct gsd *g, const struct packing *p, const struct gsd_particle *t,
                     int64_t types, enum gsd_chunk c, struct failure *failure)
{
    char **text = calloc((size_t)types + 1, sizeof *text);
    struct text written;
    size_t size;
    if (!text) failure_set(failure, EX_SOFTWARE, "no memory for the types of an export");
    for (int64_t k = 0; !failure->status && k < types; k++) {
        FILE *to = text_open(&written);
        if (to && c == TYPES) gsd_put_name(to, p, t, types, k);
        if (to && c == TYPE_SHAPES) put_shape(to, p, &t[k]);
        if (!(text[k] = text_close(&written, to, &size)))
            failure_set(failure, EX_SOFTWARE, "no memory for the types of an export");
    }
    if (!failure->status) gsd_put_texts(g, c, text, types, failure);
    for (int64_t k = 0; text && k < types; k++) free(text[k]);
    free(text);
    return failure->status;
}

static int put_type_ids(struct gsd *g, const struct packing *p, const struct gsd_particle *t,
                        int64_t types, struct failure *failure)
{
    uint32_t *id = malloc(((size_t)p->n + 1) * sizeof *id);
    if (!id) return failure_set(failure, EX_SOFTWARE, "no memory for an export");
    for (int64_t i = 0; i < p->n; i++) {
        struct gsd_particle k = gsd_particle_of(p, i);
        id[i] = !k.shape ? (uint32_t)k.material
                         : (uint32_t)((struct gsd_particle *)bsearch(&k, t, (size_t)types, sizeof k,
                                                                     gsd_by_type) -
                                      t);
    }
    put_chunk(g, TYPE_ID, p->n, 1, id, failure);
    free(id);
    return failure->status;
}

/* ---- particles ---- */

/* The box of GSD: along x, in the plane of x and y, and above; tilts relative to the heights */
static int gsd_box_of(float of[6], struct box *b, const struct packing *p, struct failure *failure)
{
    export_frame_box(b, p);
    const vec3 *e = b->edge;
    if (!(e[0].x > 0 && e[0].y == 0 && e[0].z == 0 && e[1].y > 0 && e[1].z == 0 && e[2].z > 0))
        return failure_set(
            failure, EX_DATAERR,
            "the cell's first edge is not along x, or the second not in the plane of x "
            "and y: GSD has no such box; --to lammps does");
    const double box[6] = { e[0].x,          e[1].y,          e[2].z,
                            e[1].x / e[1].y, e[2].x / e[2].z, e[2].y / e[2].z };
    for (int k = 0; k < 6; k++) of[k] = (float)box[k];
    return 0;
}

/* x relative to the centre of the box, and within it along periodic edges; image: the edges taken off */
static vec3 gsd_within(const struct box *b, vec3 x, int32_t image[3])
{
    const vec3 *e = b->edge;
    vec3 centre = v3_axpy(b->origin, 0.5, v3_add(v3_add(e[0], e[1]), e[2]));
    x = v3_sub(x, centre);
    for (int k = 2; k >= 0; k--) {
        double along = k == 2 ? x.z / e[2].z : k == 1 ? x.y / e[1].y : x.x / e[0].x;
        double n = b->repeats[k] ? floor(along + 0.5) : 0;
        if (!(fabs(n) < 1e9)) n = 0;
        x = v3_axpy(x, -n, e[k]);
        image[k] += (int32_t)n;
    }
    return x;
}

static void principal_moments(const struct packing *p, int64_t i, double of[3])
{
    const struct shape *s = packing_shape(p, i);
    double mean = s ? (s->moment[0] + s->moment[1] + s->moment[2]) / 3 : 1;
    for (int k = 0; k < 3; k++)
        of[k] = p->inertia[i] * (s && p->dim == 3 ? s->moment[k] / mean : 1);
    if (p->dim == 2) of[0] = of[1] = 0;
}

/* The chunk's numbers of grain i. HOOMD's angular momentum is the quaternion 2 q (0, I w), w in the axes of
   the grain. */
static void numbers_of(const struct packing *p, const struct box *b, int64_t i, enum gsd_chunk c,
                       float out[4])
{
    int32_t image[3] = { 0 };
    double moment[3];
    vec3 x = v3(0, 0, 0);
    if (c == POSITION) x = gsd_within(b, p->x[i], image);
    if (c == VELOCITY) x = p->v[i];
    principal_moments(p, i, moment);
    if (c == MOMENT) x = v3(moment[0], moment[1], moment[2]);
    out[0] = (float)x.x, out[1] = (float)x.y, out[2] = (float)x.z;
    quat q = p->q[i];
    if (c == ANGMOM) {
        vec3 w = quat_turn_back(q, p->w[i]);
        q = quat_mul(q, (quat){ 0, 2 * moment[0] * w.x, 2 * moment[1] * w.y, 2 * moment[2] * w.z });
    }
    if (c == ORIENTATION || c == ANGMOM)
        out[0] = (float)q.w, out[1] = (float)q.x, out[2] = (float)q.y, out[3] = (float)q.z;
    if (c == MASS) out[0] = (float)p->mass[i];
    if (c == DIAMETER) out[0] = (float)(2 * p->radius[i]);
}

static int put_numbers(struct gsd *g, const struct packing *p, const struct box *b,
                       struct failure *failure)
{
    static const struct {
        enum gsd_chunk chunk;
        int width;
    } of[] = { { MASS, 1 },        { DIAMETER, 1 }, { MOMENT, 3 }, { POSITION, 3 },
               { ORIENTATION, 4 }, { VELOCITY, 3 }, { ANGMOM, 4 } };
    float *x = malloc(((size_t)p->n + 1) * 4 * sizeof *x), one[4];
    if (!x) return failure_set(failure, EX_SOFTWARE, "no memory for an export");
    for (size_t k = 0; k < sizeof of / sizeof *of && !failure->status; k++) {
        for (int64_t i = 0; i < p->n; i++) {
            numbers_of(p, b, i, of[k].chunk, one);
            memcpy(x + i * of[k].width, one, (size_t)of[k].width * sizeof *x);
        }
        put_chunk(g, of[k].chunk, p->n, of[k].width, x, failure);
    }
    free(x);
    return failure->status;
}

static int put_images(struct gsd *g, const struct packing *p, const struct box *b,
                      struct failure *failure)
{
    int32_t(*image)[3] = calloc((size_t)p->n + 1, sizeof *image);
    if (!image) return failure_set(failure, EX_SOFTWARE, "no memory for an export");
    for (int64_t i = 0; i < p->n; i++) {
        if (p->image) memcpy(image[i], p->image[i], sizeof image[i]);
        gsd_within(b, p->x[i], image[i]);
    }
    put_chunk(g, IMAGE, p->n, 3, image, failure);
    free(image);
    return failure->status;
}

static int put_frame(struct gsd *g, const struct packing *p, struct failure *failure)
{
    const uint64_t step = p->step < 0 ? 0 : (uint64_t)p->step;
    const uint8_t dim = (uint8_t)p->dim;
    const uint32_t n = (uint32_t)p->n;
    struct box b;
    float box[6];
    int64_t types = 0;
    if (gsd_box_of(box, &b, p, failure)) return failure->status;
    struct gsd_particle *t = gsd_list_types(p, &types, failure);
    if (t && !put_chunk(g, STEP, 1, 1, &step, failure) &&
        !put_chunk(g, DIMENSIONS, 1, 1, &dim, failure) && !put_chunk(g, BOX, 6, 1, box, failure) &&
        !put_chunk(g, COUNT, 1, 1, &n, failure) && !put_types(g, p, t, types, TYPES, failure) &&
        !put_types(g, p, t, types, TYPE_SHAPES, failure) &&
        !put_type_ids(g, p, t, types, failure) && !put_numbers(g, p, &b, failure) &&
        !put_images(g, p, &b, failure) && !put_chunk(g, TIME, 1, 1, &p->t, failure))
        put_chunk(g, ID, p->n, 1, p->id, failure);
    free(t);
    g->frames++;
    return failure->status;
}

static struct gsd *gsd_begin(FILE *out, struct failure *failure)
{
    static const struct header empty;
    struct gsd *g = calloc(1, sizeof *g);
    if (!g) return failure_set(failure, EX_SOFTWARE, "no memory for an export"), NULL;
    if (fseek(out, 0, SEEK_END) || ftell(out) != 0) {
        free(g);
        return failure_set(failure, EX_USAGE, "GSD goes into a file of its own: -o FILE.gsd"), NULL;
    }
    fwrite(&empty, sizeof empty, 1, out);
    g->out = out, g->at = sizeof empty;
    return g;
}

static int write_gsd(FILE *out, const struct export_frame *m, enum part part, bool first,
                     struct failure *failure)
{
    (void)part;
    if (first && !(*m->kept = gsd_begin(out, failure))) return failure->status;
    return put_frame(*m->kept, m->packing, failure);
}

/* The names and the index, and where they are */
static int end_gsd(FILE *out, void *kept, struct failure *failure)
{
    struct gsd *g = kept;
    struct header h = { .magic = 0x65DF65DF65DF65DF,
                        .index_entries = (uint64_t)g->entries,
                        .schema_version = 1 << 16 | 4,
                        .file_version = 2 << 16,
                        .application = "nsd " NSD_VERSION,
                        .schema = "hoomd" };
    size_t names = 0;
    h.names = (uint64_t)g->at;
    for (int k = 0; k < CHUNKS; k++)
        names += fwrite(chunks[k].name, 1, strlen(chunks[k].name) + 1, out);
    for (h.names_entries = names / NAME + 1; names < h.names_entries * NAME; names++) fputc(0, out);
    h.index = h.names + names;
    if (g->entries) fwrite(g->entry, sizeof *g->entry, (size_t)g->entries, out);
    if (!fseek(out, 0, SEEK_SET)) fwrite(&h, sizeof h, 1, out);
    free(g->entry), free(g);
    (void)failure;
    return 0;
}

const struct format format_gsd = {
    .name = "gsd",
    .ending = "gsd",
    .help = "HOOMD GSD, for OVITO: grains with their shapes",
    .joins = true,
    .binary = true,
    .write = write_gsd,
    .end = end_gsd,
};
