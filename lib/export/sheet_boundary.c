/*
 * export/sheet_boundary.c: walls as polygons, in the plane as lines, at the moment's time. A wall is
 * an infinite plane: it is cut off where the region of the grains ends, and by the other walls.
 */
#include "draw/walls.h"
#include "export/sheet.h"

static int add_polygons(struct sheet *s, const struct packing *p, int32_t *wall, struct why *why)
{
    struct region region;
    vec3 corner[WALLS_CORNERS];
    if (!region_of(&region, p)) return 0;
    for (int32_t i = 0; i < p->walls && i < WALLS_PANELS; i++) {
        int corners = walls_polygon(p, i, &region, corner);
        if (corners < 2) continue;
        wall[s->cells] = i;
        if (sheet_add(s, corners, corner, why)) return why->status;
    }
    return 0;
}

static void put(double *out, int64_t i, vec3 x)
{
    out[3 * i] = x.x, out[3 * i + 1] = x.y, out[3 * i + 2] = x.z;
}

int sheet_boundary(struct sheet *s, const struct moment *m, struct why *why)
{
    const struct packing *p = m->packing;
    int32_t wall[WALLS_PANELS] = { 0 };
    s->shape = p->dim == 2 ? SHEET_LINE : SHEET_POLYGON;
    if (add_polygons(s, p, wall, why)) return why->status;
    int32_t *number = sheet_whole(s, "boundary", "", why), *kind = sheet_whole(s, "kind", "", why);
    double *point = sheet_real(s, "point", "xyz", why), *n = sheet_real(s, "normal", "xyz", why);
    double *v = sheet_real(s, "velocity", "xyz", why);
    if (why->status) return why->status;
    for (int64_t k = 0; k < s->cells; k++) {
        const struct wall *w = &p->wall[wall[k]];
        number[k] = wall[k], kind[k] = w->kind;
        put(point, k, v3_axpy(w->x, p->t, w->v)), put(n, k, w->n), put(v, k, w->v);
    }
    return 0;
}
