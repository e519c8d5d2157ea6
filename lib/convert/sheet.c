#include "convert/sheet.h"

#include "base/array.h"
#include "draw/facets.h"
#include "state/face_of.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void sheet_free(struct sheet *s)
{
    free(s->x), free(s->corner), free(s->end);
    for (int k = 0; k < s->columns; k++) free(s->column[k].real), free(s->column[k].whole);
    *s = (struct sheet){ 0 };
}

/* Keeps the cells that `keep` says [cells], and their rows; cells share no points. */
static void keep_cells(struct sheet *s, const bool *keep)
{
    int64_t cells = 0, points = 0, begin = 0;
    for (int64_t k = 0; k < s->cells; k++) {
        const int64_t end = s->end[k];
        for (int64_t i = begin; keep[k] && i < end; i++)
            s->x[points] = s->x[s->corner[i]], s->corner[points] = points, points++;
        begin = end;
        if (!keep[k]) continue;
        for (int j = 0; j < s->columns; j++) {
            const struct sheet_column *c = &s->column[j];
            const size_t width = (size_t)c->width, to = (size_t)cells * width,
                         from = (size_t)k * width;
            if (c->real) memmove(c->real + to, c->real + from, width * sizeof *c->real);
            if (c->whole) memmove(c->whole + to, c->whole + from, width * sizeof *c->whole);
        }
        s->end[cells++] = points;
    }
    s->cells = cells, s->points = s->corners = points;
}

/* Of grains and contacts, those that are wanted: others count in what is said of these. */
static int keep_wanted(struct sheet *s, enum part part, const struct export_frame *m,
                       struct failure *failure)
{
    const struct packing *p = m->packing;
    struct wall_faces faces = { 0 };
    if (!m->only || (part != PART_GRAINS && part != PART_CONTACTS)) return 0;
    if (part == PART_GRAINS && !m->only->bodies) return 0;
    bool *keep = calloc((size_t)s->cells + 1, sizeof *keep);
    if (!keep) return failure_set(failure, EX_SOFTWARE, "no memory for an export");
    if (part == PART_CONTACTS && face_of_init(&faces, p, p->names.rows > 0, failure))
        return free(keep), failure->status;
    for (int64_t k = 0; k < s->cells; k++)
        keep[k] = part == PART_GRAINS ? export_frame_has(m, k)
                                      : selection_contact(m->only, p, &faces, &m->contacts->c[k]);
    keep_cells(s, keep);
    wall_faces_free(&faces), free(keep);
    return 0;
}

/* Room for so many points, and as many cells and corners */
static int sheet_grow(struct sheet *s, int64_t least)
{
    if (least <= s->room) return 0;
    int64_t room = s->room ? 2 * s->room : 64;
    if (room < least) room = least;
    vec3 *x = realloc(s->x, (size_t)room * sizeof *x);
    if (x) s->x = x;
    int64_t *corner = realloc(s->corner, (size_t)room * sizeof *corner);
    if (corner) s->corner = corner;
    int64_t *end = realloc(s->end, (size_t)room * sizeof *end);
    if (end) s->end = end;
    if (!x || !corner || !end) return -1;
    s->room = room;
    return 0;
}

int sheet_add(struct sheet *s, int corners, const vec3 *x, struct failure *failure)
{
    if (sheet_grow(s, s->points + corners))
        return failure_set(failure, EX_SOFTWARE, "no memory for an export");
    for (int k = 0; k < corners; k++) {
        s->corner[s->corners++] = s->points;
        s->x[s->points++] = x[k];
    }
    s->end[s->cells++] = s->corners;
    return 0;
}

static struct sheet_column *sheet_add_column(struct sheet *s, const char *name, const char *suffix)
{
    struct sheet_column *c = &s->column[s->columns++];
    *c = (struct sheet_column){ name, suffix, *suffix ? (int)strlen(suffix) : 1, NULL, NULL };
    return c;
}

double *sheet_real(struct sheet *s, const char *name, const char *suffix, struct failure *failure)
{
    struct sheet_column *c = sheet_add_column(s, name, suffix);
    c->real = calloc((size_t)(sheet_rows(s) * c->width) + 1, sizeof *c->real);
    if (!c->real) failure_set(failure, EX_SOFTWARE, "no memory for an export");
    return c->real;
}

int32_t *sheet_whole(struct sheet *s, const char *name, const char *suffix, struct failure *failure)
{
    struct sheet_column *c = sheet_add_column(s, name, suffix);
    c->whole = calloc((size_t)(sheet_rows(s) * c->width) + 1, sizeof *c->whole);
    if (!c->whole) failure_set(failure, EX_SOFTWARE, "no memory for an export");
    return c->whole;
}

/* The cell as the lines along its edges; none where nothing repeats. */

static int sheet_box(struct sheet *s, const struct export_frame *m, struct failure *failure)
{
    const struct cell *c = &m->packing->cell;
    struct box b;
    s->shape = SHEET_LINE;
    if (!cell_repeats(c)) return 0;
    export_frame_box(&b, m->packing);
    for (int k = 0; k < 3; k++)
        for (int corner = 0; corner < 4; corner++) {
            vec3 from = b.origin;
            if (corner & 1) from = v3_add(from, b.edge[(k + 1) % 3]);
            if (corner & 2) from = v3_add(from, b.edge[(k + 2) % 3]);
            const vec3 line[2] = { from, v3_add(from, b.edge[k]) };
            if (sheet_add(s, 2, line, failure)) return failure->status;
        }
    int32_t *edge = sheet_whole(s, "edge", "", failure),
            *repeats = sheet_whole(s, "repeats", "", failure);
    double *rate = sheet_real(s, "rate", "xyz", failure);
    if (failure->status) return failure->status;
    for (int k = 0; k < 12; k++) {
        const vec3 r = c->rate[k / 4];
        edge[k] = k / 4, repeats[k] = c->repeats[k / 4];
        rate[3 * k] = r.x, rate[3 * k + 1] = r.y, rate[3 * k + 2] = r.z;
    }
    return 0;
}

/*
 * Contacts as lines from centre to centre, from a wall's point of
 * contact to the centre; with forces in N, in space, where they are solved.
 */

static int sheet_add_lines(struct sheet *s, const struct export_frame *m, struct failure *failure)
{
    const struct packing *p = m->packing;
    for (int64_t i = 0; i < m->contacts->n; i++) {
        const struct contact *c = &m->contacts->c[i];
        vec3 b = v3_add(p->x[c->b], cell_shift(p->cell.edge, c->shift));
        const vec3 end[2] = { c->a >= 0 ? p->x[c->a] : c->x, b };
        if (sheet_add(s, 2, end, failure)) return failure->status;
    }
    return 0;
}

static void sheet_put(double *out, int64_t i, vec3 x)
{
    out[3 * i] = x.x, out[3 * i + 1] = x.y, out[3 * i + 2] = x.z;
}

static int sheet_add_forces(struct sheet *s, const struct export_frame *m, struct failure *failure)
{
    const double dt = m->packing->dt;
    int32_t *status = sheet_whole(s, "status", "", failure);
    double *force = sheet_real(s, "force", "xyz", failure);
    double *normal = sheet_real(s, "normal_force", "", failure);
    double *tangential = sheet_real(s, "tangential_force", "", failure);
    if (failure->status) return failure->status;
    for (int64_t i = 0; i < m->contacts->n; i++) {
        const struct found *f = &m->contacts->found[i];
        status[i] = (int32_t)f->status; // NOLINT(bugprone-signed-char-misuse): 0, 1 or 2
        sheet_put(force, i, v3_scale(1 / dt, contact_in_space(&m->contacts->c[i], f->r)));
        normal[i] = f->r[0] / dt, tangential[i] = hypot(f->r[1], f->r[2]) / dt;
    }
    return 0;
}

static int sheet_contacts(struct sheet *s, const struct export_frame *m, struct failure *failure)
{
    const struct packing *p = m->packing;
    s->shape = SHEET_LINE;
    if (!m->contacts) return 0;
    if (sheet_add_lines(s, m, failure)) return failure->status;
    int32_t *body = sheet_whole(s, "body", "ab", failure),
            *id = sheet_whole(s, "id", "ab", failure);
    double *point = sheet_real(s, "point", "xyz", failure),
           *n = sheet_real(s, "normal", "xyz", failure);
    double *gap = sheet_real(s, "gap", "", failure), *mu = sheet_real(s, "mu", "", failure);
    if (failure->status) return failure->status;
    for (int64_t i = 0; i < m->contacts->n; i++) {
        const struct contact *c = &m->contacts->c[i];
        body[2 * i] = c->a, body[2 * i + 1] = c->b;
        id[2 * i] = c->a >= 0 ? p->id[c->a] : c->a, id[2 * i + 1] = p->id[c->b];
        sheet_put(point, i, c->x), sheet_put(n, i, c->n);
        gap[i] = c->gap, mu[i] = c->mu;
    }
    return m->contacts->found ? sheet_add_forces(s, m, failure) : 0;
}

/* Grains as points, with all that a document says of each. */

/* contacts[i], force[i] = how many contacts of grain i push, and the sum of their forces (N) */
static int sheet_add_contacts(struct sheet *s, const struct export_frame *m,
                              struct failure *failure)
{
    const struct packing *p = m->packing;
    const struct contacts *t = m->contacts;
    int32_t *count = sheet_whole(s, "contacts", "", failure);
    double *force = sheet_real(s, "contact_force", "xyz", failure);
    if (failure->status) return failure->status;
    for (int64_t i = 0; i < t->n; i++) {
        const struct contact *c = &t->c[i];
        vec3 f = v3_scale(1 / p->dt, contact_in_space(c, t->found[i].r));
        for (int side = 0; side < 2; side++) {
            int32_t body = side ? c->b : c->a;
            if (body < 0) continue;
            count[body] += t->found[i].r[0] > 0;
            double sign = side ? 1 : -1, *to = force + 3 * (size_t)body;
            to[0] += sign * f.x, to[1] += sign * f.y, to[2] += sign * f.z;
        }
    }
    return 0;
}

/* Which columns of bodies come first, also those that the packing lacks; which of the others do not come; and the body
   of each row, NULL: its number */
struct sheet_bodies {
    const int8_t *first;
    int n;
    unsigned without;
    const int32_t *of;
};

static void sheet_add_bodies(struct sheet *s, const struct packing *p,
                             const struct sheet_bodies *list, struct failure *failure)
{
    for (int k = 0; k < list->n + BODY_COLUMNS && !failure->status; k++) {
        const int column = k < list->n ? list->first[k] : k - list->n;
        const struct field *f = &body_columns[column];
        const size_t bytes = field_bytes(f);
        const char *suffix = f->width == 1 ? "" : f->width == 3 ? "xyz" : "wxyz";
        if (k >= list->n && (list->without >> column & 1 || !field_array(f, p))) continue;
        char *to = f->type == COLUMN_F64 ? (char *)sheet_real(s, field_key(f), suffix, failure)
                                         : (char *)sheet_whole(s, field_key(f), suffix, failure);
        for (int64_t i = 0; to && i < sheet_rows(s); i++)
            memcpy(to + bytes * (size_t)i, field_row(f, p, list->of ? list->of[i] : i), bytes);
    }
}

static int sheet_grains(struct sheet *s, const struct export_frame *m, struct failure *failure)
{
    static const int8_t first[] = { BODY_id, BODY_material, BODY_radius, BODY_mass,
                                    BODY_v,  BODY_w,        BODY_q };
    static const struct sheet_bodies list = { first, sizeof first,
                                              1 << BODY_id | 1 << BODY_material | 1 << BODY_radius |
                                                  1 << BODY_mass | 1 << BODY_inertia | 1 << BODY_x |
                                                  1 << BODY_v | 1 << BODY_w | 1 << BODY_q,
                                              NULL };
    const struct packing *p = m->packing;
    s->shape = SHEET_POINT, s->of_points = true;
    for (int64_t i = 0; i < p->n; i++)
        if (sheet_add(s, 1, &p->x[i], failure)) return failure->status;
    sheet_add_bodies(s, p, &list, failure);
    if (failure->status) return failure->status;
    return m->contacts && m->contacts->found ? sheet_add_contacts(s, m, failure) : 0;
}

/* The surfaces of grains that are no balls, as polygons: a cell for each. */

/* Which grain each cell is of */
struct sheet_cells {
    struct sheet *s;
    int64_t grain, room;
    int32_t *of;
    struct failure *failure;
};

static void sheet_add_cell(void *to, int corners, const vec3 *x)
{
    struct sheet_cells *c = to;
    if (c->failure->status) return;
    if (!array_grow(&c->of, &c->room, c->s->cells + 1, sizeof *c->of)) {
        failure_set(c->failure, EX_SOFTWARE, "no memory for the surfaces of the grains");
        return;
    }
    c->of[c->s->cells] = (int32_t)c->grain;
    sheet_add(c->s, corners, x, c->failure);
}

static void sheet_surfaces_put(double *out, int64_t k, vec3 x)
{
    out[3 * k] = x.x, out[3 * k + 1] = x.y, out[3 * k + 2] = x.z;
}

static void sheet_add_columns(struct sheet *s, const int32_t *of, const struct packing *p,
                              struct failure *failure)
{
    static const int8_t first[] = { BODY_id,   BODY_material, BODY_shape, BODY_radius,
                                    BODY_mass, BODY_v,        BODY_w };
    const struct sheet_bodies list = { first, sizeof first, ~0U, of };
    sheet_add_bodies(s, p, &list, failure);
}

/* Of solved contacts: how many push each cell's grain, and the sum of their forces on it (N) */
static void sheet_surfaces_add_contacts(struct sheet *s, const int32_t *of,
                                        const struct export_frame *m, struct failure *failure)
{
    const struct packing *p = m->packing;
    const struct contacts *t = m->contacts;
    int32_t *count = sheet_whole(s, "contacts", "", failure);
    double *force = sheet_real(s, "contact_force", "xyz", failure);
    vec3 *sum = calloc((size_t)p->n + 1, sizeof *sum);
    int32_t *pushes = calloc((size_t)p->n + 1, sizeof *pushes);
    if (!sum || !pushes) failure_set(failure, EX_SOFTWARE, "no memory for the forces on grains");
    for (int64_t i = 0; !failure->status && i < t->n; i++) {
        const struct contact *c = &t->c[i];
        vec3 f = v3_scale(1 / p->dt, contact_in_space(c, t->found[i].r));
        sum[c->b] = v3_add(sum[c->b], f), pushes[c->b] += t->found[i].r[0] > 0;
        if (c->a >= 0) sum[c->a] = v3_sub(sum[c->a], f), pushes[c->a] += t->found[i].r[0] > 0;
    }
    for (int64_t k = 0; !failure->status && of && k < s->cells; k++)
        count[k] = pushes[of[k]], sheet_surfaces_put(force, k, sum[of[k]]);
    free(sum), free(pushes);
}

static int sheet_surfaces(struct sheet *s, const struct export_frame *m, struct failure *failure)
{
    const struct packing *p = m->packing;
    struct sheet_cells c = { .s = s, .failure = failure };
    struct facets f;
    s->shape = SHEET_POLYGON;
    if (facets_init(&f, m->detail, failure)) return failure->status;
    for (c.grain = 0; c.grain < p->n && !failure->status; c.grain++)
        if (packing_shape(p, c.grain) && export_frame_has(m, c.grain))
            facets_of(&f, p, c.grain, sheet_add_cell, &c);
    if (!failure->status) sheet_add_columns(s, c.of, p, failure);
    if (!failure->status && m->contacts && m->contacts->found)
        sheet_surfaces_add_contacts(s, c.of, m, failure);
    facets_free(&f);
    free(c.of);
    return failure->status;
}

/* ---- any part ---- */

int sheet_of(struct sheet *s, enum part part, const struct export_frame *m, struct failure *failure)
{
    static int (*const fill[PART_COUNT])(struct sheet *, const struct export_frame *,
                                         struct failure *) = { sheet_grains, sheet_contacts,
                                                               sheet_walls, sheet_box,
                                                               sheet_surfaces };
    *s = (struct sheet){ .shape = SHEET_POINT };
    if (fill[part](s, m, failure) || keep_wanted(s, part, m, failure)) sheet_free(s);
    return failure->status;
}
