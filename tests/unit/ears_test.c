/*
 * Polygons cut into triangles: the triangles of a polygon have its area, cover no place twice, and no corner
 * lies in one of them. The polygons are stars, spirals, combs and keyholes, with corners on straight sides,
 * turned in space and moved far from the origin. The area is known, or by the shoelace formula.
 */
#include "scene/ears.h"
#include "tap.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = POLYGON_CORNERS_MOST + 1 };

static vec3 x[MOST];
static double u[MOST], v[MOST]; /* the same in its plane */
static int32_t triangle[MOST][3];
static uint64_t state = 1;

static double draw(void)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 11) / 9007199254740992.0;
}

static void put(int32_t *n, double a, double b)
{
    u[*n] = a, v[(*n)++] = b;
}

/* Into space: the plane turned at random and moved */
static void place(int32_t n, double away)
{
    quat q = quat_unit((quat){ draw() - 0.5, draw() - 0.5, draw() - 0.5, draw() - 0.5 });
    vec3 o = v3(away * draw(), away * draw(), away * draw());
    for (int32_t i = 0; i < n; i++) x[i] = v3_add(o, quat_turn(q, v3(u[i], v[i], 0)));
}

static double area2(int32_t a, int32_t b, int32_t c)
{
    return (u[b] - u[a]) * (v[c] - v[a]) - (v[b] - v[a]) * (u[c] - u[a]);
}

/* What is wrong with the triangles of the polygon; "": nothing */
static const char *judge(int32_t n, double away)
{
    int64_t work = INT64_MAX;
    int32_t triangles;
    double area = 0, sum = 0, size = 0;
    place(n, away);
    const char *trouble = ears_cut(x, n, triangle, &triangles, &work);
    if (trouble) return trouble;
    if (triangles != n - 2) return "not n - 2 triangles";
    for (int32_t i = 0; i < n; i++)
        area += u[i] * v[(i + 1) % n] - v[i] * u[(i + 1) % n],
            size = fmax(size, fabs(u[i]) + fabs(v[i]));
    for (int32_t t = 0; t < triangles; t++) {
        const int32_t *c = triangle[t];
        double a = area2(c[0], c[1], c[2]), off = 1e-7 * size * size;
        sum += a;
        if (!(a > 0)) return "a triangle without an area, or turned over";
        for (int32_t i = 0; i < n && n < 300; i++)
            if (area2(c[0], c[1], i) > off && area2(c[1], c[2], i) > off &&
                area2(c[2], c[0], i) > off)
                return "a corner within a triangle";
    }
    return fabs(sum - area) < 1e-9 * size * size
               ? ""
               : "the areas of the triangles are not that of the polygon";
}

static void star(int32_t *n, int32_t corners, double least)
{
    for (int32_t k = 0; k < corners; k++) {
        double r = least + (1 - least) * draw(), a = 2 * M_PI * k / corners;
        put(n, r * cos(a), r * sin(a));
    }
}

/* A comb: teeth of width 1 and gaps of width 1, each side cut in `parts` */
static void comb(int32_t *n, int32_t teeth, int32_t parts)
{
    for (int32_t k = 0; k < 2 * teeth * parts; k++) put(n, (double)k / parts, 0);
    for (int32_t t = teeth - 1; t >= 0; t--) {
        put(n, 2 * t + 1, 5), put(n, 2 * t, 5);
        if (t) put(n, 2 * t, 1), put(n, 2 * t - 1, 1);
    }
}

static void spiral(int32_t *n, int32_t corners)
{
    for (int32_t k = 0; k < corners; k++)
        put(n, (1 + 0.1 * k) * cos(0.3 * k), (1 + 0.1 * k) * sin(0.3 * k));
    for (int32_t k = corners - 1; k >= 0; k--)
        put(n, (0.5 + 0.1 * k) * cos(0.3 * k), (0.5 + 0.1 * k) * sin(0.3 * k));
}

/* A square with a square hole, joined by a cut that is gone along twice */
static void keyhole(int32_t *n)
{
    static const double at[10][2] = { { 0, 0 }, { 4, 0 }, { 4, 4 }, { 0, 4 }, { 0, 0 },
                                      { 1, 1 }, { 1, 3 }, { 3, 3 }, { 3, 1 }, { 1, 1 } };
    for (int k = 0; k < 10; k++) put(n, at[k][0], at[k][1]);
}

static void shapes(void)
{
    const char *trouble = "";
    int32_t n;
    for (int k = 0; k < 300 && !*trouble; k++)
        n = 0, star(&n, 3 + k % 50, 0.05), trouble = judge(n, k % 2 ? 5e6 : 0);
    ok(!*trouble, "stars at random are cut, near the origin and far from it %s", trouble);
    trouble = "";
    for (int k = 1; k < 20 && !*trouble; k++) n = 0, comb(&n, k, 1 + k % 4), trouble = judge(n, 0);
    ok(!*trouble, "combs, with corners on straight sides %s", trouble);
    trouble = "";
    for (int k = 10; k < 200 && !*trouble; k += 10) n = 0, spiral(&n, k), trouble = judge(n, 10);
    ok(!*trouble, "spirals %s", trouble);
    n = 0, keyhole(&n), trouble = judge(n, 0);
    ok(!*trouble, "a square with a hole %s", trouble);
    n = 0, star(&n, 4096, 1), trouble = judge(n, 1);
    ok(!*trouble, "a regular polygon of 4096 corners %s", trouble);
    n = 0, star(&n, 4096, 0.5), trouble = judge(n, 1);
    ok(!*trouble, "a star of 4096 corners %s", trouble);
}

/* The same flat polygon with its corners off the plane by `bent` */
static const char *bend(double bent, int32_t *triangles)
{
    int64_t work = 1000;
    int32_t n = 0;
    put(&n, 0, 0), put(&n, 1, 0), put(&n, 1, 1), put(&n, 0, 1);
    place(n, 0);
    vec3 normal = v3_cross(v3_sub(x[1], x[0]), v3_sub(x[2], x[0]));
    for (int32_t i = 0; i < n; i++) x[i] = v3_axpy(x[i], i % 2 ? bent : -bent, normal);
    return ears_cut(x, n, triangle, triangles, &work);
}

static const char *cut(int32_t n, const double (*at)[2], int64_t work, int32_t *triangles)
{
    for (int32_t i = 0; i < n; i++) x[i] = v3(at[i][0], at[i][1], 0);
    return ears_cut(x, n, triangle, triangles, &work);
}

static void refusals(void)
{
    static const double bow[][2] = { { 0, 0 }, { 1, 1 }, { 1, 0 }, { 0, 1 } };
    static const double loop[][2] = { { 0, 0 }, { 4, 0 }, { 4, 2 }, { 1, -1 }, { 0, 2 } };
    static const double line[][2] = { { 0, 0 }, { 1, 1 }, { 3, 3 }, { 2, 2 } };
    static const double dent[][2] = { { 0, 0 }, { 2, 0 }, { 0.5, 0.5 }, { 0, 2 } };
    double pentagram[5][2];
    for (int k = 0; k < 5; k++)
        pentagram[k][0] = cos(0.8 * M_PI * k), pentagram[k][1] = sin(0.8 * M_PI * k);
    int32_t n;
    ok(cut(4, bow, 100, &n) && cut(5, loop, 100, &n) &&
           cut(5, (const double(*)[2])pentagram, 100, &n),
       "what crosses itself is refused: a bow, a loop, a pentagram");
    ok(!cut(4, line, 100, &n) && !n, "of corners on a line there are no triangles");
    ok(!cut(4, dent, 100, &n) && n == 2 && cut(4, dent, 15, &n),
       "work is counted: of a concave polygon n^2");
    ok(!bend(1e-3, &n) && n == 2 && bend(0.1, &n),
       "a quadrilateral may be bent a little, not much");
    ok(ears_cut(x, MOST, triangle, &n, &(int64_t){ INT64_MAX }),
       "a polygon of 4097 corners is too much");
}

int main(void)
{
    shapes();
    refusals();
    return tap_done();
}
