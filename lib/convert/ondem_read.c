#include "convert/ondem_read.h"

#include "file/shape_tables.h"
#include "file/source.h"
#include "shape/solid.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FIXED = 63, BLOCKS_MOST = 64, MATERIALS_MOST = 4096, PATH = 300 };

/* Shapes by the names that ON-DEM gives them */
enum shape_kind { SPHERE, BOX, POLYHEDRON, CLUMP, WALL, OTHER };
static const char *const shape_kind_name[] = {
    "sphere", "box", "polyhedron", "clump", "wall", NULL
};

struct material {
    int64_t id;
    char *label;
    double friction; /* NaN: not said */
};

/* A sphere that is one of a clump's */
struct ondem_read_member {
    int64_t clump, id, material;
    vec3 x; /* m, in the axes of the clump */
    double r;
};

struct file {
    const char *path;
    struct source *in;
    struct packing *p;
    struct failure *failure;
    int kinds_of_shape;
    enum shape_kind *shape; /* [kinds_of_shape] what shape_type means in this file */
    int materials;
    struct material *material;
    int64_t members, members_room;
    struct ondem_read_member *member; /* [members] by their clumps */
    int64_t n;                        /* bodies so far */
    int32_t walls;                    /* walls so far */
};

static int ondem_read_fault(const struct file *f, const char *place, const char *trouble)
{
    return failure_set(f->failure, EX_DATAERR, "%.150s: %.100s: %.120s", f->path, place, trouble);
}

bool ondem_looks(int fd)
{
    static const char magic[8] = "\x89HDF\r\n\x1a\n";
    char bytes[8] = { 0 };
    return pread(fd, bytes, sizeof bytes, 0) == sizeof bytes && !memcmp(bytes, magic, sizeof magic);
}

/* ---- lists ---- */

/* Which word is what; words end with newlines */
static int read_shape_names(struct file *f)
{
    char *text = source_lines(f->in, "/ONDEM/Scene/shape_names", f->failure);
    if (f->failure->status) return f->failure->status;
    if (!text)
        return ondem_read_fault(f, "/ONDEM/Scene/shape_names", "no list of the names of shapes");
    for (const char *s = text; *s; s++) f->kinds_of_shape += *s == '\n';
    f->shape = calloc((size_t)f->kinds_of_shape + 1, sizeof *f->shape);
    if (!f->shape) failure_set(f->failure, EX_SOFTWARE, "no memory for the shapes");
    char *at = text;
    for (int k = 0; f->shape && k < f->kinds_of_shape; k++) {
        char *end = strchr(at, '\n');
        *end = 0;
        f->shape[k] = SPHERE;
        while (f->shape[k] < OTHER && strcmp(shape_kind_name[f->shape[k]], at) != 0) f->shape[k]++;
        at = end + 1;
    }
    free(text);
    return f->failure->status;
}

/* A group NAME directly in another? Its name, else NULL */
static const char *child_of(const char *group, const char *path)
{
    size_t n = strlen(group);
    if (strncmp(path, group, n) != 0 || path[n] != '/' || strchr(path + n + 1, '/')) return NULL;
    return path + n + 1;
}

static double scalar(struct file *f, const char *group, const char *name)
{
    char path[PATH];
    double x = NAN;
    snprintf(path, sizeof path, "%.200s/%s", group, name);
    if (source_has(f->in, path)) source_read(f->in, path, COLUMN_F64, 1, &x, f->failure);
    return x;
}

static int ondem_read_material(struct file *f, const char *group)
{
    char path[PATH];
    if (f->materials == MATERIALS_MOST) return ondem_read_fault(f, group, "too many materials");
    struct material *m = &f->material[f->materials++];
    const double id = scalar(f, group, "id");
    m->friction = scalar(f, group, "shear_friction");
    snprintf(path, sizeof path, "%.200s/label", group);
    m->label = source_text(f->in, path, NULL, f->failure);
    if (f->failure->status) return f->failure->status;
    if (!(id >= 0 && id <= INT32_MAX && id == floor(id)))
        return ondem_read_fault(f, group, "no id of a material");
    m->id = (int64_t)id;
    const bool named = m->label && *m->label && strlen(m->label) < 200;
    for (const char *c = m->label; named && *c; c++)
        if ((unsigned char)*c < ' ')
            return ondem_read_fault(f, group, "a label with control characters");
    if (named) return 0;
    free(m->label);
    snprintf(path, sizeof path, "%" PRId64, m->id);
    m->label = strdup(path);
    return m->label ? 0 : failure_set(f->failure, EX_SOFTWARE, "no memory for the materials");
}

static int ondem_read_materials(struct file *f)
{
    const char *path;
    const uint64_t *shape;
    f->material = calloc(MATERIALS_MOST, sizeof *f->material);
    if (!f->material) return failure_set(f->failure, EX_SOFTWARE, "no memory for the materials");
    const struct object *o;
    for (int64_t k = 0; (o = source_object(f->in, k, &path, &shape)); k++)
        if (!o->attribute && o->kind == OBJECT_GROUP && child_of("/ONDEM/Materials", path) &&
            ondem_read_material(f, path))
            return f->failure->status;
    return 0;
}

static int32_t ondem_read_kind_of(const struct file *f, int64_t id)
{
    for (int k = 0; k < f->materials; k++)
        if (f->material[k].id == id) return k;
    return -1;
}

/* ---- bodies ---- */

/* The columns of a block, of n bodies */
struct ondem_read_block {
    const char *path;
    int64_t n;
    double *x, *v, *w, *q, *mass, *volume, *inertia, *radius, *sides, *reach, *mean;
    int64_t *id, *shape, *material, *clump, *dofs, *axis, *sense, *row;
};

static void block_free(struct ondem_read_block *b)
{
    free(b->x), free(b->v), free(b->w), free(b->q), free(b->mass), free(b->inertia);
    free(b->volume);
    free(b->radius), free(b->sides), free(b->reach), free(b->mean), free(b->id), free(b->shape);
    free(b->material), free(b->clump), free(b->dofs), free(b->axis), free(b->sense), free(b->row);
}

static void *read_column(struct file *f, const struct ondem_read_block *b, const char *name,
                         bool whole, int width, bool needed)
{
    char path[PATH];
    uint64_t shape[4] = { 0 };
    snprintf(path, sizeof path, "%.200s/%s", b->path, name);
    if (f->failure->status) return NULL;
    if (!source_has(f->in, path)) {
        if (needed) ondem_read_fault(f, path, "no such column");
        return NULL;
    }
    int rank = source_shape(f->in, path, shape);
    if (rank != (width > 1 ? 2 : 1) || shape[0] != (uint64_t)b->n ||
        (width > 1 && shape[1] != (uint64_t)width))
        return ondem_read_fault(f, path, "not a row for each body"), NULL;
    void *out = malloc((size_t)b->n * (size_t)width * 8 + 1);
    if (!out)
        failure_set(f->failure, EX_SOFTWARE, "no memory for the bodies");
    else if (b->n && source_rows(f->in, path,
                                 (struct slab){ whole ? COLUMN_I64 : COLUMN_F64, 0, b->n, width },
                                 out, f->failure))
        free(out), out = NULL;
    return out;
}

static int ondem_read_columns(struct file *f, struct ondem_read_block *b)
{
    b->x = read_column(f, b, "Points", false, 3, true);
    b->id = read_column(f, b, "PointData/body_id", true, 1, true);
    b->shape = read_column(f, b, "PointData/shape_type", true, 1, true);
    b->material = read_column(f, b, "PointData/material_id", true, 1, true);
    b->clump = read_column(f, b, "PointData/clump_id", true, 1, false);
    b->v = read_column(f, b, "PointData/velocity", false, 3, false);
    b->w = read_column(f, b, "PointData/angular_velocity", false, 3, false);
    b->q = read_column(f, b, "PointData/orientation", false, 4, false);
    b->mass = read_column(f, b, "PointData/mass", false, 1, false);
    b->volume = read_column(f, b, "PointData/volume", false, 1, false);
    b->inertia = read_column(f, b, "PointData/inertia", false, 9, false);
    b->radius = read_column(f, b, "PointData/radius", false, 1, false);
    b->dofs = read_column(f, b, "PointData/blocked_dofs", true, 1, false);
    b->sides = read_column(f, b, "PointData/dimensions", false, 3, false);
    b->axis = read_column(f, b, "PointData/wall_axis", true, 1, false);
    b->sense = read_column(f, b, "PointData/wall_sense", true, 1, false);
    b->row = read_column(f, b, "PointData/nsd_shape", true, 1, false);
    b->reach = read_column(f, b, "PointData/nsd_radius", false, 1, false);
    b->mean = read_column(f, b, "PointData/nsd_inertia", false, 1, false);
    return f->failure->status;
}

static int body_fault(const struct file *f, const struct ondem_read_block *b, int64_t i,
                      const char *trouble)
{
    return failure_set(f->failure, EX_DATAERR, "%.150s: %.60s: body %" PRId64 ": %.140s", f->path,
                       b->path, b->id[i], trouble);
}

static bool all_finite(const double *x, int n)
{
    for (int k = 0; k < n; k++)
        if (!isfinite(x[k])) return false;
    return true;
}

/* The row of a shape that is finished: of one that there is, or its own. The shape goes with it. */
static int keep_shape(struct file *f, struct shape *s, const char *called, int32_t *row)
{
    struct packing *p = f->p;
    char name[40];
    // to compare it with each takes some ns
    if (source_draw(f->in, 4 * (uint64_t)p->shapes.n, f->failure))
        return shape_free(s), f->failure->status;
    for (int32_t k = 1; k < p->shapes.n; k++)
        if (shape_same(&p->shapes.s[k], s)) return shape_free(s), *row = k, 0;
    snprintf(name, sizeof name, "%s %d", called, p->shapes.n ? p->shapes.n : 1);
    if (!(s->name = strdup(name))) failure_set(f->failure, EX_SOFTWARE, "no memory for a shape");
    if (f->failure->status) return shape_free(s), f->failure->status;
    if (shapes_add(&p->shapes, 3, s, f->failure)) return f->failure->status;
    *row = p->shapes.n - 1;
    return 0;
}

/* A box of these sides */
static int box_row(struct file *f, const double *sides, double *reach, int32_t *row)
{
    const double r = 0.5 * sqrt(sides[0] * sides[0] + sides[1] * sides[1] + sides[2] * sides[2]);
    static const int32_t face[24] = { 0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4,
                                      2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6 };
    struct shape s = { 0 };
    *reach = r;
    if (shape_alloc(&s, 8, 6, 24, f->failure)) return f->failure->status;
    s.form = SHAPE_HULL;
    for (int k = 0; k < 8; k++)
        s.vertex[k] = v3((k & 1 ? 0.5 : -0.5) * sides[0] / r, (k & 2 ? 0.5 : -0.5) * sides[1] / r,
                         (k & 4 ? 0.5 : -0.5) * sides[2] / r);
    memcpy(s.corner, face, sizeof face);
    for (int k = 0; k <= 6; k++) s.first[k] = 4 * k;
    s.volume = sides[0] * sides[1] * sides[2] / (r * r * r);
    for (int k = 0; k < 3; k++) {
        double a = sides[(k + 1) % 3] / r, c = sides[(k + 2) % 3] / r;
        s.moment[k] = (a * a + c * c) / 12;
    }
    if (shape_finish(&s, 3, f->failure)) return shape_free(&s), f->failure->status;
    return keep_shape(f, &s, "box", row);
}

/* ---- clumps: the spheres that are members of one ---- */

static int by_clump(const void *one, const void *other)
{
    const struct ondem_read_member *a = one, *b = other;
    if (a->clump != b->clump) return a->clump < b->clump ? -1 : 1;
    return (a->id > b->id) - (a->id < b->id);
}

static int ondem_read_add_members(struct file *f, const struct ondem_read_block *b,
                                  const double *at)
{
    for (int64_t i = 0; i < b->n; i++) {
        if (b->clump[i] < 0 || !b->radius || !(b->radius[i] > 0) || !all_finite(at + 3 * i, 3))
            continue;
        if (f->members == f->members_room) {
            int64_t room = f->members_room ? 2 * f->members_room : 256;
            struct ondem_read_member *more = realloc(f->member, (size_t)room * sizeof *more);
            if (!more) return failure_set(f->failure, EX_SOFTWARE, "no memory for the clumps");
            f->member = more, f->members_room = room;
        }
        f->member[f->members++] =
            (struct ondem_read_member){ b->clump[i], b->id[i], b->material[i],
                                        v3(at[3 * i], at[3 * i + 1], at[3 * i + 2]), b->radius[i] };
    }
    return 0;
}

/* The members of the clump with this id, sorted by their own */
static const struct ondem_read_member *members_of(const struct file *f, int64_t clump, int64_t *n)
{
    int64_t lo = 0, hi = f->members;
    while (lo < hi) {
        int64_t k = lo + (hi - lo) / 2;
        if (f->member[k].clump < clump)
            lo = k + 1;
        else
            hi = k;
    }
    for (*n = 0; lo + *n < f->members && f->member[lo + *n].clump == clump;) ++*n;
    return f->member + lo;
}

/* The balls of a clump about its centre, in its principal axes; the moments are those that the file has for it. */
static int clump_row(struct file *f, const struct ondem_read_block *b, int64_t i, double *reach,
                     int32_t *row)
{
    int64_t n;
    const struct ondem_read_member *m = members_of(f, b->id[i], &n);
    const double *I = b->inertia ? b->inertia + 9 * i : NULL, mass = b->mass ? b->mass[i] : 0;
    struct shape s = { 0 };
    struct solid balls = { 0 };
    if (n < 1 || n > SHAPE_VERTICES_MOST)
        return body_fault(f, b, i, "a clump without members, or with more than 4096");
    if (!I || !(mass > 0) || !(I[0] > 0 && I[4] > 0 && I[8] > 0) ||
        fabs(I[1]) + fabs(I[2]) + fabs(I[5]) > 1e-9 * (I[0] + I[4] + I[8]))
        return body_fault(f, b, i, "a clump without a mass and a diagonal inertia");
    for (int64_t k = 0; k < n; k++) *reach = fmax(*reach, v3_norm(m[k].x) + m[k].r);
    if (shape_alloc(&s, (int32_t)n, 0, 0, f->failure)) return f->failure->status;
    s.form = SHAPE_CLUMP;
    for (int64_t k = 0; k < n; k++)
        s.vertex[k] = v3_scale(1 / *reach, m[k].x), s.ball[k] = m[k].r / *reach;
    for (int k = 0; k < 3; k++) s.moment[k] = I[4 * k] / (mass * *reach * *reach);
    s.volume = b->volume ? b->volume[i] / (*reach * *reach * *reach) : 0;
    // else by lines through the balls, which takes some ms for each
    if (!(s.volume > 0) && (source_draw(f->in, 2000000 * (uint64_t)n, f->failure) ||
                            solid_of(&balls, &s, 3, f->failure)))
        return shape_free(&s), f->failure->status;
    if (!(s.volume > 0)) s.volume = balls.volume;
    if (shape_finish(&s, 3, f->failure)) return shape_free(&s), f->failure->status;
    return keep_shape(f, &s, "clump", row);
}

static int ondem_read_add_wall(struct file *f, const struct ondem_read_block *b, int64_t i,
                               int32_t kind)
{
    const int64_t axis = b->axis ? b->axis[i] : -1, sense = b->sense ? b->sense[i] : 0;
    const double *x = b->x + 3 * i, zero[3] = { 0 }, *v = b->v ? b->v + 3 * i : zero;
    if (axis < 0 || axis > 2) return body_fault(f, b, i, "a wall without wall_axis 0, 1 or 2");
    if (sense != 1 && sense != -1)
        return body_fault(f, b, i,
                          "a wall with bodies on both sides: wall_sense has to be 1 or -1");
    struct wall *w = &f->p->wall[f->walls++];
    vec3 n = v3(0, 0, 0);
    *(axis == 0 ? &n.x : axis == 1 ? &n.y : &n.z) = (double)sense;
    *w = boundary_plane(v3(x[0], x[1], x[2]), n, kind);
    w->v = v3(v[0], v[1], v[2]);
    return 0;
}

/* The shape's row in the packing, and the radius of the ball around the body */
static int ondem_read_shape(struct file *f, const struct ondem_read_block *b, int64_t i,
                            enum shape_kind is, int32_t *row, double *reach)
{
    *row = 0;
    if (is == SPHERE) {
        *reach = b->radius ? b->radius[i] : NAN;
        return *reach > 0 && isfinite(*reach) ? 0
                                              : body_fault(f, b, i, "a sphere without a radius");
    }
    if (b->row && b->reach && b->row[i] > 0) {
        if (b->row[i] >= f->p->shapes.n || !(b->reach[i] > 0))
            return body_fault(f, b, i, "nsd_shape is no row of /nsd/shape");
        *row = (int32_t)b->row[i], *reach = b->reach[i];
        return 0;
    }
    if (is == BOX && b->sides && all_finite(b->sides + 3 * i, 3) && b->sides[3 * i] > 0 &&
        b->sides[3 * i + 1] > 0 && b->sides[3 * i + 2] > 0)
        return box_row(f, b->sides + 3 * i, reach, row);
    if (is == CLUMP) return clump_row(f, b, i, reach, row);
    return body_fault(f, b, i,
                      is == BOX ? "a box without dimensions"
                                : "a shape that the format does not describe: only nsd's own are "
                                  "read, in /nsd/shape");
}

static int ondem_read_add_body(struct file *f, const struct ondem_read_block *b, int64_t i)
{
    struct packing *p = f->p;
    if (b->clump && b->clump[i] >= 0) return 0; // what a clump is made of
    if (b->shape[i] < 0 || b->shape[i] >= f->kinds_of_shape)
        return body_fault(f, b, i, "shape_type is none of /ONDEM/Scene/shape_names");
    const enum shape_kind is = f->shape[b->shape[i]];
    int32_t kind = ondem_read_kind_of(f, b->material[i]);
    if (kind < 0 && is == CLUMP) { // that of its members
        int64_t members;
        const struct ondem_read_member *m = members_of(f, b->id[i], &members);
        kind = members ? ondem_read_kind_of(f, m->material) : f->materials ? 0 : -1;
    }
    if (kind < 0) return body_fault(f, b, i, "material_id is none of /ONDEM/Materials");
    if (is == WALL) return ondem_read_add_wall(f, b, i, kind);
    const int64_t dofs = b->dofs ? b->dofs[i] : 0;
    if (dofs != 0 && dofs != FIXED)
        return body_fault(f, b, i, "blocked_dofs: a body is free (0) or fixed (63)");
    if (b->id[i] < 0 || b->id[i] > INT32_MAX) return body_fault(f, b, i, "body_id is out of range");
    const int64_t k = f->n++;
    int32_t row;
    double reach = 0;
    if (ondem_read_shape(f, b, i, is, &row, &reach)) return f->failure->status;
    p->x[k] = v3(b->x[3 * i], b->x[3 * i + 1], b->x[3 * i + 2]), p->radius[k] = reach;
    if (b->v) p->v[k] = v3(b->v[3 * i], b->v[3 * i + 1], b->v[3 * i + 2]);
    if (b->w) p->w[k] = v3(b->w[3 * i], b->w[3 * i + 1], b->w[3 * i + 2]);
    if (b->q) p->q[k] = (quat){ b->q[4 * i], b->q[4 * i + 1], b->q[4 * i + 2], b->q[4 * i + 3] };
    p->id[k] = (int32_t)b->id[i], p->kind[k] = kind;
    if (row && !p->shape && packing_alloc_shapes(p, f->failure)) return f->failure->status;
    if (p->shape) p->shape[k] = row;
    if (dofs == FIXED) return 0; // no mass
    const double *I = b->inertia ? b->inertia + 9 * i : NULL;
    p->mass[k] = b->mass ? b->mass[i] : 0;
    p->inertia[k] = !I                                     ? 0
                    : b->mean && row && b->mean[i] >= 0    ? b->mean[i]
                    : I[0] == I[4] && I[4] == I[8] && !row ? I[0]
                                                           : (I[0] + I[4] + I[8]) / 3;
    if (!(p->mass[k] > 0 && p->inertia[k] > 0))
        return body_fault(f, b, i, "free, and without a mass and inertia");
    return 0;
}

static int for_blocks(struct file *f, int (*each)(struct file *, const char *))
{
    const char *path;
    const uint64_t *shape;
    const struct object *o;
    int blocks = 0;
    for (int64_t k = 0; (o = source_object(f->in, k, &path, &shape)); k++) {
        const char *name = child_of("/VTKHDF", path);
        if (o->attribute || o->kind != OBJECT_GROUP || !name || !strcmp(name, "Assembly")) continue;
        if (++blocks > BLOCKS_MOST) return ondem_read_fault(f, path, "too many blocks");
        if (each(f, path)) return f->failure->status;
    }
    return blocks ? 0
                  : ondem_read_fault(f, "/VTKHDF",
                                     "no block of bodies (files before October 2026 have none)");
}

static int64_t rows_of(struct file *f, const char *block)
{
    char path[PATH];
    uint64_t shape[4] = { 0 };
    snprintf(path, sizeof path, "%.200s/Points", block);
    if (source_shape(f->in, path, shape) != 2 || shape[1] != 3 || shape[0] > INT32_MAX)
        return ondem_read_fault(f, path, "not of shape bodies x 3"), -1;
    return (int64_t)shape[0];
}

/* How many bodies and walls there are at most */
static int count_block(struct file *f, const char *path)
{
    int64_t n = rows_of(f, path);
    f->n += n < 0 ? 0 : n;
    if (!f->failure->status && f->n > INT32_MAX) ondem_read_fault(f, path, "too many bodies");
    return f->failure->status;
}

static int read_members(struct file *f, const char *path)
{
    struct ondem_read_block b = { .path = path, .n = rows_of(f, path) };
    double *at = NULL;
    if (!f->failure->status)
        at = read_column(f, &b, "PointData/clump_relative_position", false, 3, false);
    if (at) {
        b.clump = read_column(f, &b, "PointData/clump_id", true, 1, true);
        b.id = read_column(f, &b, "PointData/body_id", true, 1, true);
        b.material = read_column(f, &b, "PointData/material_id", true, 1, true);
        b.radius = read_column(f, &b, "PointData/radius", false, 1, true);
        if (!f->failure->status) ondem_read_add_members(f, &b, at);
    }
    free(at);
    block_free(&b);
    return f->failure->status;
}

static int read_block(struct file *f, const char *path)
{
    struct ondem_read_block b = { .path = path, .n = rows_of(f, path) };
    if (!f->failure->status && !ondem_read_columns(f, &b))
        for (int64_t i = 0; i < b.n && !f->failure->status; i++) {
            const bool wall =
                b.shape[i] >= 0 && b.shape[i] < f->kinds_of_shape && f->shape[b.shape[i]] == WALL;
            if (wall && f->walls == f->p->walls)
                ondem_read_fault(f, path, "more walls than there can be");
            else
                ondem_read_add_body(f, &b, i);
        }
    block_free(&b);
    return f->failure->status;
}

/* ---- in the order of their ids ---- */

struct ondem_read_place {
    int32_t id;
    int64_t was;
};

static int ondem_read_by_id(const void *one, const void *other)
{
    const struct ondem_read_place *a = one, *b = other;
    return (a->id > b->id) - (a->id < b->id);
}

/* array[k] = what was at place[k].was */
static void ondem_read_gather(void *array, size_t size, const struct ondem_read_place *place,
                              int64_t n, quat *space)
{
    char *room = (char *)space;
    for (int64_t k = 0; array && k < n; k++)
        memcpy(room + (size_t)k * size, (char *)array + (size_t)place[k].was * size, size);
    if (array && n) memcpy(array, room, (size_t)n * size);
}

static int sort_bodies(struct file *f)
{
    struct packing *p = f->p;
    const int64_t n = p->n;
    struct ondem_read_place *place = malloc(((size_t)n + 1) * sizeof *place);
    quat *room = malloc(((size_t)n + 1) * sizeof *room);
    if (!place || !room) failure_set(f->failure, EX_SOFTWARE, "no memory for the bodies");
    for (int64_t k = 0; !f->failure->status && k < n; k++)
        place[k] = (struct ondem_read_place){ p->id[k], k };
    if (!f->failure->status) {
        qsort(place, (size_t)n, sizeof *place, ondem_read_by_id);
        ondem_read_gather(p->x, sizeof *p->x, place, n, room),
            ondem_read_gather(p->v, sizeof *p->v, place, n, room);
        ondem_read_gather(p->w, sizeof *p->w, place, n, room),
            ondem_read_gather(p->q, sizeof *p->q, place, n, room);
        ondem_read_gather(p->radius, sizeof *p->radius, place, n, room);
        ondem_read_gather(p->mass, sizeof *p->mass, place, n, room);
        ondem_read_gather(p->inertia, sizeof *p->inertia, place, n, room);
        ondem_read_gather(p->id, sizeof *p->id, place, n, room),
            ondem_read_gather(p->kind, sizeof *p->kind, place, n, room);
        ondem_read_gather(p->shape, sizeof *p->shape, place, n, room);
    }
    free(place), free(room);
    return f->failure->status;
}

/* ---- the scene ---- */

static int read_cell(struct file *f)
{
    struct cell *c = &f->p->cell;
    int32_t repeats[3] = { 0 };
    double edge[9];
    if (!source_has(f->in, "/nsd/cell/edges")) return 0;
    if (source_read(f->in, "/nsd/cell/edges", COLUMN_F64, 9, edge, f->failure) ||
        source_read(f->in, "/nsd/cell/origin", COLUMN_F64, 3, &c->origin, f->failure) ||
        source_read(f->in, "/nsd/cell/repeats", COLUMN_I32, 3, repeats, f->failure))
        return f->failure->status;
    for (int k = 0; k < 3; k++)
        c->edge[k] = v3(edge[3 * k], edge[3 * k + 1], edge[3 * k + 2]), c->repeats[k] = repeats[k];
    return packing_alloc_images(f->p, f->failure);
}

static int ondem_read_laws(struct file *f, struct import_said *said)
{
    struct packing *p = f->p;
    const uint64_t n = (uint64_t)p->kinds * (uint64_t)p->kinds;
    said->laws = true;
    for (int32_t i = 0; i < p->kinds && i < f->materials; i++)
        for (int32_t j = 0; j < p->kinds && j < f->materials; j++) {
            // Yade's rule for two materials
            p->mu[i * p->kinds + j] = fmin(f->material[i].friction, f->material[j].friction);
            said->laws &= f->material[i].friction >= 0;
        }
    if (!said->laws)
        for (uint64_t k = 0; k < n; k++) p->mu[k] = 0;
    if (!source_has(f->in, "/nsd/material/mu")) return 0;
    said->laws = true;
    return source_read(f->in, "/nsd/material/mu", COLUMN_F64, n, p->mu, f->failure) ||
           source_read(f->in, "/nsd/material/en", COLUMN_F64, n, p->en, f->failure) ||
           source_read(f->in, "/nsd/material/et", COLUMN_F64, n, p->et, f->failure);
}

static int ondem_read_scene(struct file *f, struct import_said *said)
{
    struct packing *p = f->p;
    double dt = 0, g[3] = { NAN, NAN, NAN };
    struct failure none = { 0 };
    source_attribute(f->in, "/ONDEM/Scene", "timestep", (struct numbers){ COLUMN_F64, -1, &dt },
                     &none);
    if (source_has(f->in, "/ONDEM/Scene/gravity"))
        source_read(f->in, "/ONDEM/Scene/gravity", COLUMN_F64, 3, g, f->failure);
    said->dt = dt > 0 && isfinite(dt), said->gravity = all_finite(g, 3), said->masses = true;
    p->dt = said->dt ? dt : 1;
    if (said->gravity) p->g = v3(g[0], g[1], g[2]);
    return f->failure->status;
}

static int ondem_read_open(struct file *f, int dim, struct import_said *said)
{
    if (!source_has(f->in, "/ONDEM"))
        return failure_set(
            f->failure, EX_DATAERR,
            "%s: an HDF5 file without the group /ONDEM: a document is read by \"document\"",
            f->path);
    if (dim != 3)
        return ondem_read_fault(f, "/ONDEM", "bodies in space, and the scene is in the plane");
    int64_t most;
    if (read_shape_names(f) || ondem_read_materials(f) || for_blocks(f, count_block) ||
        for_blocks(f, read_members))
        return f->failure->status;
    if (f->members) qsort(f->member, (size_t)f->members, sizeof *f->member, by_clump);
    most = f->n, f->n = 0;
    struct packing *p = f->p;
    if (packing_init(p, dim, most, f->failure)) return f->failure->status;
    int32_t walls = most > 4096 ? 4096 : (int32_t)most;
    if (packing_alloc_walls(p, walls, f->failure) ||
        packing_alloc_kinds(p, f->materials ? f->materials : 1, f->failure) ||
        shape_tables_read(f->in, p, f->failure) || read_cell(f))
        return f->failure->status;
    for (int k = 0; k < f->materials; k++) {
        free(p->kind_name[k]);
        p->kind_name[k] = f->material[k].label, f->material[k].label = NULL;
    }
    if (for_blocks(f, read_block) || ondem_read_scene(f, said) || ondem_read_laws(f, said))
        return f->failure->status;
    p->walls = f->walls; // what was not needed stays empty behind them
    return packing_resize(p, f->n, f->failure) || sort_bodies(f) ? f->failure->status : 0;
}

static int next_document(struct source *in, const char *path, struct failure *failure)
{
    struct source_document document;
    bool more = false;
    if (source_next(in, &document, &more, failure)) return failure->status;
    return more ? 0 : failure_set(failure, EX_DATAERR, "%s: empty", path);
}

int ondem_read(struct packing *p, const char *path, int dim, struct import_said *said,
               struct failure *failure)
{
    char *name = strdup(path);
    struct file f = { .path = path, .p = p, .failure = failure };
    *p = (struct packing){ 0 };
    if (!name) return failure_set(failure, EX_SOFTWARE, "no memory for a name");
    if (!source_open(&f.in, 1, &name, failure) && !next_document(f.in, path, failure)) {
        ondem_read_open(&f, dim, said);
        struct failure trouble = { 0 };
        if (!failure->status && packing_check(p, &trouble))
            failure_set(failure, trouble.status, "%.200s: %.180s", path, trouble.text);
    }
    if (failure->status) packing_free(p);
    for (int k = 0; k < f.materials; k++) free(f.material[k].label);
    free(f.material), free(f.shape), free(f.member);
    if (f.in) source_close(f.in);
    free(name);
    return failure->status;
}
