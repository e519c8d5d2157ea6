#include "doc.h"

#include "copy.h"
#include "h5.h"
#include "layout.h"
#include "stream.h"

#include <hdf5_hl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct reader {
    struct stream *stream;
    int files;
    char *const *file;
    hid_t doc;       /* -1: none open */
    bool unchecked;  /* no checksum vouches for it */
    int64_t frames;  /* of it */
    int64_t next;    /* frame of reader_next */
    int64_t *step;   /* [frames] of a packing's document, */
    double *time;    /* [frames] */
    int64_t *solved; /* [solves] steps that /observables/solver tells of */
    int64_t solves;
    char where[300];
};

int reader_open(struct reader **out, int files, char *const *file, struct why *why)
{
    struct reader *r = *out = calloc(1, sizeof *r);
    if (!r) return why_set(why, EX_SOFTWARE, "no memory");
    h5_start();
    r->files = files, r->file = file, r->doc = -1;
    return stream_open(&r->stream, files, file, why);
}

static void doc_close(struct reader *r)
{
    if (r->doc >= 0) H5Fclose(r->doc);
    free(r->step), free(r->time), free(r->solved);
    r->doc = -1, r->step = r->solved = NULL, r->time = NULL, r->frames = r->next = r->solves = 0;
}

void reader_close(struct reader *r)
{
    if (!r) return;
    doc_close(r);
    stream_close(r->stream);
    free(r);
}

const char *reader_where(const struct reader *r)
{
    return r->where;
}

bool reader_reads(int files, char *const *file, const char *path)
{
    struct stat out, in;
    if (stat(path, &out)) return false;
    for (int i = 0; i < (files ? files : 1); i++) {
        bool standard = !files || !strcmp(file[i], "-");
        int failed = standard ? fstat(STDIN_FILENO, &in) : stat(file[i], &in);
        if (!failed && in.st_dev == out.st_dev && in.st_ino == out.st_ino) return true;
    }
    return false;
}

/* The reason, with the document that it is about in front. */
static int blame(const struct reader *r, struct why *why)
{
    char text[sizeof why->text];
    memcpy(text, why->text, sizeof text);
    snprintf(why->text, sizeof why->text, "%.120s: %.270s", r->where, text);
    return why->status;
}

/* Steps and times of the frames; a frame counts when every element has it. */
static int count_frames(struct reader *r, struct why *why)
{
    hsize_t n, m, shape[4];
    if (!h5_has(r->doc, "/particles/all"))
        return why_set(why, EX_DATAERR, "holds neither particles nor an FCLIB problem");
    r->step = h5_read_all(r->doc, "/particles/all/position/step", H5T_NATIVE_INT64, &n, why);
    r->time = h5_read_all(r->doc, "/particles/all/position/time", H5T_NATIVE_DOUBLE, &m, why);
    if (!r->step || !r->time) return why->status;
    n = n < m ? n : m;
    for (const struct column *c = layout_motion; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s/value", c->name);
        if (h5_shape(r->doc, path, shape) != 3)
            return why_set(why, EX_DATAERR, "%s: no dataset of shape frames x bodies x %d", path,
                           c->width);
        n = n < shape[0] ? n : shape[0];
    }
    // a killed writer may have left room for a step that it had not yet set
    for (r->frames = n > 0; r->frames < (int64_t)n; r->frames++)
        if (r->step[r->frames] <= r->step[r->frames - 1]) break;
    if (!h5_has(r->doc, "/observables/solver/step")) return 0;
    r->solved = h5_read_all(r->doc, "/observables/solver/step", H5T_NATIVE_INT64, &n, why);
    r->solves = (int64_t)n;
    return r->solved ? 0 : why->status;
}

int reader_document(struct reader *r, int64_t *frames, struct why *why)
{
    struct image im;
    doc_close(r);
    *frames = -1;
    if (stream_next(r->stream, &im, why)) return why->status;
    if (!im.bytes) return 0;
    snprintf(r->where, sizeof r->where, im.number > 1 ? "%s: document %lld" : "%s", im.name,
             (long long)im.number);
    r->doc = H5LTopen_file_image(im.bytes, im.size,
                                 H5LT_FILE_IMAGE_DONT_COPY | H5LT_FILE_IMAGE_DONT_RELEASE);
    r->unchecked = im.foreign || im.unfinished;
    if (r->doc < 0) {
        why_set(why, EX_DATAERR, "not a readable HDF5 file (truncated or damaged)");
        return blame(r, why);
    }
    if (fclib_in(r->doc) && !h5_has(r->doc, "/particles/all"))
        r->frames = 1;
    else if (count_frames(r, why))
        return blame(r, why);
    *frames = r->frames;
    return 0;
}

static void *pointer_in(const void *base, size_t offset)
{
    void *p;
    memcpy(&p, (const char *)base + offset, sizeof p);
    return p;
}

/* Rows start .. start+n-1 of a dataset whose rows, of any further shape, are `width` numbers. */
static int read_rows(hid_t doc, const char *path, hid_t type, int64_t start, int64_t n,
                     int64_t width, void *out, struct why *why)
{
    hsize_t shape[4] = { 0 }, first[4] = { (hsize_t)start }, count[4] = { (hsize_t)n };
    int rank = h5_shape(doc, path, shape);
    hsize_t row = 1;
    for (int k = 1; k < rank; k++) row *= count[k] = shape[k];
    if (rank < 1 || shape[0] < (hsize_t)(start + n) || row != (hsize_t)width)
        return why_set(why, EX_DATAERR, "%s: not of %lld rows of %lld numbers", path,
                       (long long)(start + n), (long long)width);
    if (!n || !width) return 0;
    hid_t set = H5Dopen2(doc, path, H5P_DEFAULT), space = H5Dget_space(set);
    hid_t memory = H5Screate_simple(rank, count, NULL);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, first, NULL, count, NULL);
    herr_t e = H5Dread(set, type, memory, space, H5P_DEFAULT, out);
    H5Sclose(memory), H5Sclose(space), H5Dclose(set);
    return e < 0 ? why_set(why, EX_DATAERR, "%s: cannot be read as numbers", path) : 0;
}

static int read_material(hid_t doc, struct packing *p, struct why *why)
{
    char *names = h5_read_text(doc, "/nsd/material@kinds");
    int32_t kinds = 0;
    for (const char *c = names; c && *c; c++) kinds += *c == '\n';
    if (!kinds) {
        free(names);
        return why_set(why, EX_DATAERR, "/nsd/material@kinds: no kinds of material");
    }
    int e = packing_kinds(p, kinds, why);
    char *name = names;
    for (int32_t k = 0; !e && k < kinds; k++) {
        char *end = strchr(name, '\n');
        free(p->kind_name[k]);
        p->kind_name[k] = strndup(name, (size_t)(end - name));
        if (!p->kind_name[k]) e = why_set(why, EX_SOFTWARE, "no memory for the kinds");
        name = end + 1;
    }
    for (const struct column *c = layout_material; !e && c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/nsd/material/%s", c->name);
        e = h5_read(doc, path, H5T_NATIVE_DOUBLE, (hsize_t)kinds * (hsize_t)kinds,
                    pointer_in(p, c->offset), why);
    }
    free(names);
    return e;
}

/* Rows start .. start+n-1 of the columns of `where` (and `tail` behind their names) into structs. */
static int read_columns(hid_t doc, const char *where, const char *tail, const struct column *c,
                        bool solved, int64_t start, int64_t n, void *structs, size_t stride,
                        struct why *why)
{
    for (; c->name; c++) {
        if (c->solved && !solved) continue;
        char path[120];
        snprintf(path, sizeof path, "%s/%s%s", where, c->name, tail);
        char *data = calloc((size_t)n + 1, (size_t)c->width * column_size(c->type));
        if (!data) return why_set(why, EX_SOFTWARE, "%s: no memory", path);
        int e = read_rows(doc, path, column_native(c->type), start, n, c->width, data, why);
        if (!e) column_scatter(c, n, data, structs, stride);
        free(data);
        if (e) return e;
    }
    return 0;
}

static int read_walls(hid_t doc, struct packing *p, struct why *why)
{
    hsize_t shape[4];
    if (!h5_has(doc, "/walls/plane")) return 0;
    if (h5_shape(doc, "/walls/plane/point", shape) != 2 || shape[0] > 1 << 24)
        return why_set(why, EX_DATAERR, "/walls/plane/point: not of shape walls x 3");
    if (packing_walls(p, (int32_t)shape[0], why)) return why->status;
    return read_columns(doc, "/walls/plane", "", layout_walls, false, 0, p->walls, p->wall,
                        sizeof *p->wall, why);
}

static int read_parameters(hid_t doc, struct packing *p, struct why *why)
{
    double g[3];
    int64_t seed;
    if (h5_attr_read(doc, "/nsd", "dt", H5T_NATIVE_DOUBLE, -1, &p->dt, why) ||
        h5_attr_read(doc, "/nsd", "theta", H5T_NATIVE_DOUBLE, -1, &p->theta, why) ||
        h5_attr_read(doc, "/nsd", "gravity", H5T_NATIVE_DOUBLE, 3, g, why) ||
        h5_attr_read(doc, "/nsd", "seed", H5T_NATIVE_INT64, -1, &seed, why))
        return why->status;
    p->g = v3(g[0], g[1], g[2]);
    p->seed = (uint64_t)seed;
    p->scene = h5_read_text(doc, "/nsd/scene");
    return 0;
}

static int read_packing(struct reader *r, int64_t k, struct packing *p, struct why *why)
{
    hsize_t shape[4];
    int dim;
    if (h5_shape(r->doc, "/particles/all/radius", shape) != 1 || shape[0] > INT32_MAX)
        return why_set(why, EX_DATAERR, "/particles/all/radius: not a list of numbers");
    int64_t n = (int64_t)shape[0];
    if (h5_attr_read(r->doc, "/nsd", "dim", H5T_NATIVE_INT, -1, &dim, why)) return why->status;
    // nothing is allocated for bodies whose positions are not there
    if (h5_shape(r->doc, "/particles/all/position/value", shape) != 3 || (int64_t)shape[1] != n)
        return why_set(why, EX_DATAERR,
                       "/particles/all/position/value: not of shape frames x %lld x 3",
                       (long long)n);
    if (packing_init(p, dim, n, why)) return why->status;
    if (read_parameters(r->doc, p, why) || read_material(r->doc, p, why) ||
        read_walls(r->doc, p, why))
        return why->status;
    for (const struct column *c = layout_bodies; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s", c->name);
        if (read_rows(r->doc, path, column_native(c->type), 0, n, c->width,
                      pointer_in(p, c->offset), why))
            return why->status;
    }
    for (const struct column *c = layout_motion; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s/value", c->name);
        if (read_rows(r->doc, path, H5T_NATIVE_DOUBLE, k, 1, n * c->width, pointer_in(p, c->offset),
                      why))
            return why->status;
    }
    p->step = r->step[k], p->t = r->time[k];
    return packing_check(p, why);
}

static const char *contact_trouble(const struct packing *p, const struct contact *c)
{
    if (c->b < 0 || c->b >= p->n || c->a >= p->n || c->a < -p->walls || c->a == c->b)
        return "no such bodies";
    if (!v3_finite(c->x) || !isfinite(c->gap)) return "point or gap is not finite";
    if (!(fabs(v3_dot(c->n, c->n) - 1) < 1e-6 && fabs(v3_dot(c->t1, c->t1) - 1) < 1e-6 &&
          fabs(v3_dot(c->t2, c->t2) - 1) < 1e-6 && fabs(v3_dot(c->n, c->t1)) < 1e-6 &&
          fabs(v3_dot(c->n, c->t2)) < 1e-6 && fabs(v3_dot(c->t1, c->t2)) < 1e-6))
        return "frame is not orthonormal";
    if (v3_dot(v3_cross(c->n, c->t1), c->t2) < 0) return "frame is not right-handed";
    if (!(c->mu >= 0 && isfinite(c->mu))) return "mu must not be negative";
    if (!(c->en >= 0 && c->en <= 1 && c->et >= 0 && c->et <= 1))
        return "restitution must lie in [0, 1]";
    for (int k = 0; k < 3; k++)
        if (!isfinite(c->r[k]) || !isfinite(c->u[k])) return "reaction or velocity is not finite";
    return NULL;
}

/* The contacts of the frame's step, when the document has them. */
static int read_contacts(struct reader *r, int64_t k, struct frame *f, struct why *why)
{
    if (!h5_has(r->doc, "/contacts")) return 0;
    hsize_t n, m, l;
    struct contacts *s = &f->contacts;
    int64_t *step = h5_read_all(r->doc, "/contacts/step", H5T_NATIVE_INT64, &n, why);
    int64_t *start = h5_read_all(r->doc, "/contacts/start", H5T_NATIVE_INT64, &m, why);
    int64_t *count = h5_read_all(r->doc, "/contacts/count", H5T_NATIVE_INT64, &l, why);
    bool here = false;
    int64_t first = 0;
    n = n < m ? n : m; // a killed writer may have got no further than some of them
    n = n < l ? n : l;
    for (hsize_t i = 0; !why->status && i < n; i++) {
        if (step[i] != r->step[k]) continue;
        if (start[i] < 0 || count[i] < 0 || start[i] > INT32_MAX || count[i] > INT32_MAX)
            why_set(why, EX_DATAERR, "/contacts: start or count is out of range");
        here = true, first = start[i], s->n = count[i];
    }
    free(step), free(start), free(count);
    if (why->status) return why->status;
    if (!here) return 0;
    hsize_t shape[4];
    if (h5_shape(r->doc, "/contacts/body", shape) != 2 || (hsize_t)(first + s->n) > shape[0])
        return why_set(why, EX_DATAERR,
                       "/contacts/body: fewer than the %lld contacts of its frames",
                       (long long)(first + s->n));
    s->room = s->n ? s->n : 1;
    s->c = calloc((size_t)s->room, sizeof *s->c);
    if (!s->c) return why_set(why, EX_SOFTWARE, "no memory for the contacts");
    s->solved = h5_has(r->doc, "/contacts/reaction");
    if (read_columns(r->doc, "/contacts", "", layout_contacts, s->solved, first, s->n, s->c,
                     sizeof *s->c, why))
        return why->status;
    for (int64_t i = 0; i < s->n; i++) {
        const char *trouble = contact_trouble(&f->packing, &s->c[i]);
        if (trouble) return why_set(why, EX_DATAERR, "contact %lld: %s", (long long)i, trouble);
    }
    int moved;
    if (h5_attr_read(r->doc, "/contacts", "moved", H5T_NATIVE_INT, -1, &moved, why))
        return why->status;
    f->moved = moved;
    f->detected = true;
    return 0;
}

static int criterion_of(const char *name)
{
    return name && !strcmp(name, "scaled")    ? CRITERION_SCALED
           : name && !strcmp(name, "natural") ? CRITERION_NATURAL
                                              : CRITERION_GLOB;
}

static int read_history(hid_t doc, struct report *rep, struct why *why)
{
    hsize_t n;
    if (!h5_has(doc, "/observables/solver/history")) return 0;
    double *h = h5_read_all(doc, "/observables/solver/history", H5T_NATIVE_DOUBLE, &n, why);
    if (!h) return why->status;
    rep->history = (struct terms *)h;
    return n == 5 * (hsize_t)rep->sweeps
               ? 0
               : why_set(why, EX_DATAERR, "/observables/solver/history: not of shape %d x 5",
                         rep->sweeps);
}

/* What the solve that led to this step says, or of a document of one moment, its only one. */
static int read_report(struct reader *r, int64_t step, struct frame *f, struct why *why)
{
    int64_t at = r->frames == 1 && r->solves == 1 ? 0 : -1;
    for (int64_t i = 0; i < r->solves; i++)
        if (r->solved[i] == step) at = i;
    if (at < 0) return 0;
    struct report *rep = &f->report;
    const char *solver = "/observables/solver";
    if (read_columns(r->doc, solver, "/value", layout_report, true, at, 1, rep, sizeof *rep, why))
        return why->status;
    rep->step = r->solved[at];
    if (read_rows(r->doc, "/observables/solver/time", H5T_NATIVE_DOUBLE, at, 1, 1, &rep->t, why))
        return why->status;
    char *method = h5_read_text(r->doc, "/observables/solver@method");
    char *criterion = h5_read_text(r->doc, "/observables/solver@criterion");
    rep->options = h5_read_text(r->doc, "/observables/solver@options");
    snprintf(rep->method, sizeof rep->method, "%s", method ? method : "");
    rep->criterion = criterion_of(criterion);
    free(method), free(criterion);
    if (h5_attr_read(r->doc, solver, "eps", H5T_NATIVE_DOUBLE, -1, &rep->eps, why) ||
        read_history(r->doc, rep, why))
        return why->status;
    f->reported = true;
    return 0;
}

static int read_foreign(struct reader *r, struct frame *f, struct why *why)
{
    if (fclib_read(&f->problem, r->doc, why)) return why->status;
    f->foreign = true;
    struct delassus *W = &f->problem.W;
    if (fclib_load_solution(&f->problem, r->doc, W->r, why)) return why->status;
    if (h5_has(r->doc, "/solution/u")) {
        hsize_t n = (hsize_t)(W->d * W->n);
        f->u = calloc(n + 1, sizeof *f->u);
        if (!f->u) return why_set(why, EX_SOFTWARE, "no memory for the solution");
        if (h5_read(r->doc, "/solution/u", H5T_NATIVE_DOUBLE, n, f->u, why)) return why->status;
    }
    hsize_t n;
    if (!h5_has(r->doc, "/observables/solver/step")) return 0;
    r->solved = h5_read_all(r->doc, "/observables/solver/step", H5T_NATIVE_INT64, &n, why);
    r->solves = (int64_t)n;
    return r->solved ? read_report(r, 0, f, why) : why->status;
}

int reader_frame(struct reader *r, int64_t k, struct frame *f, struct why *why)
{
    frame_free(f);
    f->origin = r->doc, f->unchecked = r->unchecked;
    f->history = h5_read_text(r->doc, "/nsd/history");
    if (!r->step) {
        if (read_foreign(r, f, why)) return blame(r, why);
        return 0;
    }
    if (read_packing(r, k, &f->packing, why)) return blame(r, why);
    f->packed = true;
    if (read_contacts(r, k, f, why) || read_report(r, r->step[k], f, why)) return blame(r, why);
    stream_rest(r->stream);
    return 0;
}

/* A document of one moment, all of which is in *f, is closed: a large one's memory is wanted. */
static void let_go(struct reader *r, struct frame *f)
{
    if (r->frames != 1 || !f->packed || copy_wanted(f)) return;
    f->origin = 0;
    doc_close(r);
    stream_drop(r->stream);
}

bool reader_has(const struct reader *r, int64_t k, const struct range *steps)
{
    return !r->step || range_has(steps, r->step[k]);
}

int reader_next(struct reader *r, const struct range *steps, struct frame *f, bool *more,
                struct why *why)
{
    for (;;) {
        while (steps && r->next < r->frames && !reader_has(r, r->next, steps)) r->next++;
        *more = r->next < r->frames;
        if (*more) break;
        int64_t frames;
        if (reader_document(r, &frames, why)) return why->status;
        if (frames >= 0) continue;
        frame_free(f);
        return 0;
    }
    if (reader_frame(r, r->next++, f, why)) return why->status;
    let_go(r, f);
    return 0;
}

int reader_last(struct reader *r, struct frame *f, bool *more, struct why *why)
{
    int64_t frames;
    hid_t held = -1; // the document of *f stays open, for what is copied from it
    *more = false;
    for (;;) {
        if (*more) held = r->doc, r->doc = -1;
        int e = reader_document(r, &frames, why);
        if (!e && frames < 0) {
            r->doc = held;
            return 0;
        }
        if (held >= 0) H5Fclose(held);
        held = -1;
        if (!e && frames > 0) e = reader_frame(r, frames - 1, f, why);
        if (e) return e;
        if (frames > 0) *more = true, let_go(r, f);
    }
}
