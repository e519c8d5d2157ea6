/* convert/ondem.c: ON-DEM's exchange format [convert/ondem.h]: grains, planes across an axis, contacts; one frame. */

#include "convert/format.h"
#include "file/shape_tables.h"
#include "file/vtkhdf.h"
#include "state/contact.h"
#include "state/packing.h"

#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*
 * A packing in ON-DEM's exchange format [nsd-export(1)], by which DEM programs hand packings to each
 * other: one moment. /VTKHDF is a MultiBlockDataSet with the bodies as points, spheres in the block Points and the rest
 * in Others; /ONDEM has the scene, the materials and the contacts. What the format lacks is in /nsd as in a
 * document [nsd-format(5)], and in columns called nsd_...: shapes, the materials of pairs, the periodic cell.
 */

/* The file as bytes, to be freed; contacts may be NULL. NULL: EX_SOFTWARE. */
void *ondem_write(const struct packing *p, const struct contacts *contacts, size_t *size,
                  struct failure *failure);

/*
 * convert/ondem.c: [convert/ondem.h], by the layout of October 2026 that ON-DEM's working group 3 describes in its
 * implementation's README: a column for each field, NaN and -1 where it does not apply to a body; quaternions are
 * (w, x, y, z); a normal force is positive where it pulls. Hard contact has no stiffness: it is infinite.
 */

enum {
    MINOR = 5, /* of the version of VTKHDF that ON-DEM's files say */
    FIXED = 63 /* blocked_dofs: all six */
};

enum ondem_shape { SPHERE, BOX, POLYHEDRON, CLUMP, WALL, FACET, OTHER, SHAPES };
static const char *const shape_names[SHAPES] = { "sphere", "box",   "polyhedron", "clump",
                                                 "wall",   "facet", "other" };
static const char *const group_names[] = { "Points", "Others" };

/* A body of the file; NaN and -1: does not apply */
struct ondem_row {
    int64_t body_id, shape_type, material_id, clump_id, blocked_dofs, wall_axis, wall_sense, shape;
    double x[3], velocity[3], angular_velocity[3], orientation[4], mass, volume, inertia[9], radius,
        dimensions[3], relative_position[3], relative_orientation[4], reach, mean_inertia;
};

static const struct {
    const char *name;
    bool whole, always;
    int width;
    size_t at;
} columns[] = {
    { "body_id", true, true, 1, offsetof(struct ondem_row, body_id) },
    { "shape_type", true, true, 1, offsetof(struct ondem_row, shape_type) },
    { "material_id", true, true, 1, offsetof(struct ondem_row, material_id) },
    { "clump_id", true, true, 1, offsetof(struct ondem_row, clump_id) },
    { "velocity", false, true, 3, offsetof(struct ondem_row, velocity) },
    { "angular_velocity", false, true, 3, offsetof(struct ondem_row, angular_velocity) },
    { "orientation", false, true, 4, offsetof(struct ondem_row, orientation) },
    { "mass", false, true, 1, offsetof(struct ondem_row, mass) },
    { "volume", false, true, 1, offsetof(struct ondem_row, volume) },
    { "inertia", false, true, 9, offsetof(struct ondem_row, inertia) },
    { "blocked_dofs", true, true, 1, offsetof(struct ondem_row, blocked_dofs) },
    { "radius", false, true, 1, offsetof(struct ondem_row, radius) },
    { "dimensions", false, false, 3, offsetof(struct ondem_row, dimensions) },
    { "clump_relative_position", false, false, 3, offsetof(struct ondem_row, relative_position) },
    { "clump_relative_orientation", false, false, 4,
      offsetof(struct ondem_row, relative_orientation) },
    { "wall_axis", true, false, 1, offsetof(struct ondem_row, wall_axis) },
    { "wall_sense", true, false, 1, offsetof(struct ondem_row, wall_sense) },
    { "nsd_shape", true, false, 1, offsetof(struct ondem_row, shape) },
    { "nsd_radius", false, false, 1, offsetof(struct ondem_row, reach) },
    { "nsd_inertia", false, false, 1, offsetof(struct ondem_row, mean_inertia) },
};

enum { COLUMNS = sizeof columns / sizeof columns[0] };

struct ondem_rows {
    int64_t n, room, next_id;
    struct ondem_row *row;
};

/* ---- rows ---- */

static struct ondem_row *ondem_add_row(struct ondem_rows *b, struct failure *failure)
{
    if (b->n == b->room) {
        int64_t room = b->room ? 2 * b->room : 256;
        struct ondem_row *more = realloc(b->row, (size_t)room * sizeof *more);
        if (!more) return failure_set(failure, EX_SOFTWARE, "no memory for an export"), NULL;
        b->row = more, b->room = room;
    }
    struct ondem_row *r = &b->row[b->n++];
    // every number is one that does not apply until it is set
    double *real = r->x;
    const size_t reals = (sizeof *r - offsetof(struct ondem_row, x)) / sizeof *real;
    *r = (struct ondem_row){ -1,    -1, -1, -1,    -1, -1,    -1,    -1,    { 0 }, { 0 }, { 0 },
                             { 0 }, 0,  0,  { 0 }, 0,  { 0 }, { 0 }, { 0 }, 0,     0 };
    for (size_t k = 0; k < reals; k++) real[k] = NAN;
    return r;
}

static void ondem_put3(double out[3], vec3 x)
{
    out[0] = x.x, out[1] = x.y, out[2] = x.z;
}

static void put4(double out[4], quat q)
{
    out[0] = q.w, out[1] = q.x, out[2] = q.y, out[3] = q.z;
}

/* Is the hull a box along its own axes? Half its sides */
static bool is_box(const struct shape *s, vec3 *half)
{
    if (s->form != SHAPE_HULL || s->round > 0 || s->vertices != 8 || s->faces != 6) return false;
    *half = v3(fabs(s->vertex[0].x), fabs(s->vertex[0].y), fabs(s->vertex[0].z));
    for (int k = 0; k < 8; k++) {
        const vec3 x = s->vertex[k];
        if (!(fabs(fabs(x.x) - half->x) < 1e-12 && fabs(fabs(x.y) - half->y) < 1e-12 &&
              fabs(fabs(x.z) - half->z) < 1e-12))
            return false;
    }
    return true;
}

static void set_motion(struct ondem_row *r, vec3 x, vec3 v, vec3 w, quat q)
{
    ondem_put3(r->x, x), ondem_put3(r->velocity, v), ondem_put3(r->angular_velocity, w),
        put4(r->orientation, q);
}

/* The balls of a clump, bodies of their own that have no mass */
static int ondem_add_members(struct ondem_rows *b, const struct packing *p, int64_t i,
                             struct failure *failure)
{
    const struct shape *s = &p->shapes.s[p->shape[i]];
    const quat one = { 1, 0, 0, 0 };
    for (int32_t k = 0; k < s->vertices; k++) {
        struct ondem_row *r = ondem_add_row(b, failure);
        if (!r) return failure->status;
        vec3 from = v3_scale(p->radius[i], s->vertex[k]), away = quat_turn(p->q[i], from);
        set_motion(r, v3_add(p->x[i], away), v3_add(p->v[i], v3_cross(p->w[i], away)), p->w[i],
                   p->q[i]);
        r->body_id = b->next_id++, r->shape_type = SPHERE, r->material_id = p->kind[i];
        r->clump_id = p->id[i], r->radius = p->radius[i] * s->ball[k];
        r->blocked_dofs = p->mass[i] > 0 ? 0 : FIXED;
        ondem_put3(r->relative_position, from), put4(r->relative_orientation, one);
    }
    return 0;
}

static int ondem_add_body(struct ondem_rows *b, const struct packing *p, int64_t i,
                          struct failure *failure)
{
    const struct shape *s = packing_shape(p, i);
    struct ondem_row *r = ondem_add_row(b, failure);
    double volume, inertia;
    vec3 half;
    if (!r) return failure->status;
    set_motion(r, p->x[i], p->v[i], p->w[i], p->q[i]);
    if (s)
        packing_solid_shape(p->dim, s, p->radius[i], 1, &volume, &inertia);
    else
        packing_solid(p->dim, p->radius[i], 1, &volume, &inertia);
    const double mean = s ? (s->moment[0] + s->moment[1] + s->moment[2]) / 3 : 1;
    for (int k = 0; k < 9; k++)
        r->inertia[k] = k % 4              ? 0
                        : s && p->dim == 3 ? p->inertia[i] * (s->moment[k / 4] / mean)
                                           : p->inertia[i];
    r->body_id = p->id[i], r->material_id = p->kind[i], r->mass = p->mass[i], r->volume = volume;
    r->blocked_dofs = p->mass[i] > 0 ? 0 : FIXED;
    r->shape_type = !s                                         ? SPHERE
                    : s->form == SHAPE_CLUMP                   ? CLUMP
                    : is_box(s, &half)                         ? BOX
                    : s->form == SHAPE_HULL && !(s->round > 0) ? POLYHEDRON
                                                               : OTHER;
    if (!s) r->radius = p->radius[i];
    if (r->shape_type == BOX) ondem_put3(r->dimensions, v3_scale(2 * p->radius[i], half));
    if (r->shape_type == CLUMP) r->material_id = -1;
    if (s) r->shape = p->shape[i], r->reach = p->radius[i], r->mean_inertia = p->inertia[i];
    return r->shape_type == CLUMP ? ondem_add_members(b, p, i, failure) : 0;
}

/* The axis that a plane lies across, 0 to 2, and the side where bodies are; -1: it is no such wall */
static int axis_of(const struct wall *w, vec3 n, int *sense)
{
    const double c[3] = { n.x, n.y, n.z };
    for (int k = 0; k < 3 && w->shape == 0; k++)
        if (fabs(c[k]) == 1) return *sense = c[k] > 0 ? 1 : -1, k;
    return -1;
}

/* Planes across an axis; *id: what each wall is called, -1: it is left out */
static int add_walls(struct ondem_rows *b, const struct packing *p, int64_t *id,
                     struct failure *failure)
{
    for (int32_t k = 0; k < p->walls; k++) {
        const struct wall *w = &p->wall[k];
        int sense = 0,
            axis = wall_there(w, p->t) ? axis_of(w, wall_normal(p, w, p->t), &sense) : -1;
        id[k] = -1;
        if (axis < 0) continue;
        struct ondem_row *r = ondem_add_row(b, failure);
        if (!r) return failure->status;
        const vec3 x = wall_at(p, w, p->t);
        const quat one = { 1, 0, 0, 0 };
        set_motion(r, x, wall_velocity(p, w, x), v3(0, 0, 0), one);
        r->body_id = id[k] = b->next_id++, r->shape_type = WALL, r->material_id = w->kind;
        r->blocked_dofs = FIXED, r->mass = 0, r->wall_axis = axis, r->wall_sense = sense;
        for (int j = 0; j < 9; j++) r->inertia[j] = 0;
    }
    return 0;
}

/* ---- datasets ---- */

/* Which of the structs are meant, in their order; NULL: all */
struct choice {
    int64_t n;
    const int64_t *row;
};

/* A member of all structs of an array */
struct ondem_member {
    const char *first; /* that of the first struct */
    size_t stride;     /* bytes of a struct */
    bool whole;        /* of type int64_t, else double */
    int width;         /* numbers */
};

/* A dataset of n rows, gathered from structs */
static int put_column(hid_t file, const char *path, struct choice of, struct ondem_member m,
                      struct failure *failure)
{
    const hsize_t shape[2] = { (hsize_t)of.n, (hsize_t)m.width };
    const size_t row = (size_t)m.width * 8;
    char *out = malloc((size_t)of.n * row + 1);
    if (!out) return failure_set(failure, EX_SOFTWARE, "no memory for an export");
    for (int64_t i = 0; i < of.n; i++)
        memcpy(out + (size_t)i * row, m.first + (size_t)(of.row ? of.row[i] : i) * m.stride, row);
    h5_write(
        file, path,
        h5_array(m.whole ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE, m.width > 1 ? 2 : 1, shape, out),
        NULL, failure);
    free(out);
    return failure->status;
}

static int put_scalar(hid_t file, const char *group, const char *name, bool whole, double value,
                      struct failure *failure)
{
    char path[160];
    const int64_t as_whole = whole ? (int64_t)value : 0;
    snprintf(path, sizeof path, "%s/%s", group, name);
    return h5_write(file, path,
                    h5_scalar(whole ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE,
                              whole ? (const void *)&as_whole : (const void *)&value),
                    NULL, failure);
}

/* Texts of any length, as h5py has lists of them */
static int ondem_put_texts(hid_t file, const char *path, const char *const *text, int n,
                           struct failure *failure)
{
    const hsize_t shape = (hsize_t)n;
    hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate_simple(1, &shape, NULL),
          plist = h5_dataset_plist();
    H5Tset_size(type, H5T_VARIABLE), H5Tset_cset(type, H5T_CSET_UTF8);
    hid_t set = H5Dcreate2(file, path, type, space, H5P_DEFAULT, plist, H5P_DEFAULT);
    bool good = set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) >= 0;
    if (set >= 0) good &= H5Dclose(set) >= 0;
    H5Tclose(type), H5Sclose(space), H5Pclose(plist);
    return good ? 0 : failure_set(failure, EX_SOFTWARE, "%s: cannot be made", path);
}

/* A text of any length, as h5py writes attributes */
static int put_attribute(hid_t file, const char *path, const char *name, const char *text,
                         struct failure *failure)
{
    hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, H5T_VARIABLE), H5Tset_cset(type, H5T_CSET_UTF8);
    hid_t at =
        H5Acreate_by_name(file, path, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    bool good = at >= 0 && H5Awrite(at, type, &text) >= 0;
    if (at >= 0) good &= H5Aclose(at) >= 0;
    H5Tclose(type), H5Sclose(space);
    return good ? 0 : failure_set(failure, EX_SOFTWARE, "%s: cannot be made", path);
}

static int put_cells(hid_t file, const char *block, const char *name, int64_t n,
                     struct failure *failure)
{
    static const char *const part[] = { "NumberOfCells", "NumberOfConnectivityIds", "Offsets",
                                        "Connectivity" };
    int64_t *number = malloc(((size_t)n + 1) * sizeof *number);
    if (!number) return failure_set(failure, EX_SOFTWARE, "no memory for an export");
    for (int64_t i = 0; i <= n; i++) number[i] = i;
    const int64_t rows[] = { 1, 1, n + 1, n }, *value[] = { &n, &n, number, number };
    for (int k = 0; k < 4 && !failure->status; k++) {
        char path[160];
        snprintf(path, sizeof path, "%s/%s/%s", block, name, part[k]);
        const hsize_t shape = (hsize_t)rows[k];
        h5_write(file, path, h5_vector(H5T_NATIVE_INT64, shape, value[k]), NULL, failure);
    }
    free(number);
    return failure->status;
}

/* Is there a value of this column in any body? */
static bool is_used(const struct ondem_rows *b, int c)
{
    for (int64_t i = 0; i < b->n; i++) {
        const char *at = (const char *)&b->row[i] + columns[c].at;
        int64_t whole;
        double real;
        memcpy(&whole, at, sizeof whole), memcpy(&real, at, sizeof real);
        if (columns[c].whole ? whole != -1 : !isnan(real)) return true;
    }
    return false;
}

static int ondem_put_block(hid_t file, int group, const struct ondem_rows *b, struct choice of,
                           struct failure *failure)
{
    char block[60], path[160];
    const char *rows = b->row ? (const char *)b->row : "";
    snprintf(block, sizeof block, "/VTKHDF/%s", group_names[group]);
    snprintf(path, sizeof path, "%s/NumberOfPoints", block);
    if (vtkhdf_group(file, block, failure) ||
        vtkhdf_type(file, block, "PolyData", MINOR, failure) ||
        h5_write(file, path, h5_vector(H5T_NATIVE_INT64, 1, &of.n), NULL, failure))
        return failure->status;
    snprintf(path, sizeof path, "%s/Points", block);
    const struct ondem_member points = { rows + offsetof(struct ondem_row, x), sizeof *b->row,
                                         false, 3 };
    if (put_column(file, path, of, points, failure) ||
        put_cells(file, block, "Vertices", of.n, failure) ||
        put_cells(file, block, "Lines", 0, failure) ||
        put_cells(file, block, "Polygons", 0, failure) ||
        put_cells(file, block, "Strips", 0, failure))
        return failure->status;
    for (int k = 0; k < COLUMNS; k++) {
        if (!columns[k].always && !is_used(b, k)) continue;
        snprintf(path, sizeof path, "%s/PointData/%s", block, columns[k].name);
        const struct ondem_member m = { rows + columns[k].at, sizeof *b->row, columns[k].whole,
                                        columns[k].width };
        if (put_column(file, path, of, m, failure) ||
            (columns[k].width == 4 && put_attribute(file, path, "order", "wxyz", failure)))
            return failure->status;
    }
    snprintf(path, sizeof path, "/VTKHDF/Assembly/%s", group_names[group]);
    return H5Lcreate_soft(block, file, path, H5P_DEFAULT, H5P_DEFAULT) < 0
               ? failure_set(failure, EX_SOFTWARE, "%s: cannot be made", path)
               : 0;
}

static int put_blocks(hid_t file, const struct ondem_rows *b, struct failure *failure)
{
    int64_t *row = malloc(((size_t)b->n + 1) * sizeof *row);
    if (!row) return failure_set(failure, EX_SOFTWARE, "no memory for an export");
    if (!vtkhdf_group(file, "/VTKHDF", failure) &&
        !vtkhdf_type(file, "/VTKHDF", "MultiBlockDataSet", MINOR, failure))
        vtkhdf_group(file, "/VTKHDF/Assembly", failure);
    for (int group = 0; group < 2 && !failure->status; group++) {
        struct choice of = { 0, row };
        for (int64_t i = 0; i < b->n; i++)
            if ((b->row[i].shape_type != SPHERE) == group) row[of.n++] = i;
        ondem_put_block(file, group, b, of, failure);
    }
    free(row);
    return failure->status;
}

/* ---- the simulation group ---- */

static int put_scene(hid_t file, const struct packing *p, struct failure *failure)
{
    static const char scene[] = "/ONDEM/Scene";
    static const char *const units[] = { "m", "kg", "s" };
    const double g[3] = { p->g.x, p->g.y, p->g.z };
    return h5_group(file, scene, failure) ||
           h5_attr(file, scene, "time", h5_scalar(H5T_NATIVE_DOUBLE, &p->t), failure) ||
           h5_attr(file, scene, "timestep", h5_scalar(H5T_NATIVE_DOUBLE, &p->dt), failure) ||
           h5_attr(file, scene, "iteration", h5_scalar(H5T_NATIVE_INT64, &p->step), failure) ||
           h5_write(file, "/ONDEM/Scene/gravity", h5_vector(H5T_NATIVE_DOUBLE, 3, g), NULL,
                    failure) ||
           ondem_put_texts(file, "/ONDEM/Scene/units", units, 3, failure) ||
           ondem_put_texts(file, "/ONDEM/Scene/display_group_names", group_names, 2, failure) ||
           ondem_put_texts(file, "/ONDEM/Scene/shape_names", shape_names, SHAPES, failure);
}

/* kg/m^3: of the bodies of a kind; NaN without any */
static double density_of(const struct ondem_rows *b, int32_t kind)
{
    double mass = 0, volume = 0;
    for (int64_t i = 0; i < b->n; i++)
        if (b->row[i].material_id == kind && b->row[i].mass > 0)
            mass += b->row[i].mass, volume += b->row[i].volume;
    return volume > 0 ? mass / volume : NAN;
}

static int put_materials(hid_t file, const struct packing *p, const struct ondem_rows *b,
                         struct failure *failure)
{
    for (int32_t k = 0; k < p->kinds && !failure->status; k++) {
        char group[60], path[80];
        snprintf(group, sizeof group, "/ONDEM/Materials/%" PRId32, k);
        snprintf(path, sizeof path, "%s/label", group);
        if (put_scalar(file, group, "id", true, k, failure) ||
            put_scalar(file, group, "density", false, density_of(b, k), failure) ||
            put_scalar(file, group, "normal_stiffness", false, INFINITY, failure) ||
            put_scalar(file, group, "shear_stiffness", false, INFINITY, failure) ||
            put_scalar(file, group, "shear_friction", false, p->mu[k * p->kinds + k], failure) ||
            put_scalar(file, group, "shear_damping", false, 0, failure) ||
            h5_write_text(file, path, p->kind_name[k], failure))
            return failure->status;
        put_attribute(file, group, "schema_classes", "linear_elastic_frictional_3D", failure);
        put_attribute(file, group, "provisional", "hard contact: both stiffnesses are infinite",
                      failure);
    }
    return failure->status;
}

struct interaction {
    int64_t id1, id2;
    double normal[3], point[3], normal_force, shear_force[3], kn, ks, friction, overlap;
};

static const struct {
    const char *name;
    bool whole;
    int width;
    size_t at;
} of_contacts[] = {
    { "id1", true, 1, offsetof(struct interaction, id1) },
    { "id2", true, 1, offsetof(struct interaction, id2) },
    { "normal", false, 3, offsetof(struct interaction, normal) },
    { "contact_point", false, 3, offsetof(struct interaction, point) },
    { "normal_force", false, 1, offsetof(struct interaction, normal_force) },
    { "shear_force", false, 3, offsetof(struct interaction, shear_force) },
    { "kn", false, 1, offsetof(struct interaction, kn) },
    { "ks", false, 1, offsetof(struct interaction, ks) },
    { "friction_coefficient", false, 1, offsetof(struct interaction, friction) },
    { "overlap", false, 1, offsetof(struct interaction, overlap) },
};

/* Contacts that push or pull, of bodies that are in the file; a clump's is the clump's */
static int ondem_put_contacts(hid_t file, const struct packing *p, const struct contacts *t,
                              const int64_t *wall_id, struct failure *failure)
{
    static const char group[] = "/ONDEM/Interactions/hard_contact";
    struct interaction *list = malloc(((size_t)t->n + 1) * sizeof *list);
    int64_t n = 0;
    if (!list) return failure_set(failure, EX_SOFTWARE, "no memory for an export");
    for (int64_t i = 0; i < t->n; i++) {
        const struct contact *c = &t->c[i];
        const vec3 r = contact_in_space(c, t->found[i].r), force = v3_scale(1 / p->dt, r);
        const double along = v3_dot(force, c->n);
        int64_t a = c->a >= 0 ? p->id[c->a] : wall_id[-1 - c->a];
        if (a < 0 || v3_dot(force, force) == 0) continue;
        struct interaction *it = &list[n++];
        *it = (struct interaction){ a,     p->id[c->b], { 0 },    { 0 }, -along,
                                    { 0 }, INFINITY,    INFINITY, c->mu, -c->gap };
        ondem_put3(it->normal, c->n), ondem_put3(it->point, c->x);
        ondem_put3(it->shear_force, v3_axpy(force, -along, c->n));
    }
    if (!h5_group(file, group, failure))
        h5_attr(file, group, "count", h5_scalar(H5T_NATIVE_INT64, &n), failure);
    for (size_t k = 0; k < sizeof of_contacts / sizeof *of_contacts && !failure->status; k++) {
        char path[120];
        snprintf(path, sizeof path, "%s/%s", group, of_contacts[k].name);
        const struct ondem_member m = { (const char *)list + of_contacts[k].at, sizeof *list,
                                        of_contacts[k].whole, of_contacts[k].width };
        put_column(file, path, (struct choice){ n, NULL }, m, failure);
    }
    free(list);
    return failure->status;
}

/* ---- what the format lacks ---- */

static int put_extension(hid_t file, const struct packing *p, struct failure *failure)
{
    static const struct {
        const char *path;
        size_t at;
    } law[] = { { "/nsd/material/mu", offsetof(struct packing, mu) },
                { "/nsd/material/en", offsetof(struct packing, en) },
                { "/nsd/material/et", offsetof(struct packing, et) } };
    const hsize_t square[2] = { (hsize_t)p->kinds, (hsize_t)p->kinds }, edges[2] = { 3, 3 };
    int32_t repeats[3];
    double edge[9];
    if (h5_group(file, "/nsd", failure) ||
        h5_attr(file, "/nsd", "dim", h5_scalar(H5T_NATIVE_INT, &p->dim), failure))
        return failure->status;
    for (int k = 0; k < 3; k++)
        if (h5_write(file, law[k].path,
                     h5_array(H5T_NATIVE_DOUBLE, 2, square,
                              *(double *const *)((const char *)p + law[k].at)),
                     NULL, failure))
            return failure->status;
    for (int k = 0; k < 3; k++)
        repeats[k] = p->cell.repeats[k], ondem_put3(edge + 3 * k, p->cell.edge[k]);
    if (cell_repeats(&p->cell) &&
        (h5_write(file, "/nsd/cell/origin", h5_vector(H5T_NATIVE_DOUBLE, 3, &p->cell.origin), NULL,
                  failure) ||
         h5_write(file, "/nsd/cell/edges", h5_array(H5T_NATIVE_DOUBLE, 2, edges, edge), NULL,
                  failure) ||
         h5_write(file, "/nsd/cell/repeats", h5_vector(H5T_NATIVE_INT32, 3, repeats), NULL,
                  failure)))
        return failure->status;
    return shape_tables_write(file, p, failure);
}

static void *image_of(hid_t file, size_t *size, struct failure *failure)
{
    ssize_t n = H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 ? -1 : H5Fget_file_image(file, NULL, 0);
    void *bytes = n < 0 ? NULL : malloc((size_t)n + 1);
    if (bytes && H5Fget_file_image(file, bytes, (size_t)n) != n) free(bytes), bytes = NULL;
    if (!bytes) failure_set(failure, EX_SOFTWARE, "no memory for an export");
    *size = n < 0 ? 0 : (size_t)n;
    return bytes;
}

void *ondem_write(const struct packing *p, const struct contacts *contacts, size_t *size,
                  struct failure *failure)
{
    struct ondem_rows b = { 0 };
    void *bytes = NULL;
    h5_start();
    hid_t access = H5Pcreate(H5P_FILE_ACCESS), plist = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_fapl_core(access, 1 << 20, false), H5Pset_obj_track_times(plist, false);
    hid_t file = H5Fcreate("ondem", H5F_ACC_TRUNC, plist, access);
    H5Pclose(access), H5Pclose(plist);
    int64_t *wall_id = calloc((size_t)p->walls + 1, sizeof *wall_id);
    if (file < 0 || !wall_id) failure_set(failure, EX_SOFTWARE, "no memory for an export");
    for (int64_t i = 0; i < p->n; i++)
        if (p->id[i] >= b.next_id) b.next_id = (int64_t)p->id[i] + 1;
    for (int64_t i = 0; i < p->n && !failure->status; i++) ondem_add_body(&b, p, i, failure);
    if (!failure->status && !add_walls(&b, p, wall_id, failure) && !put_blocks(file, &b, failure) &&
        !put_scene(file, p, failure) && !put_materials(file, p, &b, failure) &&
        (!contacts || !contacts->found ||
         !ondem_put_contacts(file, p, contacts, wall_id, failure)) &&
        !put_extension(file, p, failure))
        bytes = image_of(file, size, failure);
    if (file >= 0) H5Fclose(file);
    free(b.row), free(wall_id);
    return bytes;
}

static int write_ondem(FILE *out, const struct export_frame *m, enum part part, bool first,
                       struct failure *failure)
{
    size_t size = 0;
    (void)part, (void)first;
    if (m->packing->dim == 2) // which would come back as balls
        return failure_set(failure, EX_DATAERR,
                           "discs: ON-DEM's format is for 3D; --to gsd writes discs");
    void *bytes = ondem_write(m->packing, m->contacts, &size, failure);
    if (!bytes) return failure->status;
    fwrite(bytes, 1, size, out);
    free(bytes);
    return 0;
}

const struct format format_ondem = {
    .name = "ondem",
    .ending = "vtkhdf",
    .help = "ON-DEM exchange format, for other DEM programs and ParaView",
    .binary = true,
    .write = write_ondem,
};
