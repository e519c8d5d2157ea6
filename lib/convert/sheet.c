#include "convert/sheet.h"

#include "state/face_of.h"

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

int sheet_of(struct sheet *s, enum part part, const struct export_frame *m, struct failure *failure)
{
    static int (*const fill[PART_COUNT])(
        struct sheet *, const struct export_frame *,
        struct failure *) = { sheet_grains, sheet_contacts, sheet_boundary, sheet_box, sheet_surfaces };
    *s = (struct sheet){ .shape = SHEET_POINT };
    if (fill[part](s, m, failure) || keep_wanted(s, part, m, failure)) sheet_free(s);
    return failure->status;
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
    if (sheet_grow(s, s->points + corners)) return failure_set(failure, EX_SOFTWARE, "no memory for an export");
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
