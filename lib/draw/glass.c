/* draw/glass.c: facets of planes and of all other shapes [draw/glass.h]. */
#include "draw/glass.h"

#include <stdlib.h>

/* r < 0: glass */
static struct rgb wall_facets_own_of(const struct solid_walls *s, int32_t boundary, int32_t face)
{
    return s ? s->colour[s->faces.first[boundary] + face] : (struct rgb){ -1, 0, 0 };
}

static void wall_facets_add(struct glass *g, struct rgb own, vec3 a, vec3 b, vec3 c)
{
    vec3 n = v3_cross(v3_sub(b, a), v3_sub(c, a));
    double area = v3_norm(n);
    if (area > 0) g->facet[g->facets++] = (struct facet){ { a, b, c }, v3_scale(1 / area, n), own };
}

static void wall_facets_add_planes(struct glass *g, const struct packing *p, const struct glass_opt *o)
{
    vec3 corner[WALLS_CORNERS];
    for (int i = 0; i < p->walls && i < WALLS_PANELS; i++) {
        int corners = walls_polygon(p, i, &o->region, corner);
        struct rgb own = wall_facets_own_of(o->solid, i, 0);
        if (corners < 3 || (own.r < 0 && (!o->glass || walls_floor(p, i, o->toward)))) continue;
        for (int k = 2; k < corners; k++) wall_facets_add(g, own, corner[0], corner[k - 1], corner[k]);
    }
}

int glass_init(struct glass *g, const struct packing *p, const struct glass_opt *o, struct failure *failure)
{
    const vec3 across = v3_sub(o->region.hi, o->region.lo);
    struct outline all;
    *g = (struct glass){ 0 };
    if (p->dim == 2) return 0;
    if (outline_init(&all, p, v3_norm(across), failure)) return failure->status;
    int64_t room = all.triangles + (int64_t)WALLS_PANELS * WALLS_CORNERS;
    g->facet = malloc((size_t)room * sizeof *g->facet);
    if (g->facet) {
        wall_facets_add_planes(g, p, o);
        for (int64_t i = 0; i < all.triangles; i++) {
            const vec3 *x = all.triangle[i].corner;
            struct rgb own = wall_facets_own_of(o->solid, all.triangle[i].boundary, all.triangle[i].face);
            if (own.r >= 0 || o->glass) wall_facets_add(g, own, x[0], x[1], x[2]);
        }
    } else
        failure_set(failure, EX_SOFTWARE, "no memory for the facets of the boundaries");
    outline_free(&all);
    return failure->status;
}

void glass_free(struct glass *g)
{
    free(g->facet);
    *g = (struct glass){ 0 };
}
