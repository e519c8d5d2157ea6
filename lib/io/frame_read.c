#include "io/frame_read.h"

#include "io/h5.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *steps_of(const struct frame_read *r, const char *path, int64_t *n, struct why *why)
{
    hsize_t count = 0;
    void *steps = h5_read_all(r->tables.file, path, H5T_NATIVE_INT64, &count, why);
    *n = (int64_t)count;
    return steps;
}

/* Steps and times of the frames. A frame counts when all of its motion is there. */
static int count_frames(struct frame_read *r, struct why *why)
{
    hsize_t m, shape[4];
    int64_t n;
    r->step = steps_of(r, "/particles/all/position/step", &n, why);
    r->time =
        h5_read_all(r->tables.file, "/particles/all/position/time", H5T_NATIVE_DOUBLE, &m, why);
    if (!r->step || !r->time) return why->status;
    n = n < (int64_t)m ? n : (int64_t)m;
    for (const struct column *c = layout_motion; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s/value", c->name);
        if (h5_shape(r->tables.file, path, shape) != 3)
            return why_set(why, EX_DATAERR, "%s: no dataset of shape frames x bodies x %d", path,
                           c->width);
        n = n < (int64_t)shape[0] ? n : (int64_t)shape[0];
    }
    // a killed writer may have made room for a step without setting it
    for (r->frames = n > 0; r->frames < n; r->frames++)
        if (r->step[r->frames] <= r->step[r->frames - 1]) break;
    return 0;
}

/* The frames whose contacts are kept. A killed writer may have extended only some columns. */
static int count_contacts(struct frame_read *r, struct why *why)
{
    int64_t n, m, l;
    r->contacts.step = steps_of(r, "/contacts/step", &n, why);
    r->contacts.start = steps_of(r, "/contacts/start", &m, why);
    r->contacts.count = steps_of(r, "/contacts/count", &l, why);
    n = n < m ? n : m;
    r->contacts.blocks = n < l ? n : l;
    return why->status;
}

int frame_read_open(struct frame_read *r, hid_t file, struct why *why)
{
    *r = (struct frame_read){ .tables.file = file, .frames = 1 };
    if (h5_has(file, "/particles/all")) {
        if (count_frames(r, why)) return why->status;
        if (h5_has(file, "/contacts") && count_contacts(r, why)) return why->status;
    } else if (!fclib_in(file)) {
        return why_set(why, EX_DATAERR, "holds neither particles nor an FCLIB problem");
    }
    if (!h5_has(file, "/observables/solver/step")) return 0;
    r->solved = steps_of(r, "/observables/solver/step", &r->solves, why);
    return why->status;
}

void frame_read_close(struct frame_read *r)
{
    table_read_close(&r->tables);
    if (r->tables.file >= 0) H5Fclose(r->tables.file);
    free(r->step), free(r->time), free(r->solved);
    free(r->contacts.step), free(r->contacts.start), free(r->contacts.count);
    *r = (struct frame_read){ .tables.file = -1 };
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
                    column_array(c, p), why);
    }
    free(names);
    return e;
}

static int read_walls(struct table_read *r, struct packing *p, struct why *why)
{
    hsize_t shape[4];
    if (!h5_has(r->file, "/walls/plane")) return 0;
    if (h5_shape(r->file, "/walls/plane/point", shape) != 2 || shape[0] > 1 << 24)
        return why_set(why, EX_DATAERR, "/walls/plane/point: not of shape walls x 3");
    if (packing_walls(p, (int32_t)shape[0], why)) return why->status;
    return table_read_columns(r, "/walls/plane", "", layout_walls, 0, p->walls, p->wall,
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

static int read_packing(struct frame_read *r, int64_t k, struct packing *p, struct why *why)
{
    hsize_t shape[4];
    int dim;
    if (h5_shape(r->tables.file, "/particles/all/radius", shape) != 1 || shape[0] > INT32_MAX)
        return why_set(why, EX_DATAERR, "/particles/all/radius: not a list of numbers");
    int64_t n = (int64_t)shape[0];
    if (h5_attr_read(r->tables.file, "/nsd", "dim", H5T_NATIVE_INT, -1, &dim, why))
        return why->status;
    // no memory is allocated for bodies without positions
    if (h5_shape(r->tables.file, "/particles/all/position/value", shape) != 3 ||
        (int64_t)shape[1] != n)
        return why_set(why, EX_DATAERR,
                       "/particles/all/position/value: not of shape frames x %lld x 3",
                       (long long)n);
    if (packing_init(p, dim, n, why)) return why->status;
    if (read_parameters(r->tables.file, p, why) || read_material(r->tables.file, p, why) ||
        read_walls(&r->tables, p, why))
        return why->status;
    for (const struct column *c = layout_bodies; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s", c->name);
        if (table_read_rows(&r->tables, path, c->type, 0, n, c->width, column_array(c, p), why))
            return why->status;
    }
    for (const struct column *c = layout_motion; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s/value", c->name);
        if (table_read_rows(&r->tables, path, c->type, k, 1, n * c->width, column_array(c, p), why))
            return why->status;
    }
    p->step = r->step[k], p->t = r->time[k];
    return packing_check(p, why);
}

/* The bases of the contacts from row `first` on; t2 has to be n x t1. */
static int read_bases(struct table_read *r, int64_t first, struct contacts *s, struct why *why)
{
    vec3(*basis)[3] = malloc((size_t)(s->n + 1) * sizeof *basis);
    if (!basis) return why_set(why, EX_SOFTWARE, "no memory for /contacts/frame");
    int e = table_read_rows(r, "/contacts/frame", COLUMN_F64, first, s->n, 9, basis, why);
    for (int64_t i = 0; !e && i < s->n; i++) {
        struct contact *c = &s->c[i];
        c->n = basis[i][0], c->t1 = basis[i][1];
        if (!(v3_norm(v3_sub(contact_t2(c), basis[i][2])) < 1e-6))
            e = why_set(why, EX_DATAERR, "contact %lld: frame is not right-handed and orthonormal",
                        (long long)i);
    }
    free(basis);
    return e;
}

/* The contacts of frame k, if the document keeps them. */
static int read_contacts(struct frame_read *r, int64_t k, struct frame *f, struct why *why)
{
    int64_t at = r->contacts.blocks - 1, first;
    struct contacts *s = &f->contacts;
    while (at >= 0 && r->contacts.step[at] != r->step[k]) at--;
    if (at < 0) return 0;
    first = r->contacts.start[at], s->n = r->contacts.count[at];
    if (first < 0 || s->n < 0 || first > INT32_MAX || s->n > INT32_MAX)
        return why_set(why, EX_DATAERR, "/contacts: start or count is out of range");
    hsize_t shape[4];
    if (h5_shape(r->tables.file, "/contacts/body", shape) != 2 ||
        (hsize_t)(first + s->n) > shape[0])
        return why_set(why, EX_DATAERR,
                       "/contacts/body: fewer than the %lld contacts of its frames",
                       (long long)(first + s->n));
    s->room = s->n ? s->n : 1;
    s->c = calloc((size_t)s->room, sizeof *s->c);
    if (!s->c) return why_set(why, EX_SOFTWARE, "no memory for the contacts");
    bool solved = h5_has(r->tables.file, "/contacts/reaction");
    if (solved && contacts_expect(s)) return why_set(why, EX_SOFTWARE, "no memory for reactions");
    if (table_read_columns(&r->tables, "/contacts", "", layout_contacts, first, s->n, s->c,
                           sizeof *s->c, why) ||
        read_bases(&r->tables, first, s, why) ||
        (solved && table_read_columns(&r->tables, "/contacts", "", layout_found, first, s->n,
                                      s->found, sizeof *s->found, why)))
        return why->status;
    if (contacts_check(s, f->packing.n, f->packing.walls, why)) return why->status;
    int moved;
    if (h5_attr_read(r->tables.file, "/contacts", "moved", H5T_NATIVE_INT, -1, &moved, why))
        return why->status;
    f->moved = moved;
    f->detected = true;
    return 0;
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

/*
 * The report on the solve that led to this step. A document of one frame with one report has just
 * that: nsd-solve reports on the step that is still to be made.
 */
static int read_report(struct frame_read *r, int64_t step, struct frame *f, struct why *why)
{
    int64_t at = r->frames == 1 && r->solves == 1 ? 0 : -1;
    for (int64_t i = 0; i < r->solves; i++)
        if (r->solved[i] == step) at = i;
    if (at < 0) return 0;
    struct report *rep = &f->report;
    const char *solver = "/observables/solver";
    if (table_read_columns(&r->tables, solver, "/value", layout_report, at, 1, rep, sizeof *rep,
                           why))
        return why->status;
    rep->step = r->solved[at];
    if (table_read_rows(&r->tables, "/observables/solver/time", COLUMN_F64, at, 1, 1, &rep->t, why))
        return why->status;
    char *method = h5_read_text(r->tables.file, "/observables/solver@method");
    char *criterion = h5_read_text(r->tables.file, "/observables/solver@criterion");
    rep->options = h5_read_text(r->tables.file, "/observables/solver@options");
    snprintf(rep->method, sizeof rep->method, "%s", method ? method : "");
    for (int c = 0; criterion && c < CRITERION_COUNT; c++)
        if (!strcmp(criterion, criterion_name[c])) rep->criterion = c;
    free(method), free(criterion);
    if (h5_attr_read(r->tables.file, solver, "eps", H5T_NATIVE_DOUBLE, -1, &rep->eps, why) ||
        read_history(r->tables.file, rep, why))
        return why->status;
    f->reported = true;
    return 0;
}

static int read_foreign(struct frame_read *r, struct frame *f, struct why *why)
{
    hid_t file = r->tables.file;
    if (fclib_read(&f->problem, file, why)) return why->status;
    f->foreign = true;
    struct delassus *W = &f->problem.W;
    if (fclib_load_solution(&f->problem, file, W->r, why)) return why->status;
    if (h5_has(file, "/solution/u")) {
        hsize_t n = (hsize_t)(W->d * W->n);
        f->u = calloc(n + 1, sizeof *f->u);
        if (!f->u) return why_set(why, EX_SOFTWARE, "no memory for the solution");
        if (h5_read(file, "/solution/u", H5T_NATIVE_DOUBLE, n, f->u, why)) return why->status;
    }
    return read_report(r, 0, f, why);
}

int frame_read_moment(struct frame_read *r, int64_t k, struct frame *f, struct why *why)
{
    f->origin = r->tables.file;
    f->history = h5_read_text(r->tables.file, "/nsd/history");
    if (!r->step) return read_foreign(r, f, why);
    if (read_packing(r, k, &f->packing, why)) return why->status;
    f->packed = true;
    return read_contacts(r, k, f, why) ? why->status : read_report(r, r->step[k], f, why);
}
