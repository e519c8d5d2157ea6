#include "io/frame_read.h"

#include "io/flow_tables.h"
#include "law/local.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { AHEAD = 256 }; /* reports read at once: 64 KiB */

/* The row of a step; looked for at `guess`, where it mostly is, then from the end on; -1: none */
static int64_t row_of(const int64_t *steps, int64_t n, int64_t step, int64_t guess)
{
    if (guess < n && steps[guess] == step) return guess;
    while (--n >= 0 && steps[n] != step) continue;
    return n;
}

static void *steps_of(const struct frame_read *r, const char *path, int64_t *n, struct why *why)
{
    uint64_t count = 0;
    void *steps = source_read_all(r->source, path, COLUMN_I64, &count, why);
    *n = (int64_t)count;
    return steps;
}

/* Steps and times of the frames. A frame counts when all of its motion is there. */
static int count_frames(struct frame_read *r, struct why *why)
{
    uint64_t m, shape[4];
    int64_t n;
    r->step = steps_of(r, "/particles/all/position/step", &n, why);
    r->time = source_read_all(r->source, "/particles/all/position/time", COLUMN_F64, &m, why);
    if (!r->step || !r->time) return why->status;
    n = n < (int64_t)m ? n : (int64_t)m;
    for (const struct column *c = layout_motion; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s/value", c->name);
        if (source_shape(r->source, path, shape) != 3)
            return why_set(why, EX_DATAERR, "%s: no dataset of shape frames x bodies x %d", path,
                           c->width);
        n = n < (int64_t)shape[0] ? n : (int64_t)shape[0];
    }
    if (source_shape(r->source, "/particles/all/id/value", shape) == 2)
        n = n < (int64_t)shape[0] ? n : (int64_t)shape[0];
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

/* The reports whose numbers in these columns are there: a killed writer's may differ. */
static void count_rows(struct frame_read *r, const struct column *columns)
{
    for (const struct column *c = columns; c->name; c++) {
        uint64_t shape[4];
        char path[80];
        snprintf(path, sizeof path, "%s/%s/value", r->reports, c->name);
        if (source_shape(r->source, path, shape) > 0 && shape[0] < (uint64_t)r->solves)
            r->solves = (int64_t)shape[0];
    }
}

static int count_reports(struct frame_read *r, struct why *why)
{
    char path[80];
    r->reports = source_has(r->source, LAYOUT_REPORT) ? LAYOUT_REPORT : LAYOUT_REPORT_0_1;
    snprintf(path, sizeof path, "%s/step", r->reports);
    if (source_has(r->source, path)) r->solved = steps_of(r, path, &r->solves, why);
    count_rows(r, layout_report);
    count_rows(r, layout_balance);
    return why->status;
}

/* Which edges of H5MD's box are periodic */
static int read_boundary(struct frame_read *r, struct why *why)
{
    const char *box = "/particles/all/box";
    char boundary[3][16];
    bool there;
    if (source_texts(r->source, box, "boundary", 3, boundary, &there, why)) return why->status;
    bool edges = source_has(r->source, "/particles/all/box/edges");
    for (int k = 0; there && k < 3; k++) {
        r->repeats[k] = !strcmp(boundary[k], "periodic");
        if (!r->repeats[k] && strcmp(boundary[k], "none") != 0)
            return why_set(why, EX_DATAERR, "%s@boundary: '%s' is neither periodic nor none", box,
                           boundary[k]);
        if (r->repeats[k] && !edges)
            return why_set(why, EX_DATAERR, "%s: periodic without edges", box);
    }
    if (!there && edges)
        return why_set(why, EX_DATAERR, "%s@boundary: not three strings of fixed length", box);
    return 0;
}

int frame_read_open(struct frame_read *r, struct source *source, struct why *why)
{
    *r = (struct frame_read){ .source = source, .frames = 1 };
    r->ahead.last = r->contacts.last = -1;
    if (source_has(source, "/particles/all")) {
        if (count_frames(r, why) || read_boundary(r, why)) return why->status;
        if (source_has(source, "/contacts") && count_contacts(r, why)) return why->status;
    } else if (!fclib_in(source)) {
        return why_set(why, EX_DATAERR, "holds neither particles nor an FCLIB problem");
    }
    return count_reports(r, why);
}

void frame_read_close(struct frame_read *r)
{
    free(r->step), free(r->time), free(r->solved);
    free(r->contacts.step), free(r->contacts.start), free(r->contacts.count);
    free(r->ahead.row), free(r->ahead.time);
    *r = (struct frame_read){ 0 };
}

/* Both halves of the tables say the same. */
static int check_symmetric(const struct packing *p, struct why *why)
{
    for (const struct column *c = layout_material; c->name; c++) {
        const double *table = column_array(c, p);
        for (int32_t a = 0; a < p->kinds; a++)
            for (int32_t b = 0; b < a; b++)
                if (!(table[a * p->kinds + b] == table[b * p->kinds + a]))
                    return why_set(why, EX_DATAERR, "/nsd/material/%s: %s and %s have two values",
                                   c->name, p->kind_name[b], p->kind_name[a]);
    }
    return 0;
}

static int read_material(struct source *doc, struct packing *p, struct why *why)
{
    char *names = source_text(doc, "/nsd/material", "kinds", why);
    int32_t kinds = 0;
    for (const char *c = names; c && *c; c++) kinds += *c == '\n';
    if (why->status) return why->status;
    if (!kinds) {
        free(names);
        return why_set(why, EX_DATAERR, "/nsd/material@kinds: no kinds of material");
    }
    int e = packing_alloc_kinds(p, kinds, why);
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
        e = source_read(doc, path, COLUMN_F64, (uint64_t)kinds * (uint64_t)kinds,
                        column_array(c, p), why);
    }
    free(names);
    return e ? e : check_symmetric(p, why);
}

/* The walls' loads, as they are in frame k */
static int read_loads(struct source *r, int64_t k, struct packing *p, struct why *why)
{
    if (!source_has(r, "/walls/load")) return 0;
    if (table_read_columns(r, "/walls/load", "", layout_loads, 0, p->walls, p->wall,
                           sizeof *p->wall, why))
        return why->status;
    double *row = calloc((size_t)p->walls + 1, sizeof *row);
    if (!row) return why_set(why, EX_SOFTWARE, "no memory for the loads");
    for (const struct column *c = layout_yield; !why->status && c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/walls/load/%s/value", c->name);
        if (!source_rows(r, path, c->type, k, 1, p->walls, row, why))
            column_scatter(c, p->walls, row, p->wall, sizeof *p->wall);
    }
    free(row);
    return why->status;
}

static int read_walls(struct source *r, int64_t k, struct packing *p, struct why *why)
{
    uint64_t shape[4];
    if (!source_has(r, "/walls/plane")) return 0;
    if (source_shape(r, "/walls/plane/point", shape) != 2 || shape[0] > 1 << 24)
        return why_set(why, EX_DATAERR, "/walls/plane/point: not of shape walls x 3");
    if (packing_alloc_walls(p, (int32_t)shape[0], why)) return why->status;
    if (table_read_columns(r, "/walls/plane", "", layout_walls, 0, p->walls, p->wall,
                           sizeof *p->wall, why))
        return why->status;
    return read_loads(r, k, p, why);
}

/* What is done about overlap; a document need not say it. */
static int read_overlap(struct source *doc, struct packing *p, struct why *why)
{
    char *name = source_text(doc, "/nsd", "overlap", why);
    if (!name) return why->status;
    for (int k = OVERLAP_KEEP; k < OVERLAP_COUNT; k++)
        if (!strcmp(name, overlap_name[k])) p->overlap = (enum overlap)k;
    free(name);
    return p->overlap ? 0 : why_set(why, EX_DATAERR, "/nsd@overlap: no such way against overlap");
}

static int read_parameters(struct source *doc, struct packing *p, struct why *why)
{
    double g[3];
    int64_t seed;
    if (source_attribute(doc, "/nsd", "dt", COLUMN_F64, -1, &p->dt, why) ||
        source_attribute(doc, "/nsd", "theta", COLUMN_F64, -1, &p->theta, why) ||
        source_attribute(doc, "/nsd", "gravity", COLUMN_F64, 3, g, why) ||
        source_attribute(doc, "/nsd", "seed", COLUMN_I64, -1, &seed, why))
        return why->status;
    p->g = v3(g[0], g[1], g[2]);
    p->seed = (uint64_t)seed;
    if (read_overlap(doc, p, why)) return why->status;
    p->scene = source_text(doc, "/nsd/scene", NULL, why);
    return why->status;
}

/* Bodies as they are in every frame, and where they are in frame k */
static int read_bodies(struct frame_read *r, int64_t k, struct packing *p, struct why *why)
{
    for (const struct column *c = layout_bodies; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s", c->name);
        if (source_rows(r->source, path, c->type, 0, p->n, c->width, column_array(c, p), why))
            return why->status;
    }
    for (const struct column *c = layout_motion; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s/value", c->name);
        if (source_rows(r->source, path, c->type, k, 1, p->n * c->width, column_array(c, p), why))
            return why->status;
    }
    return 0;
}

/* Rows row[n] of a column: of a frame, or of a table that all frames share (frame -1) */
static int read_spread(struct source *s, const char *path, const struct column *c, int64_t frame,
                       const int64_t *row, int64_t n, void *out, struct why *why)
{
    uint64_t shape[4];
    int rank = source_shape(s, path, shape);
    bool moves = frame >= 0;
    if (rank < 1 + moves) return why_set(why, EX_DATAERR, "%s: no dataset of bodies", path);
    int64_t rows = (int64_t)shape[moves], most = n ? row[n - 1] + 1 : 0; // rows ascend
    if (rows < most || rows > INT32_MAX)
        return why_set(why, EX_DATAERR, "%s: fewer rows than bodies", path);
    size_t bytes = (size_t)c->width * column_size(c->type);
    char *all = malloc((size_t)rows * bytes + 1);
    if (!all) return why_set(why, EX_SOFTWARE, "%s: no memory", path);
    int e = moves ? source_rows(s, path, c->type, frame, 1, rows * c->width, all, why)
                  : source_rows(s, path, c->type, 0, rows, c->width, all, why);
    for (int64_t i = 0; !e && i < n; i++)
        memcpy((char *)out + (size_t)i * bytes, all + (size_t)row[i] * bytes, bytes);
    free(all);
    return e;
}

/* The bodies of frame k where they come and go [io/roster.h]: rows whose id is not -1 */
static int read_roster(struct frame_read *r, int64_t k, const int64_t *row, struct packing *p,
                       struct why *why)
{
    for (const struct column *c = layout_bodies; c->name; c++) {
        char path[80];
        bool moves = !strcmp(c->name, "id");
        snprintf(path, sizeof path, "/particles/all/%s%s", c->name, moves ? "/value" : "");
        if (read_spread(r->source, path, c, moves ? k : -1, row, p->n, column_array(c, p), why))
            return why->status;
    }
    for (const struct column *c = layout_motion; c->name; c++) {
        char path[80];
        snprintf(path, sizeof path, "/particles/all/%s/value", c->name);
        if (read_spread(r->source, path, c, k, row, p->n, column_array(c, p), why))
            return why->status;
    }
    return 0;
}

/* Which rows are bodies in frame k; *row to be freed, NULL: the frame has all, as every frame. */
static int find_bodies(struct frame_read *r, int64_t k, int64_t **row, int64_t *n, struct why *why)
{
    uint64_t shape[4];
    const char *ids = "/particles/all/id/value";
    *row = NULL;
    if (source_shape(r->source, "/particles/all/radius", shape) != 1 || shape[0] > INT32_MAX)
        return why_set(why, EX_DATAERR, "/particles/all/radius: not a list of numbers");
    *n = (int64_t)shape[0];
    if (!source_has(r->source, ids)) return 0;
    if (source_shape(r->source, ids, shape) != 2 || shape[1] > INT32_MAX)
        return why_set(why, EX_DATAERR, "%s: not of shape frames x bodies", ids);
    int64_t rows = (int64_t)shape[1];
    int32_t *id = malloc(((size_t)rows + 1) * sizeof *id);
    *row = malloc(((size_t)rows + 1) * sizeof **row);
    if (!id || !*row) why_set(why, EX_SOFTWARE, "no memory for %lld bodies", (long long)rows);
    if (!why->status) source_rows(r->source, ids, COLUMN_I32, k, 1, rows, id, why);
    *n = 0;
    for (int64_t i = 0; !why->status && i < rows; i++)
        if (id[i] >= 0) (*row)[(*n)++] = i;
    free(id);
    return why->status;
}

/* Edges, constant or of frame k: three lengths, or three vectors */
static int read_edges(struct frame_read *r, int64_t k, struct cell *c, struct why *why)
{
    const char *moving = "/particles/all/box/edges/value", *still = "/particles/all/box/edges";
    uint64_t shape[4];
    double edge[9];
    if (source_has(r->source, moving)) {
        int rank = source_shape(r->source, moving, shape);
        if (rank != 2 && rank != 3)
            return why_set(why, EX_DATAERR, "%s: not of shape frames x 3 (x 3)", moving);
        if (source_rows(r->source, moving, COLUMN_F64, k, 1, rank == 2 ? 3 : 9, edge, why))
            return why->status;
        shape[0] = rank == 2 ? 3 : 9;
    } else {
        int rank = source_shape(r->source, still, shape);
        if (rank == 2) shape[0] *= shape[1];
        if ((rank != 1 && rank != 2) || shape[0] != (rank == 1 ? 3 : 9))
            return why_set(why, EX_DATAERR, "%s: not of shape 3 (x 3)", still);
        if (source_read(r->source, still, COLUMN_F64, shape[0], edge, why)) return why->status;
    }
    for (int i = 0; i < 3; i++)
        c->edge[i] = shape[0] == 9
                         ? v3(edge[3 * i], edge[3 * i + 1], edge[3 * i + 2])
                         : v3(i == 0 ? edge[0] : 0, i == 1 ? edge[1] : 0, i == 2 ? edge[2] : 0);
    return 0;
}

/* What moves the edges, and what they yield to */
static int read_drive(struct source *doc, struct cell *c, struct why *why)
{
    uint64_t n = 0;
    if (!source_has(doc, "/nsd/cell")) return 0;
    double *t = source_read_all(doc, "/nsd/cell/time", COLUMN_F64, &n, why);
    double *L = t && n < 1 << 24 ? calloc(9 * n + 1, sizeof *L) : NULL;
    c->gradient = L ? calloc(n + 1, sizeof *c->gradient) : NULL;
    if (t && !c->gradient) why_set(why, EX_SOFTWARE, "no memory for the cell's gradient");
    if (c->gradient && !source_read(doc, "/nsd/cell/gradient", COLUMN_F64, 9 * n, L, why))
        for (c->gradients = 0; c->gradients < (int32_t)n; c->gradients++) {
            struct cell_gradient *g = &c->gradient[c->gradients];
            g->t = t[c->gradients];
            memcpy(g->L, L + 9 * (size_t)c->gradients, sizeof g->L);
        }
    free(t), free(L);
    if (why->status) return why->status;
    return source_read(doc, "/nsd/cell/mass", COLUMN_F64, 9, c->mass, why) ||
                   source_read(doc, "/nsd/cell/stress", COLUMN_F64, 9, c->stress, why)
               ? why->status
               : 0;
}

/* The cell of frame k; the packing has its time. */
static int read_cell(struct frame_read *r, int64_t k, struct packing *p, struct why *why)
{
    const char *origin = "/particles/all/box/origin", *rate = "/particles/all/box/rate/value",
               *image = "/particles/all/image/value";
    struct cell *c = &p->cell;
    memcpy(c->repeats, r->repeats, sizeof c->repeats);
    if (!cell_repeats(c)) return 0;
    if (read_edges(r, k, c, why) || read_drive(r->source, c, why) || packing_alloc_images(p, why) ||
        (source_has(r->source, origin) &&
         source_read(r->source, origin, COLUMN_F64, 3, &c->origin, why)))
        return why->status;
    cell_set_rate(c, p->t);
    if (source_has(r->source, rate) &&
        source_rows(r->source, rate, COLUMN_F64, k, 1, 9, c->rate, why))
        return why->status;
    return source_has(r->source, image)
               ? source_rows(r->source, image, COLUMN_I32, k, 1, 3 * p->n, p->image, why)
               : 0;
}

static int read_packing(struct frame_read *r, int64_t k, struct packing *p, struct why *why)
{
    uint64_t shape[4];
    int dim;
    int64_t n = 0, *row;
    if (find_bodies(r, k, &row, &n, why)) goto end;
    if (source_attribute(r->source, "/nsd", "dim", COLUMN_I32, -1, &dim, why)) goto end;
    // no memory is allocated for bodies without positions
    if (source_shape(r->source, "/particles/all/position/value", shape) != 3 ||
        (row ? (int64_t)shape[1] < n : (int64_t)shape[1] != n)) {
        why_set(why, EX_DATAERR, "/particles/all/position/value: not of shape frames x %lld x 3",
                (long long)n);
        goto end;
    }
    if (packing_init(p, dim, n, why) || read_parameters(r->source, p, why) ||
        read_material(r->source, p, why) || read_walls(r->source, k, p, why) ||
        (row ? read_roster(r, k, row, p, why) : read_bodies(r, k, p, why)) ||
        flow_tables_read(r->source, k, p, why))
        goto end;
    p->step = r->step[k], p->t = r->time[k];
    if (packing_varies(p) && (r->repeats[0] || r->repeats[1] || r->repeats[2]))
        why_set(why, EX_DATAERR, "bodies that come and go in a cell that repeats: not known");
    else if (!read_cell(r, k, p, why))
        packing_check(p, why);
end:
    free(row);
    return why->status;
}

/* Of two shifts: < 0 where the first is the earlier one, 0 where they are the same */
static int compare_shifts(const int8_t a[3], const int8_t b[3])
{
    for (int k = 0; k < 3; k++)
        if (a[k] != b[k]) return a[k] < b[k] ? -1 : 1;
    return 0;
}

static int check_shifts(const struct contacts *s, const struct cell *cell, struct why *why)
{
    for (int64_t i = 0; i < s->n; i++)
        for (int k = 0; k < 3; k++)
            if (s->c[i].shift[k] && !cell->repeats[k])
                return why_set(why, EX_DATAERR,
                               "contact %lld: shift along edge %d, which does not repeat",
                               (long long)i, k);
    return 0;
}

/* What contacts_check leaves: they are sorted, each pair once, and their states are states. */
static int check_order(const struct contacts *s, struct why *why)
{
    for (int64_t i = 1; i < s->n; i++) {
        const struct contact *c = &s->c[i - 1], *next = &s->c[i];
        bool same_pair = c->a == next->a && c->b == next->b;
        int later = compare_shifts(c->shift, next->shift);
        if (same_pair && later > 0)
            return why_set(why, EX_DATAERR, "contact %lld: not sorted by its shift", (long long)i);
        if (same_pair && !later)
            return why_set(why, EX_DATAERR, "contact %lld: of bodies %d and %d, as the one before",
                           (long long)i, next->a, next->b);
        if (c->a > next->a || (c->a == next->a && c->b > next->b))
            return why_set(why, EX_DATAERR, "contact %lld: not sorted by its bodies", (long long)i);
    }
    for (int64_t i = 0; s->found && i < s->n; i++)
        if (s->found[i].status < LOCAL_FREE || s->found[i].status > LOCAL_SLIDE)
            return why_set(why, EX_DATAERR, "contact %lld: status is %d", (long long)i,
                           s->found[i].status);
    return 0;
}

/* The bases of the contacts from row `first` on; t2 has to be n x t1. */
static int read_bases(struct source *r, int64_t first, struct contacts *s, struct why *why)
{
    vec3(*basis)[3] = malloc((size_t)(s->n + 1) * sizeof *basis);
    if (!basis) return why_set(why, EX_SOFTWARE, "no memory for /contacts/frame");
    int e = source_rows(r, "/contacts/frame", COLUMN_F64, first, s->n, 9, basis, why);
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
    int64_t at = row_of(r->contacts.step, r->contacts.blocks, r->step[k], r->contacts.last + 1),
            first;
    struct contacts *s = &f->contacts;
    if (at < 0) return 0;
    r->contacts.last = at;
    first = r->contacts.start[at], s->n = r->contacts.count[at];
    if (first < 0 || s->n < 0 || first > INT32_MAX || s->n > INT32_MAX)
        return why_set(why, EX_DATAERR, "/contacts: start or count is out of range");
    uint64_t shape[4];
    if (source_shape(r->source, "/contacts/body", shape) != 2 ||
        (uint64_t)(first + s->n) > shape[0])
        return why_set(why, EX_DATAERR,
                       "/contacts/body: fewer than the %lld contacts of its frames",
                       (long long)(first + s->n));
    s->room = s->n ? s->n : 1;
    s->c = calloc((size_t)s->room, sizeof *s->c);
    if (!s->c) return why_set(why, EX_SOFTWARE, "no memory for the contacts");
    bool solved = source_has(r->source, "/contacts/reaction");
    if (solved && contacts_alloc_found(s))
        return why_set(why, EX_SOFTWARE, "no memory for reactions");
    if (table_read_columns(r->source, "/contacts", "", layout_contacts, first, s->n, s->c,
                           sizeof *s->c, why) ||
        read_bases(r->source, first, s, why) ||
        (cell_repeats(&f->packing.cell) &&
         table_read_columns(r->source, "/contacts", "", layout_shifts, first, s->n, s->c,
                            sizeof *s->c, why)) ||
        (solved && table_read_columns(r->source, "/contacts", "", layout_found, first, s->n,
                                      s->found, sizeof *s->found, why)))
        return why->status;
    if (contacts_check(s, f->packing.n, f->packing.walls, why) || check_order(s, why) ||
        check_shifts(s, &f->packing.cell, why))
        return why->status;
    int moved;
    if (source_attribute(r->source, "/contacts", "moved", COLUMN_I32, -1, &moved, why))
        return why->status;
    f->moved = moved;
    f->forces = source_has(r->source, LAYOUT_FORCE);
    f->detected = true;
    return 0;
}

/* Counts that are counts, a flag that is one: looked at as a byte, for a bool may not be 5. */
static int check_report(const struct report *rep, const char *group, struct why *why)
{
    uint8_t converged;
    memcpy(&converged, &rep->converged, 1);
    if (rep->sweeps < 0 || rep->err.contacts < 0 || rep->newton < 0 || rep->safeguarded < 0 ||
        rep->gave_up < 0)
        return why_set(why, EX_DATAERR, "%s: a number of things is negative", group);
    if (converged > 1) return why_set(why, EX_DATAERR, "%s/converged: is %d", group, converged);
    return 0;
}

static int read_history(struct source *doc, const char *group, struct report *rep, struct why *why)
{
    uint64_t n;
    char path[80];
    snprintf(path, sizeof path, "%s/history", group);
    if (!source_has(doc, path)) return 0;
    double *h = source_read_all(doc, path, COLUMN_F64, &n, why);
    if (!h) return why->status;
    rep->history = (struct terms *)h;
    return n == 5 * (uint64_t)rep->sweeps
               ? 0
               : why_set(why, EX_DATAERR, "%s: not of shape %d x 5", path, rep->sweeps);
}

/* Reports from `at` on, as many as there are up to AHEAD, but for their texts. */
static int read_ahead(struct frame_read *r, int64_t at, struct why *why)
{
    char time[80];
    free(r->ahead.row), free(r->ahead.time);
    int64_t n = r->solves - at < AHEAD ? r->solves - at : AHEAD;
    r->ahead.first = at, r->ahead.n = 0;
    r->ahead.row = calloc((size_t)n, sizeof *r->ahead.row);
    r->ahead.time = calloc((size_t)n, sizeof *r->ahead.time);
    if (!r->ahead.row || !r->ahead.time)
        return why_set(why, EX_SOFTWARE, "no memory for %s", r->reports);
    snprintf(time, sizeof time, "%s/time", r->reports);
    if (table_read_columns(r->source, r->reports, "/value", layout_report, at, n, r->ahead.row,
                           sizeof *r->ahead.row, why) ||
        source_rows(r->source, time, COLUMN_F64, at, n, 1, r->ahead.time, why))
        return why->status;
    snprintf(time, sizeof time, "%s/dissipation/value", r->reports);
    bool balanced = source_has(r->source, "/particles/all") && source_has(r->source, time);
    if (balanced && table_read_columns(r->source, r->reports, "/value", layout_balance, at, n,
                                       r->ahead.row, sizeof *r->ahead.row, why))
        return why->status;
    for (int64_t i = 0; i < n; i++) r->ahead.row[i].balanced = balanced;
    r->ahead.n = n;
    return 0;
}

/*
 * The report on the solve that led to this step. A document of one frame with one report has just
 * that: nsd-solve reports on the step that is still to be made.
 */
static int read_report(struct frame_read *r, int64_t step, struct frame *f, struct why *why)
{
    bool alone = r->frames == 1 && r->solves == 1;
    int64_t at = alone ? 0 : row_of(r->solved, r->solves, step, r->ahead.last + 1);
    if (at < 0) return 0;
    struct report *rep = &f->report;
    const char *solver = r->reports;
    bool there = at >= r->ahead.first && at < r->ahead.first + r->ahead.n;
    if (!there && read_ahead(r, at, why)) return why->status;
    *rep = r->ahead.row[at - r->ahead.first];
    if (check_report(rep, solver, why)) return why->status;
    rep->step = r->solved[at], rep->t = r->ahead.time[at - r->ahead.first];
    r->ahead.last = at;
    char *method = source_text(r->source, solver, "method", why);
    char *criterion = source_text(r->source, solver, "criterion", why);
    rep->options = source_text(r->source, solver, "options", why);
    snprintf(rep->method, sizeof rep->method, "%s", method ? method : "");
    for (int c = 0; criterion && c < CRITERION_COUNT; c++)
        if (!strcmp(criterion, criterion_name[c])) rep->criterion = c;
    free(method), free(criterion);
    if (why->status || source_attribute(r->source, solver, "eps", COLUMN_F64, -1, &rep->eps, why) ||
        read_history(r->source, solver, rep, why))
        return why->status;
    f->reported = true;
    return 0;
}

static int read_foreign(struct frame_read *r, struct frame *f, struct why *why)
{
    struct source *source = r->source;
    if (fclib_read(&f->problem, source, why)) return why->status;
    f->foreign = true;
    struct delassus *W = &f->problem.W;
    if (fclib_load_solution(&f->problem, source, W->r, why)) return why->status;
    if (source_has(source, "/solution/u")) {
        uint64_t n = (uint64_t)(W->d * W->n);
        f->u = calloc(n + 1, sizeof *f->u);
        if (!f->u) return why_set(why, EX_SOFTWARE, "no memory for the solution");
        if (source_read(source, "/solution/u", COLUMN_F64, n, f->u, why)) return why->status;
    }
    return read_report(r, 0, f, why);
}

int frame_read_moment(struct frame_read *r, int64_t k, struct frame *f, struct why *why)
{
    f->history = source_text(r->source, "/nsd/history", NULL, why);
    if (why->status) return why->status;
    if (!r->step) return read_foreign(r, f, why);
    if (read_packing(r, k, &f->packing, why)) return why->status;
    f->packed = true;
    return read_contacts(r, k, f, why) ? why->status : read_report(r, r->step[k], f, why);
}
