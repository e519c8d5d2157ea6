#include "draw/facets.h"

#include "draw/ray.h"

#include <stdlib.h>

enum {
    DISC = 48,                         /* corners: no angle is seen at the size of a page */
    CORNERS_MOST = SHAPE_VERTICES_MOST /* of a face */
};

static vec3 facets_unit(vec3 a)
{
    return v3_scale(1 / v3_norm(a), a);
}

/* The icosahedron: its corners are those of three rectangles of the golden ratio. */
static void icosahedron(struct facets_triangle t[20])
{
    const double g = (1 + sqrt(5)) / 2;
    const vec3 x[12] = { { -1, g, 0 }, { 1, g, 0 }, { -1, -g, 0 }, { 1, -g, 0 },
                         { 0, -1, g }, { 0, 1, g }, { 0, -1, -g }, { 0, 1, -g },
                         { g, 0, -1 }, { g, 0, 1 }, { -g, 0, -1 }, { -g, 0, 1 } };
    static const int face[20][3] = { { 0, 11, 5 },  { 0, 5, 1 },  { 0, 1, 7 },  { 0, 7, 10 },
                                     { 0, 10, 11 }, { 1, 5, 9 },  { 5, 11, 4 }, { 11, 10, 2 },
                                     { 10, 7, 6 },  { 7, 1, 8 },  { 3, 9, 4 },  { 3, 4, 2 },
                                     { 3, 2, 6 },   { 3, 6, 8 },  { 3, 8, 9 },  { 4, 9, 5 },
                                     { 2, 4, 11 },  { 6, 2, 10 }, { 8, 6, 7 },  { 9, 8, 1 } };
    for (int k = 0; k < 20; k++)
        for (int c = 0; c < 3; c++) t[k].corner[c] = facets_unit(x[face[k][c]]);
}

static void divide(const struct facets_triangle *t, struct facets_triangle out[4])
{
    const vec3 a = t->corner[0], b = t->corner[1], c = t->corner[2];
    const vec3 ab = facets_unit(v3_add(a, b)), bc = facets_unit(v3_add(b, c)),
               ca = facets_unit(v3_add(c, a));
    out[0] = (struct facets_triangle){ { a, ab, ca } },
    out[1] = (struct facets_triangle){ { ab, b, bc } };
    out[2] = (struct facets_triangle){ { ca, bc, c } },
    out[3] = (struct facets_triangle){ { ab, bc, ca } };
}

int facets_init(struct facets *b, int detail, struct failure *failure)
{
    b->n = 20;
    for (int k = 0; k < detail; k++) b->n *= 4;
    b->t = malloc((size_t)b->n * sizeof *b->t);
    if (!b->t) return failure_set(failure, EX_SOFTWARE, "no memory for triangles");
    icosahedron(b->t);
    // from the last on, so that no triangle is overwritten before it is divided
    for (int64_t n = 20; n < b->n; n *= 4)
        for (int64_t k = n - 1; k >= 0; k--) {
            struct facets_triangle whole = b->t[k];
            divide(&whole, b->t + 4 * k);
        }
    return 0;
}

void facets_free(struct facets *b)
{
    free(b->t);
    *b = (struct facets){ 0 };
}

/* Where polygons go */
struct facets_sink {
    facets_text *put;
    void *to;
};

static void put_ball(const struct facets_sink *out, vec3 x0, double r, quat q,
                     const struct facets *b)
{
    for (int64_t k = 0; k < b->n; k++) {
        vec3 x[3];
        for (int c = 0; c < 3; c++) x[c] = v3_axpy(x0, r, quat_turn(q, b->t[k].corner[c]));
        out->put(out->to, 3, x);
    }
}

static void put_disc(const struct facets_sink *out, vec3 x, double r)
{
    vec3 last = v3_add(x, v3(r, 0, 0));
    for (int k = 1; k <= DISC; k++) {
        double angle = 2 * M_PI * k / DISC;
        vec3 next = v3_axpy(x, r, v3(cos(angle), sin(angle), 0));
        out->put(out->to, 3, (const vec3[]){ x, last, next });
        last = next;
    }
}

/* Where a ray from the centre of a shape leaves it */
static vec3 leaves(const struct shape *s, int dim, vec3 along)
{
    const struct ray ray = { { 0, 0, 0 }, along, INFINITY };
    vec3 n;
    double t = 0, lo = 0, hi = 1;
    if (dim == 3) return ray_meets(s, &ray, &t, &n) ? v3_scale(t, along) : v3(0, 0, 0);
    for (int k = 0; k < 50; k++) {
        t = 0.5 * (lo + hi);
        *(ray_depth(s, v3_scale(t, along)) > 0 ? &lo : &hi) = t;
    }
    return v3_scale(t, along);
}

/* A place of grain i, given in the unit and axes of its shape */
static vec3 placed(const struct packing *p, int64_t i, vec3 v)
{
    return v3_axpy(p->x[i], p->radius[i], quat_turn(p->q[i], v));
}

static void put_faces(const struct facets_sink *out, const struct packing *p, int64_t i,
                      const struct shape *s)
{
    vec3 x[CORNERS_MOST];
    for (int32_t f = 0; f < s->faces; f++) {
        int n = 0;
        for (int32_t k = s->first[f]; k < s->first[f + 1] && n < CORNERS_MOST; k++)
            x[n++] = placed(p, i, s->vertex[s->corner[k]]);
        out->put(out->to, n, x);
    }
}

static void put_clump(const struct facets_sink *out, const struct packing *p, int64_t i,
                      const struct shape *s, const struct facets *b)
{
    for (int32_t k = 0; k < s->vertices; k++) {
        vec3 x = placed(p, i, s->vertex[k]);
        double r = p->radius[i] * s->ball[k];
        if (p->dim == 2)
            put_disc(out, x, r);
        else
            put_ball(out, x, r, p->q[i], b);
    }
}

static void put_rounded(const struct facets_sink *out, const struct packing *p, int64_t i,
                        const struct shape *s, const struct facets *b)
{
    vec3 x[3];
    for (int64_t k = 0; k < b->n && p->dim == 3; k++) {
        for (int c = 0; c < 3; c++) x[c] = placed(p, i, leaves(s, 3, b->t[k].corner[c]));
        out->put(out->to, 3, x);
    }
    for (int k = 0; k < DISC && p->dim == 2; k++) {
        double one = 2 * M_PI * k / DISC, next = 2 * M_PI * (k + 1) / DISC;
        x[0] = p->x[i];
        x[1] = placed(p, i, leaves(s, 2, v3(cos(one), sin(one), 0)));
        x[2] = placed(p, i, leaves(s, 2, v3(cos(next), sin(next), 0)));
        out->put(out->to, 3, x);
    }
}

void facets_of(const struct facets *b, const struct packing *p, int64_t i, facets_text *put,
               void *to)
{
    const struct shape *s = packing_shape(p, i);
    const struct facets_sink out = { put, to };
    if (!s && p->dim == 2)
        put_disc(&out, p->x[i], p->radius[i]);
    else if (!s)
        put_ball(&out, p->x[i], p->radius[i], p->q[i], b);
    else if (shape_is_union(s))
        put_clump(&out, p, i, s, b);
    else if (facets_are_faces(s))
        put_faces(&out, p, i, s);
    else
        put_rounded(&out, p, i, s, b);
}

int64_t facets_triangles(const struct facets *b, const struct packing *p, int64_t i)
{
    const struct shape *s = packing_shape(p, i);
    int64_t round = p->dim == 2 ? DISC : b->n;
    if (s && facets_are_faces(s)) return s->first[s->faces] - 2 * (int64_t)s->faces;
    return s ? round * shape_parts(s) : round;
}
