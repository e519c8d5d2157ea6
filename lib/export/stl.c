/*
 * export/stl.c: a moment as triangles, binary STL, in m: balls as icosahedra whose faces are divided
 * into four `detail` times, turned as the grains are; boundaries as their polygons. In the plane
 * there are discs of 48 corners. Sharp hulls have the triangles of their faces, clumps those of their
 * balls; on rounded shapes the corners of the ball's triangles are moved along its radii.
 */
#include "draw/sight.h"
#include "export/format.h"
#include "export/sheet.h"

#include <stdlib.h>
#include <string.h>

enum { DISC = 48 /* corners: no angle is seen at the size of a page */ };

struct triangle {
    vec3 corner[3];
};

/* Triangles of the unit ball */
struct ball {
    int64_t n;
    struct triangle *t;
};

static vec3 unit(vec3 a)
{
    return v3_scale(1 / v3_norm(a), a);
}

/* The icosahedron: its corners are those of three rectangles of the golden ratio. */
static void icosahedron(struct triangle t[20])
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
        for (int c = 0; c < 3; c++) t[k].corner[c] = unit(x[face[k][c]]);
}

static void divide(const struct triangle *t, struct triangle out[4])
{
    const vec3 a = t->corner[0], b = t->corner[1], c = t->corner[2];
    const vec3 ab = unit(v3_add(a, b)), bc = unit(v3_add(b, c)), ca = unit(v3_add(c, a));
    out[0] = (struct triangle){ { a, ab, ca } }, out[1] = (struct triangle){ { ab, b, bc } };
    out[2] = (struct triangle){ { ca, bc, c } }, out[3] = (struct triangle){ { ab, bc, ca } };
}

static int ball_build(struct ball *b, int detail, struct why *why)
{
    b->n = 20;
    for (int k = 0; k < detail; k++) b->n *= 4;
    b->t = malloc((size_t)b->n * sizeof *b->t);
    if (!b->t) return why_set(why, EX_SOFTWARE, "no memory for triangles");
    icosahedron(b->t);
    // from the last on, so that no triangle is overwritten before it is divided
    for (int64_t n = 20; n < b->n; n *= 4)
        for (int64_t k = n - 1; k >= 0; k--) {
            struct triangle whole = b->t[k];
            divide(&whole, b->t + 4 * k);
        }
    return 0;
}

static void put_float(FILE *out, double x)
{
    float number = (float)x;
    uint32_t bits = 0;
    memcpy(&bits, &number, sizeof bits);
    for (int k = 0; k < 4; k++) putc((int)(bits >> 8 * k & 255), out);
}

static void put_vec(FILE *out, vec3 a)
{
    put_float(out, a.x), put_float(out, a.y), put_float(out, a.z);
}

static void put_triangle(FILE *out, vec3 a, vec3 b, vec3 c)
{
    vec3 n = v3_cross(v3_sub(b, a), v3_sub(c, a));
    double size = v3_norm(n);
    put_vec(out, size > 0 ? v3_scale(1 / size, n) : n);
    put_vec(out, a), put_vec(out, b), put_vec(out, c);
    putc(0, out), putc(0, out);
}

static void put_ball(FILE *out, vec3 x0, double r, quat q, const struct ball *b)
{
    for (int64_t k = 0; k < b->n; k++) {
        vec3 x[3];
        for (int c = 0; c < 3; c++) x[c] = v3_axpy(x0, r, quat_turn(q, b->t[k].corner[c]));
        put_triangle(out, x[0], x[1], x[2]);
    }
}

static void put_disc(FILE *out, vec3 x, double r)
{
    vec3 last = v3_add(x, v3(r, 0, 0));
    for (int k = 1; k <= DISC; k++) {
        double angle = 2 * M_PI * k / DISC;
        vec3 next = v3_axpy(x, r, v3(cos(angle), sin(angle), 0));
        put_triangle(out, x, last, next);
        last = next;
    }
}

/* ---- other shapes ---- */

/* Where a ray from the centre of a shape leaves it */
static vec3 leaves(const struct shape *s, int dim, vec3 along)
{
    const struct sight ray = { { 0, 0, 0 }, along, INFINITY };
    vec3 n;
    double t = 0, lo = 0, hi = 1;
    if (dim == 3) return sight_meets(s, &ray, &t, &n) ? v3_scale(t, along) : v3(0, 0, 0);
    for (int k = 0; k < 50; k++) {
        t = 0.5 * (lo + hi);
        *(sight_depth(s, v3_scale(t, along)) > 0 ? &lo : &hi) = t;
    }
    return v3_scale(t, along);
}

static bool is_sharp(const struct shape *s)
{
    return s->form == SHAPE_HULL && s->round == 0;
}

/* How many triangles a grain has */
static int64_t grain_triangles(const struct packing *p, int64_t i, const struct ball *b)
{
    const struct shape *s = packing_shape(p, i);
    int64_t round = p->dim == 2 ? DISC : b->n;
    if (!s) return round;
    if (s->form == SHAPE_CLUMP) return s->vertices * round;
    return is_sharp(s) ? s->corners - 2 * s->faces : round;
}

static void put_shape(FILE *out, const struct packing *p, int64_t i, const struct ball *b)
{
    const struct shape *s = packing_shape(p, i);
    double r = p->radius[i];
    quat q = p->q[i];
#define PLACED(v) v3_axpy(p->x[i], r, quat_turn(q, v))
    for (int32_t f = 0; f < s->faces && is_sharp(s); f++)
        for (int32_t k = s->first[f] + 2; k < s->first[f + 1]; k++)
            put_triangle(out, PLACED(s->vertex[s->corner[s->first[f]]]),
                         PLACED(s->vertex[s->corner[k - 1]]), PLACED(s->vertex[s->corner[k]]));
    for (int32_t k = 0; k < s->vertices && s->form == SHAPE_CLUMP; k++) {
        if (p->dim == 2)
            put_disc(out, PLACED(s->vertex[k]), r * s->ball[k]);
        else
            put_ball(out, PLACED(s->vertex[k]), r * s->ball[k], q, b);
    }
    if (is_sharp(s) || s->form == SHAPE_CLUMP) return;
    for (int64_t k = 0; k < b->n && p->dim == 3; k++) {
        vec3 x[3];
        for (int c = 0; c < 3; c++) x[c] = PLACED(leaves(s, 3, b->t[k].corner[c]));
        put_triangle(out, x[0], x[1], x[2]);
    }
    for (int k = 0; k < DISC && p->dim == 2; k++) {
        double one = 2 * M_PI * k / DISC, next = 2 * M_PI * (k + 1) / DISC;
        put_triangle(out, p->x[i], PLACED(leaves(s, 2, v3(cos(one), sin(one), 0))),
                     PLACED(leaves(s, 2, v3(cos(next), sin(next), 0))));
    }
#undef PLACED
}

static void put_grain(FILE *out, const struct packing *p, int64_t i, const struct ball *b)
{
    if (packing_shape(p, i))
        put_shape(out, p, i, b);
    else if (p->dim == 2)
        put_disc(out, p->x[i], p->radius[i]);
    else
        put_ball(out, p->x[i], p->radius[i], p->q[i], b);
}

/* A convex polygon, as a fan */
static void put_polygons(FILE *out, const struct sheet *s)
{
    int64_t first = 0;
    for (int64_t k = 0; k < s->cells; first = s->end[k++])
        for (int64_t c = first + 1; c + 1 < s->end[k]; c++)
            put_triangle(out, s->x[s->corner[first]], s->x[s->corner[c]], s->x[s->corner[c + 1]]);
}

static int64_t polygon_triangles(const struct sheet *s)
{
    int64_t n = 0, first = 0;
    for (int64_t k = 0; k < s->cells; first = s->end[k++])
        if (s->end[k] - first > 2) n += s->end[k] - first - 2;
    return n;
}

static int stl(FILE *out, const struct moment *m, enum part part, bool first, struct why *why)
{
    const struct packing *p = m->packing;
    struct ball b = { 0 };
    struct sheet walls;
    (void)first;
    if (part != PART_GRAINS && part != PART_BOUNDARY)
        return why_set(why, EX_USAGE, "%s cannot be made of triangles", part_name[part]);
    if (ball_build(&b, m->detail, why) || sheet_of(&walls, PART_BOUNDARY, m, why)) {
        free(b.t);
        return why->status;
    }
    int64_t grains = part == PART_GRAINS ? p->n : 0;
    int64_t n = polygon_triangles(&walls);
    for (int64_t i = 0; i < grains; i++) n += grain_triangles(p, i, &b);
    if (n > UINT32_MAX) why_set(why, EX_DATAERR, "more triangles than STL can count");
    fprintf(out, "%-80s", "nsd: balls and walls in m");
    for (int k = 0; k < 4; k++) putc((int)(n >> 8 * k & 255), out);
    for (int64_t i = 0; i < grains && !why->status; i++) put_grain(out, p, i, &b);
    put_polygons(out, &walls);
    sheet_free(&walls);
    free(b.t);
    return why->status;
}

const struct format format_stl = {
    .name = "stl",
    .ending = "stl",
    .help = "triangles of balls and walls, a moment",
    .parts = true,
    .binary = true,
    .write = stl,
};
