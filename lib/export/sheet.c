#include "export/sheet.h"

#include <stdlib.h>
#include <string.h>

void sheet_free(struct sheet *s)
{
    free(s->x), free(s->corner), free(s->end);
    for (int k = 0; k < s->columns; k++) free(s->column[k].real), free(s->column[k].whole);
    *s = (struct sheet){ 0 };
}

int sheet_of(struct sheet *s, enum part part, const struct export_frame *m, struct why *why)
{
    static int (*const fill[PART_COUNT])(
        struct sheet *, const struct export_frame *,
        struct why *) = { sheet_grains, sheet_contacts, sheet_boundary, sheet_box, sheet_surfaces };
    *s = (struct sheet){ .shape = SHEET_POINT };
    if (fill[part](s, m, why)) sheet_free(s);
    return why->status;
}

/* Room for so many points, and as many cells and corners */
static int grow(struct sheet *s, int64_t least)
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

int sheet_add(struct sheet *s, int corners, const vec3 *x, struct why *why)
{
    if (grow(s, s->points + corners)) return why_set(why, EX_SOFTWARE, "no memory for an export");
    for (int k = 0; k < corners; k++) {
        s->corner[s->corners++] = s->points;
        s->x[s->points++] = x[k];
    }
    s->end[s->cells++] = s->corners;
    return 0;
}

static struct sheet_column *add_column(struct sheet *s, const char *name, const char *suffix)
{
    struct sheet_column *c = &s->column[s->columns++];
    *c = (struct sheet_column){ name, suffix, *suffix ? (int)strlen(suffix) : 1, NULL, NULL };
    return c;
}

double *sheet_real(struct sheet *s, const char *name, const char *suffix, struct why *why)
{
    struct sheet_column *c = add_column(s, name, suffix);
    c->real = calloc((size_t)(sheet_rows(s) * c->width) + 1, sizeof *c->real);
    if (!c->real) why_set(why, EX_SOFTWARE, "no memory for an export");
    return c->real;
}

int32_t *sheet_whole(struct sheet *s, const char *name, const char *suffix, struct why *why)
{
    struct sheet_column *c = add_column(s, name, suffix);
    c->whole = calloc((size_t)(sheet_rows(s) * c->width) + 1, sizeof *c->whole);
    if (!c->whole) why_set(why, EX_SOFTWARE, "no memory for an export");
    return c->whole;
}
