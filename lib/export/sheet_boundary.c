/*
 * export/sheet_boundary.c: boundaries as polygons, in the plane as lines, at the moment's time. A plane
 * is infinite: it is cut off where the region of the grains ends, and by the other planes.
 */
#include "draw/outline.h"
#include "draw/walls.h"
#include "export/sheet.h"

#include <stdlib.h>

/* Which boundary each cell is of */
struct owners {
    int32_t *of;
    int64_t room;
};

static int add_cell(struct sheet *s, struct owners *o, int32_t boundary, int corners,
                    const vec3 *corner, struct why *why)
{
    if (!o->of || s->cells == o->room) {
        int64_t room = 2 * o->room + 64;
        int32_t *of = realloc(o->of, (size_t)room * sizeof *of);
        if (!of) return why_set(why, EX_SOFTWARE, "no memory for the boundaries");
        o->of = of, o->room = room;
    }
    o->of[s->cells] = boundary;
    return sheet_add(s, corners, corner, why);
}

static int add_planes(struct sheet *s, struct owners *o, const struct packing *p,
                      const struct extent *region, struct why *why)
{
    vec3 corner[WALLS_CORNERS];
    for (int32_t i = 0; i < p->walls && i < WALLS_PANELS; i++) {
        int corners = walls_polygon(p, i, region, corner);
        if (corners >= 2 && add_cell(s, o, i, corners, corner, why)) return why->status;
    }
    return 0;
}

static int add_outlines(struct sheet *s, struct owners *o, const struct packing *p,
                        const struct extent *region, struct why *why)
{
    struct outline line;
    if (outline_init(&line, p, v3_norm(v3_sub(region->hi, region->lo)), why)) return why->status;
    for (int64_t i = 0; p->dim == 3 && i < line.triangles && !why->status; i++)
        add_cell(s, o, line.triangle[i].boundary, 3, line.triangle[i].corner, why);
    for (int64_t i = 0; p->dim == 2 && i < line.lines && !why->status; i++)
        add_cell(s, o, line.line[i].boundary, 2, line.line[i].end, why);
    outline_free(&line);
    return why->status;
}

static void put(double *out, int64_t i, vec3 x)
{
    out[3 * i] = x.x, out[3 * i + 1] = x.y, out[3 * i + 2] = x.z;
}

static int add_columns(struct sheet *s, const struct owners *o, const struct packing *p,
                       struct why *why)
{
    int32_t *number = sheet_whole(s, "boundary", "", why), *kind = sheet_whole(s, "kind", "", why);
    double *point = sheet_real(s, "point", "xyz", why), *n = sheet_real(s, "normal", "xyz", why);
    double *v = sheet_real(s, "velocity", "xyz", why);
    if (why->status) return why->status;
    for (int64_t k = 0; o->of && k < s->cells; k++) {
        const struct wall *w = &p->wall[o->of[k]];
        vec3 x = wall_at(p, w, p->t);
        number[k] = o->of[k], kind[k] = w->kind;
        put(point, k, x), put(n, k, wall_normal(p, w, p->t)), put(v, k, wall_velocity(p, w, x));
    }
    return 0;
}

int sheet_boundary(struct sheet *s, const struct export_frame *m, struct why *why)
{
    const struct packing *p = m->packing;
    struct extent region = { 0 };
    struct owners o = { 0 };
    s->shape = p->dim == 2 ? SHEET_LINE : SHEET_POLYGON;
    if (region_of(&region, p) && !add_planes(s, &o, p, &region, why))
        add_outlines(s, &o, p, &region, why);
    if (!why->status) add_columns(s, &o, p, why);
    free(o.of);
    return why->status;
}
