#include "sink.h"

#include "h5.h"
#include "layout.h"
#include "stream.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SERIES = 64, CHUNK_FRAMES = 64, CHUNK_CONTACTS = 1024, CHUNK_BODIES = 8192 };

/* A dataset that grows, kept open. */
struct series {
    char path[80];
    hid_t set;
};

struct sink {
    int fd;
    const char *name; /* of the output, for messages */
    bool growing;
    int disk;             /* the growing document opened anew: > gives a descriptor only to write */
    hid_t file;           /* the same as HDF5 sees it, -1 before its first frame */
    struct packing first; /* of it: what the others must share */
    bool contacts, solved; /* so far: are there any, and are they solved */
    int64_t step;          /* of its last frame */
    int64_t rows;          /* contacts so far */
    struct series series[SERIES];
    int open; /* series */
};

static int io_trouble(const struct sink *s, struct why *why, const char *trouble)
{
    return why_set(why, EX_IOERR, "%s: %s", s->name, trouble);
}

int sink_open(struct sink **out, const char *path, enum sink_kind kind, struct why *why)
{
    struct sink *s = *out = calloc(1, sizeof *s);
    if (!s) return why_set(why, EX_SOFTWARE, "no memory");
    h5_start();
    s->file = s->disk = -1;
    s->name = path ? path : "standard output";
    s->fd = path ? open(path, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666) : STDOUT_FILENO;
    if (s->fd < 0) return io_trouble(s, why, strerror(errno));
    if (isatty(s->fd))
        return why_set(why, EX_USAGE,
                       "%s is a terminal: documents are binary, use > FILE or a pipe", s->name);
    struct stat st;
    bool own = !fstat(s->fd, &st) && S_ISREG(st.st_mode) && !st.st_size &&
               !(fcntl(s->fd, F_GETFL) & O_APPEND);
    char again[40];
    snprintf(again, sizeof again, "/proc/self/fd/%d", s->fd);
    if (own && kind == SINK_TRAJECTORY) s->disk = open(again, O_RDWR | O_CLOEXEC);
    s->growing = s->disk >= 0;
    return 0;
}

/* ---- datasets: one frame's own, or the frame's rows of a growing one ---- */

static hid_t series_create(hid_t file, const char *path, enum column_type type, int rank,
                           const hsize_t *shape, hsize_t chunk_rows, const char *units,
                           struct why *why)
{
    hsize_t empty[4] = { 0 }, most[4] = { H5S_UNLIMITED }, chunk[4] = { chunk_rows };
    for (int k = 1; k < rank; k++) {
        empty[k] = most[k] = shape[k];
        chunk[k] = shape[k] < 1 ? 1 : shape[k] > CHUNK_BODIES ? CHUNK_BODIES : shape[k];
    }
    char parent[80];
    snprintf(parent, sizeof parent, "%.*s", (int)(strrchr(path, '/') - path), path);
    if (h5_group(file, parent, why)) return -1;
    hid_t space = H5Screate_simple(rank, empty, most), plist = h5_dataset_plist();
    hid_t disk = H5Tcopy(column_native(type));
    H5Tset_order(disk, H5T_ORDER_LE);
    H5Pset_chunk(plist, rank, chunk);
    hid_t set = H5Dcreate2(file, path, disk, space, H5P_DEFAULT, plist, H5P_DEFAULT);
    H5Tclose(disk), H5Pclose(plist), H5Sclose(space);
    if (set < 0) return why_set(why, EX_IOERR, "%s: cannot be made", path), -1;
    if (!units || !h5_attr_text(file, path, "units", units, why)) return set;
    H5Dclose(set);
    return -1;
}

static hid_t series_find(struct sink *s, const char *path)
{
    for (int i = 0; i < s->open; i++)
        if (!strcmp(s->series[i].path, path)) return s->series[i].set;
    return -1;
}

static int series_append(hid_t set, enum column_type type, int rank, const hsize_t *shape,
                         const void *data)
{
    hsize_t size[4], start[4] = { 0 };
    hid_t space = H5Dget_space(set);
    H5Sget_simple_extent_dims(space, size, NULL);
    H5Sclose(space);
    start[0] = size[0];
    size[0] += shape[0];
    if (H5Dset_extent(set, size) < 0) return -1;
    hid_t disk = H5Dget_space(set), memory = H5Screate_simple(rank, shape, NULL);
    H5Sselect_hyperslab(disk, H5S_SELECT_SET, start, NULL, shape, NULL);
    bool some = H5Sget_simple_extent_npoints(memory) > 0;
    herr_t e = some ? H5Dwrite(set, column_native(type), memory, disk, H5P_DEFAULT, data) : 0;
    H5Sclose(memory), H5Sclose(disk);
    return e < 0 ? -1 : 0;
}

/* shape[0] rows of data: a dataset of their own, or at the end of what grows. */
static int put(struct sink *s, hid_t file, const char *path, enum column_type type, int rank,
               const hsize_t *shape, hsize_t chunk_rows, const void *data, const char *units,
               struct why *why)
{
    if (!s->growing)
        return h5_write(file, path, column_native(type), rank, shape, data, units, why);
    hid_t set = series_find(s, path);
    if (set < 0) {
        if (s->open == SERIES) return why_set(why, EX_SOFTWARE, "%s: too many datasets", path);
        set = series_create(file, path, type, rank, shape, chunk_rows, units, why);
        if (set < 0) return why->status;
        struct series *new = &s->series[s->open++];
        snprintf(new->path, sizeof new->path, "%s", path);
        new->set = set;
    }
    return series_append(set, type, rank, shape, data) ? io_trouble(s, why, "cannot be written")
                                                       : 0;
}

static const void *pointer_in(const void *base, size_t offset)
{
    const void *p;
    memcpy(&p, (const char *)base + offset, sizeof p);
    return p;
}

/* All of a table's columns out of n structs, `tail` behind their names, at `where`. */
static int put_columns(struct sink *s, hid_t file, const char *where, const char *tail,
                       const struct column *c, bool solved, int64_t n, const void *structs,
                       size_t stride, hsize_t chunk_rows, struct why *why)
{
    for (; c->name; c++) {
        if (c->solved && !solved) continue;
        char path[80];
        snprintf(path, sizeof path, "%s/%s%s", where, c->name, tail);
        void *data = malloc((size_t)(n + 1) * (size_t)c->width * column_size(c->type));
        if (!data) return why_set(why, EX_SOFTWARE, "no memory for %s", path);
        column_gather(c, n, structs, stride, data);
        hsize_t shape[3] = { (hsize_t)n, c->width == 9 ? 3 : (hsize_t)c->width, 3 };
        int rank = c->width == 1 ? 1 : c->width == 9 ? 3 : 2;
        int e = put(s, file, path, c->type, rank, shape, chunk_rows, data, c->units, why);
        free(data);
        if (e) return e;
    }
    return 0;
}

/* WHERE/step and WHERE/time; and the same two under every element of the table, by hard links. */
static int put_clock(struct sink *s, hid_t file, const char *where, int64_t step, double t,
                     struct why *why)
{
    const hsize_t one = 1;
    char path[80];
    snprintf(path, sizeof path, "%s/step", where);
    if (put(s, file, path, COLUMN_I64, 1, &one, CHUNK_FRAMES, &step, NULL, why)) return why->status;
    snprintf(path, sizeof path, "%s/time", where);
    return put(s, file, path, COLUMN_F64, 1, &one, CHUNK_FRAMES, &t, "s", why);
}

static int link_clock(hid_t file, const char *from, const char *where, const struct column *c,
                      struct why *why)
{
    for (; c->name; c++)
        for (int k = 0; k < 2; k++) {
            char old[80], new[80];
            snprintf(old, sizeof old, "%s/%s", from, k ? "time" : "step");
            snprintf(new, sizeof new, "%s/%s/%s", where, c->name, k ? "time" : "step");
            if (h5_has(file, new)) continue;
            if (H5Lcreate_hard(file, old, file, new, H5P_DEFAULT, H5P_DEFAULT) < 0)
                return why_set(why, EX_IOERR, "%s: cannot be linked", new);
        }
    return 0;
}

/* ---- what does not change from frame to frame ---- */

static int put_nsd(hid_t file, const struct frame *f, struct why *why)
{
    const struct packing *p = &f->packing;
    const int h5md[2] = { 1, 1 };
    int version = DOCUMENT_VERSION;
    if (h5_group(file, "/h5md/author", why) || h5_group(file, "/h5md/creator", why) ||
        h5_attr(file, "/h5md", "version", H5T_NATIVE_INT, 2, h5md, why) ||
        h5_attr_text(file, "/h5md/author", "name", "", why) ||
        h5_attr_text(file, "/h5md/creator", "name", "nsd", why) ||
        h5_attr_text(file, "/h5md/creator", "version", NSD_VERSION, why) ||
        h5_group(file, "/nsd", why) ||
        h5_attr(file, "/nsd", "version", H5T_NATIVE_INT, -1, &version, why) ||
        h5_attr_text(file, "/nsd", "kind", f->foreign ? "problem" : "packing", why) ||
        h5_write_text(file, "/nsd/history", f->history ? f->history : "", why))
        return why->status;
    if (f->foreign) return 0;
    const double g[3] = { p->g.x, p->g.y, p->g.z };
    int64_t seed = (int64_t)p->seed;
    if (h5_attr(file, "/nsd", "dim", H5T_NATIVE_INT, -1, &p->dim, why) ||
        h5_attr(file, "/nsd", "dt", H5T_NATIVE_DOUBLE, -1, &p->dt, why) ||
        h5_attr(file, "/nsd", "theta", H5T_NATIVE_DOUBLE, -1, &p->theta, why) ||
        h5_attr(file, "/nsd", "gravity", H5T_NATIVE_DOUBLE, 3, g, why) ||
        h5_attr(file, "/nsd", "seed", H5T_NATIVE_INT64, -1, &seed, why))
        return why->status;
    return p->scene ? h5_write_text(file, "/nsd/scene", p->scene, why) : 0;
}

static int put_material(hid_t file, const struct packing *p, struct why *why)
{
    const hsize_t square[2] = { (hsize_t)p->kinds, (hsize_t)p->kinds };
    for (const struct column *c = layout_material; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/nsd/material/%s", c->name);
        if (h5_write(file, path, H5T_NATIVE_DOUBLE, 2, square, pointer_in(p, c->offset), c->units,
                     why))
            return why->status;
    }
    size_t length = 1;
    for (int32_t k = 0; k < p->kinds; k++) length += strlen(p->kind_name[k]) + 1;
    char *names = calloc(length, 1);
    if (!names) return why_set(why, EX_SOFTWARE, "no memory for the kinds");
    for (int32_t k = 0; k < p->kinds; k++) strcat(strcat(names, p->kind_name[k]), "\n");
    int e = h5_attr_text(file, "/nsd/material", "kinds", names, why);
    free(names);
    return e;
}

/* H5MD's box: nothing is periodic, so it has no edges. */
static int put_box(hid_t file, struct why *why)
{
    const int dimension = 3; // positions have three components in the plane too
    const char none[3][5] = { "none", "none", "none" };
    const char *box = "/particles/all/box";
    if (h5_group(file, box, why) ||
        h5_attr(file, box, "dimension", H5T_NATIVE_INT, -1, &dimension, why))
        return why->status;
    hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, sizeof none[0]);
    int e = h5_attr(file, box, "boundary", text, 3, none, why);
    H5Tclose(text);
    return e;
}

static int put_bodies(struct sink *s, hid_t file, const struct packing *p, struct why *why)
{
    const hsize_t n = (hsize_t)p->n;
    for (const struct column *c = layout_bodies; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s", c->name);
        if (h5_write(file, path, column_native(c->type), 1, &n, pointer_in(p, c->offset), c->units,
                     why))
            return why->status;
    }
    bool growing = s->growing;
    s->growing = false; // walls are the same in every frame
    int e = put_columns(s, file, "/walls/plane", "", layout_walls, false, p->walls, p->wall,
                        sizeof *p->wall, 0, why);
    s->growing = growing;
    return e;
}

/* ---- what we do not know is copied ---- */

struct copy {
    hid_t to;
    const char *group, *const *known;
    bool whole; /* the origin holds one frame: what depends on time may come along */
    struct why *why;
};

static herr_t copy_link(hid_t from, const char *name, const H5L_info_t *info, void *data)
{
    struct copy *c = data;
    char path[400];
    (void)info;
    for (const char *const *k = c->known; *k; k++)
        if (!strcmp(*k, name)) return 0;
    snprintf(path, sizeof path, "%s/%s", name, "step");
    if (!c->whole && h5_has(from, path)) return 0;
    snprintf(path, sizeof path, "%s%s%s", c->group, c->group[1] ? "/" : "", name);
    if (h5_has(c->to, path)) return 0;
    hid_t link = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(link, 1);
    herr_t e = H5Ocopy(from, name, c->to, path, H5P_DEFAULT, link);
    H5Pclose(link);
    return e < 0 ? why_set(c->why, EX_DATAERR, "%s: cannot be copied", path), -1 : 0;
}

static int copy_unknown(hid_t file, const struct frame *f, struct why *why)
{
    static const char *const root[] = { "h5md",     "nsd",         "particles", "walls",
                                        "contacts", "observables", "solution",  NULL };
    static const char *const exported[] = { "h5md",     "nsd",         "particles",
                                            "walls",    "contacts",    "observables",
                                            "solution", "fclib_local", "fclib_global",
                                            NULL };
    static const char *const all[] = { "box",         "position", "velocity", "angular_velocity",
                                       "orientation", "radius",   "mass",     "inertia",
                                       "id",          "species",  NULL };
    static const char *const particles[] = { "all", NULL }, *const walls[] = { "plane", NULL };
    static const char *const observables[] = { "solver", NULL };
    static const char *const nsd[] = { "history", "scene", "material", NULL };
    const struct {
        const char *group;
        const char *const *known;
    } where[] = { { "/", f->stale ? exported : root }, { "/particles", particles },
                  { "/particles/all", all },           { "/walls", walls },
                  { "/observables", observables },     { "/nsd", nsd } };
    hsize_t shape[4] = { 1 };
    if (!f->origin) return 0;
    h5_shape(f->origin, "/particles/all/position/step", shape);
    for (size_t i = 0; i < sizeof where / sizeof where[0]; i++) {
        if (!h5_has(f->origin, where[i].group)) continue;
        struct copy c = { file, where[i].group, where[i].known, shape[0] <= 1, why };
        // the problem itself is what a foreign document is
        if (f->foreign && i == 0) c.known = root;
        hid_t group = H5Gopen2(f->origin, where[i].group, H5P_DEFAULT);
        H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, NULL, copy_link, &c);
        H5Gclose(group);
        if (why->status) return why->status;
    }
    return 0;
}

/* ---- a frame ---- */

static int put_motion(struct sink *s, hid_t file, const struct packing *p, struct why *why)
{
    for (const struct column *c = layout_motion; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s/value", c->name);
        const hsize_t shape[3] = { 1, (hsize_t)p->n, (hsize_t)c->width };
        if (put(s, file, path, c->type, 3, shape, 1, pointer_in(p, c->offset), c->units, why))
            return why->status;
    }
    return 0;
}

static int put_contacts(struct sink *s, hid_t file, const struct frame *f, struct why *why)
{
    const hsize_t one = 1;
    const struct contacts *t = &f->contacts;
    if (put(s, file, "/contacts/start", COLUMN_I64, 1, &one, CHUNK_FRAMES, &s->rows, NULL, why) ||
        put(s, file, "/contacts/count", COLUMN_I64, 1, &one, CHUNK_FRAMES, &t->n, NULL, why) ||
        put_columns(s, file, "/contacts", "", layout_contacts, t->solved, t->n, t->c, sizeof *t->c,
                    CHUNK_CONTACTS, why))
        return why->status;
    if (s->growing) s->rows += t->n;
    int moved = f->moved;
    return h5_attr(file, "/contacts", "moved", H5T_NATIVE_INT, -1, &moved, why);
}

static const char *const criteria[] = { "glob", "scaled", "natural" };

static int put_report(struct sink *s, hid_t file, const struct report *rep, struct why *why)
{
    const char *solver = "/observables/solver";
    bool first = !h5_has(file, solver);
    if (put_columns(s, file, solver, "/value", layout_report, true, 1, rep, sizeof *rep,
                    CHUNK_FRAMES, why))
        return why->status;
    if (first && (h5_attr_text(file, solver, "method", rep->method, why) ||
                  h5_attr_text(file, solver, "criterion", criteria[rep->criterion], why) ||
                  h5_attr(file, solver, "eps", H5T_NATIVE_DOUBLE, -1, &rep->eps, why) ||
                  h5_attr_text(file, solver, "options", rep->options ? rep->options : "{}", why)))
        return why->status;
    if (!rep->history || s->growing) return 0;
    const hsize_t shape[2] = { (hsize_t)rep->sweeps, 5 };
    return h5_write(file, "/observables/solver/history", H5T_NATIVE_DOUBLE, 2, shape, rep->history,
                    "1", why);
}

/* The clocks of all that the frame has: last, for it is they that make a frame count. */
static int put_clocks(struct sink *s, hid_t file, const struct frame *f, struct why *why)
{
    const hsize_t one = 1;
    const struct packing *p = &f->packing;
    const char *position = "/particles/all/position", *solver = "/observables/solver";
    if (f->packed && f->detected &&
        put(s, file, "/contacts/step", COLUMN_I64, 1, &one, CHUNK_FRAMES, &p->step, NULL, why))
        return why->status;
    if (f->reported && (put_clock(s, file, solver, f->report.step, f->report.t, why) ||
                        link_clock(file, solver, solver, layout_report, why)))
        return why->status;
    if (!f->packed) return 0;
    return put_clock(s, file, position, p->step, p->t, why) ||
                   link_clock(file, position, "/particles/all", layout_motion, why)
               ? why->status
               : 0;
}

static int put_static(struct sink *s, hid_t file, const struct frame *f, struct why *why)
{
    if (put_nsd(file, f, why)) return why->status;
    if (f->packed && (put_material(file, &f->packing, why) || put_box(file, why) ||
                      put_bodies(s, file, &f->packing, why)))
        return why->status;
    return copy_unknown(file, f, why);
}

static int put_moment(struct sink *s, hid_t file, const struct frame *f, struct why *why)
{
    if (f->packed && put_motion(s, file, &f->packing, why)) return why->status;
    if (f->packed && f->detected && put_contacts(s, file, f, why)) return why->status;
    return f->reported ? put_report(s, file, &f->report, why) : 0;
}

static hid_t create(const char *path, hid_t access)
{
    hid_t plist = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_userblock(plist, DOCUMENT_USERBLOCK);
    H5Pset_obj_track_times(plist, false);
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, plist, access);
    H5Pclose(plist);
    return file;
}

/* ---- a stream ---- */

/* All of it, or a regular file without it: what is half written is taken back. */
static int write_all(struct sink *s, const unsigned char *bytes, size_t size, struct why *why)
{
    off_t start = lseek(s->fd, 0, SEEK_CUR);
    for (size_t done = 0; done < size;) {
        ssize_t n = write(s->fd, bytes + done, size - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            io_trouble(s, why, strerror(errno));
            if (start < 0 || ftruncate(s->fd, start)) return why->status;
            return why->status;
        }
        done += (size_t)n;
    }
    return 0;
}

/* The memory of a flushed document of the core driver gets its header and goes out as it is. */
static int write_image(struct sink *s, hid_t file, struct why *why)
{
    void **memory;
    bool flushed = H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0;
    ssize_t image = flushed ? H5Fget_file_image(file, NULL, 0) : -1; // what HDF5 uses of the memory
    if (image < 0 || H5Fget_vfd_handle(file, H5P_DEFAULT, (void **)&memory) < 0)
        return why_set(why, EX_SOFTWARE, "no memory for the document");
    size_t size = (size_t)image + DOCUMENT_USERBLOCK; // which it leaves out
    unsigned char *bytes = *memory;
    uint32_t crc = document_crc(0, bytes + DOCUMENT_USERBLOCK, size - DOCUMENT_USERBLOCK);
    document_header(bytes, size, crc);
    return write_all(s, bytes, size, why);
}

static int stream_frame(struct sink *s, const struct frame *f, struct why *why)
{
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    size_t step = (size_t)f->packing.n * 32;
    H5Pset_fapl_core(access, step < 1 << 16 ? 1 << 16 : step, false);
    hid_t file = create("document", access);
    H5Pclose(access);
    if (file < 0) return why_set(why, EX_SOFTWARE, "no memory for the document");
    int e = put_static(s, file, f, why) || put_moment(s, file, f, why) ||
            put_clocks(s, file, f, why) ||
            (f->export && fclib_write_problem(f->export, f->export_global, file, why)) ||
            (f->foreign && f->u &&
             fclib_store_solution(&f->problem, file, f->u, f->problem.W.r, why)) ||
            write_image(s, file, why);
    H5Fclose(file);
    return e ? why->status : 0;
}

/* ---- a trajectory ---- */

static int write_header(struct sink *s, uint64_t length, uint32_t crc, struct why *why)
{
    unsigned char header[DOCUMENT_USERBLOCK];
    document_header(header, length, crc);
    bool good = pwrite(s->disk, header, sizeof header, 0) == (ssize_t)sizeof header;
    return good ? 0 : io_trouble(s, why, strerror(errno));
}

static int flush(struct sink *s, struct why *why)
{
    return H5Fflush(s->file, H5F_SCOPE_GLOBAL) < 0 ? io_trouble(s, why, "cannot be written (full?)")
                                                   : 0;
}

/* What only the first frame says must hold of all. */
static int check_same(const struct sink *s, const struct frame *f, struct why *why)
{
    const struct packing *p = &s->first, *q = &f->packing;
    size_t n = (size_t)q->n;
    if (p->n != q->n)
        return why_set(why, EX_DATAERR, "%lld bodies, and the trajectory has %lld", (long long)q->n,
                       (long long)p->n);
    if (p->dim != q->dim || p->dt != q->dt || p->theta != q->theta)
        return why_set(why, EX_DATAERR, "dim, dt or theta differ from the trajectory's");
    if (memcmp(p->radius, q->radius, n * sizeof *p->radius) ||
        memcmp(p->mass, q->mass, n * sizeof *p->mass))
        return why_set(why, EX_DATAERR, "other bodies than the trajectory's");
    if (q->step <= s->step)
        return why_set(why, EX_DATAERR, "step %lld after step %lld: a trajectory's steps increase",
                       (long long)q->step, (long long)s->step);
    if (f->detected && s->contacts && f->contacts.solved != s->solved)
        return why_set(why, EX_DATAERR, "contacts solved and unsolved in one trajectory");
    return 0;
}

static int trajectory_begin(struct sink *s, const struct frame *f, struct why *why)
{
    char path[40];
    snprintf(path, sizeof path, "/proc/self/fd/%d", s->disk);
    s->file = create(path, H5P_DEFAULT);
    if (s->file < 0) return io_trouble(s, why, "cannot be written");
    if (packing_copy(&s->first, &f->packing, why)) return why->status;
    s->step = f->packing.step - 1;
    return write_header(s, 0, 0, why) || put_static(s, s->file, f, why) ? why->status : 0;
}

static int trajectory_frame(struct sink *s, const struct frame *f, struct why *why)
{
    if (!f->packed)
        return why_set(why, EX_DATAERR, "an FCLIB problem does not go into a trajectory");
    if (s->file < 0 && trajectory_begin(s, f, why)) return why->status;
    if (check_same(s, f, why)) return why->status;
    // numbers first, on disk; then the clock that makes them a frame: a kill leaves whole frames
    if (put_moment(s, s->file, f, why) || flush(s, why) || put_clocks(s, s->file, f, why) ||
        flush(s, why))
        return why->status;
    s->step = f->packing.step;
    if (f->detected) s->contacts = true, s->solved = f->contacts.solved;
    return 0;
}

static int trajectory_close(struct sink *s, struct why *why)
{
    herr_t e = 0;
    for (int i = 0; i < s->open; i++) e |= H5Dclose(s->series[i].set);
    if (H5Fclose(s->file) < 0 || e < 0) return io_trouble(s, why, "cannot be written (full?)");
    static unsigned char buffer[1 << 18];
    uint32_t crc = 0;
    off_t at = DOCUMENT_USERBLOCK;
    ssize_t n;
    while ((n = pread(s->disk, buffer, sizeof buffer, at)) > 0) {
        crc = document_crc(crc, buffer, (size_t)n);
        at += n;
    }
    if (n < 0) return io_trouble(s, why, strerror(errno));
    if (write_header(s, (uint64_t)at, crc, why)) return why->status;
    lseek(s->fd, at, SEEK_SET); // who writes there next, writes behind us
    return 0;
}

int sink_frame(struct sink *s, const struct frame *f, struct why *why)
{
    if (!f->packed && s->file < 0) s->growing = false; // a problem is a document by itself
    return s->growing ? trajectory_frame(s, f, why) : stream_frame(s, f, why);
}

int sink_close(struct sink *s, struct why *why)
{
    int e = s->file >= 0 ? trajectory_close(s, why) : 0;
    if (s->disk >= 0) close(s->disk);
    packing_free(&s->first);
    if (close(s->fd) && !e) e = io_trouble(s, why, strerror(errno));
    free(s);
    return e;
}
