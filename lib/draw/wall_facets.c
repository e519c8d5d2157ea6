/* draw/wall_facets.c: facets of planes and of all other shapes [draw/wall_facets.h]. */
#include "draw/wall_facets.h"

#include "state/selection.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const struct surface_meaning surface_meaning[SURFACE_COUNT] = {
    [SURFACE_NAME] = { "name", "", "one colour per name" },
    [SURFACE_PRESSURE] = { "pressure", "Pa", "mean pressure of the run, from sums" },
    [SURFACE_FRICTION] = { "friction", "J/m2", "work of friction per m2, from sums" },
    [SURFACE_RUB] = { "sliding_work", "J/m2",
                      "normal force times sliding distance per m2, from sums: wear over a "
                      "coefficient" },
};

/* Colours of names, which differ from those of materials: brass, steel blue, copper, moss, slate, plum */
static const unsigned colours[] = { 0xc9b27a, 0x8fa3b8, 0xc08a6e, 0x96a77e, 0x8a8f98, 0xa88fae };
enum { COLOURS = sizeof colours / sizeof colours[0] };

void solid_free(struct solid_walls *s)
{
    wall_faces_free(&s->faces);
    free(s->colour);
    *s = (struct solid_walls){ 0 };
}

/* The number that a face shows; NaN where its area has no end */
static double value_of(const struct solid_walls *s, const struct packing *p, int32_t wall,
                       int32_t face)
{
    const struct face_sums *x = &p->sums.face[s->faces.first[wall] + face];
    double area = face_of_area(p, wall, face), span = p->t - p->sums.since;
    if (!isfinite(area) || !(area > 0)) return NAN;
    if (s->by == SURFACE_PRESSURE) return x->normal / (span * area);
    return (s->by == SURFACE_FRICTION ? x->friction : x->rub) / area;
}

/* The name by which a face was chosen; else its own; NULL: none */
static const char *wall_facets_name_of(const struct selection *c, const struct packing *p,
                                       int32_t wall, int32_t face)
{
    for (int32_t k = 0; c->any && k < p->names.rows; k++) {
        const struct named *r = &p->names.row[k];
        bool covers = !r->count || (face >= r->first && face < r->first + r->count);
        if (c->name[r->name] && r->wall == wall && covers) return p->names.text[r->name];
    }
    return names_of_face(&p->names, wall, face);
}

/* The row of the legend for a face, by its name, or the number of its wall */
static int legend_row(struct solid_walls *s, const struct selection *c, const struct packing *p,
                      int32_t wall, int32_t face)
{
    char name[NAME_BYTES + 12];
    const char *own = wall_facets_name_of(c, p, wall, face);
    if (own)
        snprintf(name, sizeof name, "%s", own);
    else
        snprintf(name, sizeof name, "wall %d", wall);
    for (int k = 0; k < s->named; k++)
        if (!strcmp(s->name[k], name)) return k;
    if (s->named == SOLID_NAMES) return SOLID_NAMES - 1;
    strcpy(s->name[s->named], name);
    s->shown[s->named] = rgb_of(colours[s->named % COLOURS]);
    return s->named++;
}

static void set_range(struct solid_walls *s, const struct packing *p, const struct selection *c)
{
    if (!isnan(s->lo)) return;
    s->lo = 0, s->hi = -INFINITY;
    for (int32_t w = 0; w < p->walls; w++)
        for (int32_t k = 0; k < s->faces.first[w + 1] - s->faces.first[w]; k++) {
            double x = selection_face(c, p, w, k) ? value_of(s, p, w, k) : NAN;
            if (isfinite(x)) s->lo = fmin(s->lo, x), s->hi = fmax(s->hi, x);
        }
}

static struct rgb palette_colour(const struct solid_walls *s, const struct paint *paint, double x)
{
    double t = (x - s->lo) / (s->hi - s->lo);
    if (isnan(x) || isnan(t)) return rgb_of(0xb8b8b8);
    return paint->palette[(int)(255 * fmin(fmax(t, 0), 1) + 0.5)];
}

int solid_init(struct solid_walls *s, const struct packing *p, const struct solid_opt *o,
               struct failure *failure)
{
    const enum solid_by by = o->by;
    struct selection c;
    *s = (struct solid_walls){ .by = by, .lo = o->lo, .hi = o->hi };
    if (selection_init(&c, p, "--solid", o->list, failure)) return failure->status;
    if (by != SURFACE_NAME && !p->sums.n)
        failure_set(failure, EX_DATAERR, "no sums of walls (nsd-step --wall-loads keeps them)");
    if (!failure->status && !face_of_init(&s->faces, p, false, failure) &&
        !(s->colour = calloc((size_t)s->faces.n + 1, sizeof *s->colour)))
        failure_set(failure, EX_SOFTWARE, "no memory for the colours of walls");
    if (!failure->status && by != SURFACE_NAME) set_range(s, p, &c);
    for (int32_t w = 0; !failure->status && w < p->walls; w++)
        for (int32_t k = 0; k < s->faces.first[w + 1] - s->faces.first[w]; k++) {
            struct rgb *to = &s->colour[s->faces.first[w] + k];
            if (!selection_face(&c, p, w, k))
                to->r = -1;
            else if (by == SURFACE_NAME)
                *to = s->shown[legend_row(s, &c, p, w, k)];
            else
                *to = palette_colour(s, o->paint, value_of(s, p, w, k));
        }
    selection_free(&c);
    if (failure->status) solid_free(s);
    return failure->status;
}

/* r < 0: glass */
static struct rgb wall_facets_own_of(const struct solid_walls *s, int32_t wall, int32_t face)
{
    return s ? s->colour[s->faces.first[wall] + face] : (struct rgb){ -1, 0, 0 };
}

static void wall_facets_add(struct glass *g, struct rgb own, vec3 a, vec3 b, vec3 c)
{
    vec3 n = v3_cross(v3_sub(b, a), v3_sub(c, a));
    double area = v3_norm(n);
    if (area > 0) g->facet[g->facets++] = (struct facet){ { a, b, c }, v3_scale(1 / area, n), own };
}

static void wall_facets_add_planes(struct glass *g, const struct packing *p,
                                   const struct glass_opt *o)
{
    vec3 corner[WALLS_CORNERS];
    for (int i = 0; i < p->walls && i < WALLS_PANELS; i++) {
        int corners = walls_polygon(p, i, &o->region, corner);
        struct rgb own = wall_facets_own_of(o->solid, i, 0);
        if (corners < 3 || (own.r < 0 && (!o->glass || walls_floor(p, i, o->toward)))) continue;
        for (int k = 2; k < corners; k++)
            wall_facets_add(g, own, corner[0], corner[k - 1], corner[k]);
    }
}

int glass_init(struct glass *g, const struct packing *p, const struct glass_opt *o,
               struct failure *failure)
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
            struct rgb own =
                wall_facets_own_of(o->solid, all.triangle[i].wall, all.triangle[i].face);
            if (own.r >= 0 || o->glass) wall_facets_add(g, own, x[0], x[1], x[2]);
        }
    } else
        failure_set(failure, EX_SOFTWARE, "no memory for the facets of the walls");
    outline_free(&all);
    return failure->status;
}

void glass_free(struct glass *g)
{
    free(g->facet);
    *g = (struct glass){ 0 };
}
