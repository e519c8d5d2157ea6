/*
 * convert/stl.c: a moment as triangles, binary STL, in m: grains as draw/facets.h has them, walls
 * as their polygons.
 */
#include "convert/format.h"
#include "convert/sheet.h"
#include "draw/facets.h"

#include <stdlib.h>
#include <string.h>

static void put_float(FILE *out, double x)
{
    float number = (float)x;
    uint32_t bits = 0;
    memcpy(&bits, &number, sizeof bits);
    for (int k = 0; k < 4; k++) putc((int)(bits >> 8 * k & 255), out);
}

static void stl_put_vec(FILE *out, vec3 a)
{
    put_float(out, a.x), put_float(out, a.y), put_float(out, a.z);
}

static void stl_put_triangle(FILE *out, vec3 a, vec3 b, vec3 c)
{
    vec3 n = v3_cross(v3_sub(b, a), v3_sub(c, a));
    double size = v3_norm(n);
    stl_put_vec(out, size > 0 ? v3_scale(1 / size, n) : n);
    stl_put_vec(out, a), stl_put_vec(out, b), stl_put_vec(out, c);
    putc(0, out), putc(0, out);
}

/* A convex polygon of a grain, as a fan */
static void stl_put_fan(void *to, int corners, const vec3 *x)
{
    for (int k = 2; k < corners; k++) stl_put_triangle(to, x[0], x[k - 1], x[k]);
}

/* A convex polygon, as a fan */
static void put_polygons(FILE *out, const struct sheet *s)
{
    int64_t first = 0;
    for (int64_t k = 0; k < s->cells; first = s->end[k++])
        for (int64_t c = first + 1; c + 1 < s->end[k]; c++)
            stl_put_triangle(out, s->x[s->corner[first]], s->x[s->corner[c]],
                             s->x[s->corner[c + 1]]);
}

static int64_t polygon_triangles(const struct sheet *s)
{
    int64_t n = 0, first = 0;
    for (int64_t k = 0; k < s->cells; first = s->end[k++])
        if (s->end[k] - first > 2) n += s->end[k] - first - 2;
    return n;
}

static int stl(FILE *out, const struct export_frame *m, enum part part, bool first,
               struct failure *failure)
{
    const struct packing *p = m->packing;
    struct facets b;
    struct sheet walls;
    (void)first;
    if (part != PART_GRAINS && part != PART_WALLS)
        return failure_set(failure, EX_USAGE, "%s cannot be made of triangles", part_name[part]);
    if (facets_init(&b, m->detail, failure)) return failure->status;
    if (sheet_of(&walls, PART_WALLS, m, failure)) return facets_free(&b), failure->status;
    const int64_t grains = part == PART_GRAINS ? p->n : 0;
    int64_t n = polygon_triangles(&walls);
    for (int64_t i = 0; i < grains; i++)
        if (export_frame_has(m, i)) n += facets_triangles(&b, p, i);
    if (n > UINT32_MAX) failure_set(failure, EX_DATAERR, "more triangles than STL can count");
    fprintf(out, "%-80s", "nsd: balls and walls in m");
    for (int k = 0; k < 4; k++) putc((int)(n >> 8 * k & 255), out);
    for (int64_t i = 0; i < grains && !failure->status; i++) {
        moment_tell(m, i, grains);
        if (export_frame_has(m, i)) facets_of(&b, p, i, stl_put_fan, out);
    }
    put_polygons(out, &walls);
    sheet_free(&walls);
    facets_free(&b);
    return failure->status;
}

const struct format format_stl = {
    .name = "stl",
    .ending = "stl",
    .help = "triangles of balls and walls, one frame",
    .parts = true,
    .binary = true,
    .write = stl,
};
