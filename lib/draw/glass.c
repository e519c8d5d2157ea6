/* draw/glass.c: facets of planes and of all other shapes [draw/glass.h]. */
#include "draw/glass.h"

#include <stdlib.h>

static void add(struct glass *g, vec3 a, vec3 b, vec3 c)
{
    vec3 n = v3_cross(v3_sub(b, a), v3_sub(c, a));
    double area = v3_norm(n);
    if (area > 0) g->facet[g->facets++] = (struct facet){ { a, b, c }, v3_scale(1 / area, n) };
}

static void add_planes(struct glass *g, const struct packing *p, const struct extent *r,
                       vec3 toward)
{
    vec3 corner[WALLS_CORNERS];
    for (int i = 0; i < p->walls && i < WALLS_PANELS; i++) {
        int corners = walls_polygon(p, i, r, corner);
        if (corners < 3 || walls_floor(p, i, toward)) continue;
        for (int k = 2; k < corners; k++) add(g, corner[0], corner[k - 1], corner[k]);
    }
}

int glass_init(struct glass *g, const struct packing *p, const struct extent *r, vec3 toward,
               struct why *why)
{
    struct outline o;
    *g = (struct glass){ 0 };
    if (p->dim == 2) return 0;
    if (outline_init(&o, p, v3_norm(v3_sub(r->hi, r->lo)), why)) return why->status;
    int64_t room = o.triangles + (int64_t)WALLS_PANELS * WALLS_CORNERS;
    g->facet = malloc((size_t)room * sizeof *g->facet);
    if (g->facet) {
        add_planes(g, p, r, toward);
        for (int64_t i = 0; i < o.triangles; i++) {
            const vec3 *x = o.triangle[i].corner;
            add(g, x[0], x[1], x[2]);
        }
    } else
        why_set(why, EX_SOFTWARE, "no memory for the facets of the boundaries");
    outline_free(&o);
    return why->status;
}

void glass_free(struct glass *g)
{
    free(g->facet);
    *g = (struct glass){ 0 };
}
