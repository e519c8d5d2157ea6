/*
 * Hulls cut into the Voronoi pieces of points: each piece is a shape, volumes and moments sum to those of the hull, and a
 * place in the hull is in the piece of the nearest point and in no other. What lies inside a ball is inside it.
 */
#include "base/random.h"
#include "scene/hull.h"
#include "shape/fracture.h"
#include "tap.h"

#include <math.h>

static struct failure failure;

/* A hull in its own axes, as grains have them */
static void settle(struct shape *s, int dim)
{
    struct solid_frame was;
    if (solid_settle(s, dim, &was, &failure) || shape_finish(s, dim, &failure))
        diag("%s", failure.text);
}

static int brick(vec3 *x)
{
    for (int k = 0; k < 8; k++) x[k] = v3(k & 1 ? 3 : 0, k & 2 ? 2 : 0, k & 4 ? 1 : 0);
    return 8;
}

static int tetrahedron(vec3 *x)
{
    x[0] = v3(0, 0, 0), x[1] = v3(1, 0, 0), x[2] = v3(0, 1, 0), x[3] = v3(0, 0, 1);
    return 4;
}

static int polygon(vec3 *x)
{
    for (int k = 0; k < 7; k++) x[k] = v3(3 * cos(k), sin(k), 0);
    return 7;
}

/* Is x in a piece, to rounding? */
static bool holds(const struct shape *s, int dim, vec3 x, double slack)
{
    for (int32_t f = 0; f < s->faces; f++)
        for (int32_t i = s->first[f], end = s->first[f + 1]; i < end; i++) {
            const vec3 a = s->vertex[s->corner[i]],
                       b = s->vertex[s->corner[i + 1 < end ? i + 1 : s->first[f]]];
            const vec3 c = s->vertex[s->corner[i + 2 < end ? i + 2 : s->first[f] + i + 2 - end]];
            const vec3 n =
                dim == 2 ? v3(b.y - a.y, a.x - b.x, 0) : v3_cross(v3_sub(b, a), v3_sub(c, b));
            if (v3_dot(n, v3_sub(x, a)) > slack * v3_norm(n)) return false;
        }
    return true;
}

/* Relative to the hull's: how far the sums of the pieces' volumes and moments are from them */
static double missing(const struct shape *piece, int n, const struct shape *hull, int dim)
{
    struct solid whole, part;
    double volume = 0, second[3][3] = { { 0 } }, off = 0;
    vec3 first = v3(0, 0, 0);
    solid_of(&whole, hull, dim, &failure);
    for (int k = 0; k < n; k++) {
        solid_of(&part, &piece[k], dim, &failure);
        const vec3 d = v3_sub(part.centre, whole.centre);
        const double x[3] = { d.x, d.y, d.z };
        volume += part.volume, first = v3_axpy(first, part.volume, d);
        for (int i = 0; i < 9; i++)
            second[i / 3][i % 3] += part.second[i / 3][i % 3] + part.volume * x[i / 3] * x[i % 3];
    }
    off = fmax(fabs(volume - whole.volume), v3_norm(first)) / whole.volume;
    const double trace = whole.second[0][0] + whole.second[1][1] + whole.second[2][2];
    for (int i = 0; i < 9; i++)
        off = fmax(off, fabs(second[i / 3][i % 3] - whole.second[i / 3][i % 3]) / trace);
    return off;
}

/* Places that are not in the piece of their nearest point, or in another one as well */
static int misplaced(const struct shape *piece, int n, const vec3 *point, const struct shape *hull,
                     int dim, gsl_rng *rng)
{
    vec3 x[200];
    int bad = 0;
    fracture_draw(x, 200, hull, dim, rng);
    for (int i = 0; i < 200; i++) {
        int nearest = 0, in = 0;
        for (int k = 1; k < n; k++)
            if (v3_norm(v3_sub(x[i], point[k])) < v3_norm(v3_sub(x[i], point[nearest])))
                nearest = k;
        for (int k = 0; k < n; k++) in += holds(&piece[k], dim, x[i], -1e-9);
        bad += in > 1 || !holds(&piece[nearest], dim, x[i], 1e-9);
    }
    return bad;
}

static void check_cuts(const char *name, const struct shape *hull, int dim)
{
    static const int counts[] = { 1, 2, 8, FRACTURE_MOST };
    struct shape piece[FRACTURE_MOST];
    vec3 point[FRACTURE_MOST];
    gsl_rng *rng = counter_alloc();
    double off = 0;
    int bad = 0, failed = 0;
    for (int c = 0; c < 4; c++)
        for (uint64_t seed = 0; seed < 30; seed++) {
            const int n = counts[c];
            counter_start(rng, seed, COUNTER_FRACTURE, 0, 0, 0);
            fracture_draw(point, n, hull, dim, rng);
            if (fracture_cut(piece, n, point, hull, dim, &failure)) {
                failed++, failure = (struct failure){ 0 };
                continue;
            }
            off = fmax(off, missing(piece, n, hull, dim));
            bad += misplaced(piece, n, point, hull, dim, rng);
            for (int k = 0; k < n; k++) settle(&piece[k], dim);
            fracture_free(piece, n);
        }
    ok(!failed && !failure.status, "%s: all of 120 cuts have pieces that are shapes", name);
    ok(off < 1e-13, "%s: volumes and moments of pieces sum to the hull's, to %.1e", name, off);
    ok(!bad, "%s: a place is in the piece of the nearest point and in no other", name);
    failure = (struct failure){ 0 };
    gsl_rng_free(rng);
}

static void check_hull(const char *name, int dim, int (*points)(vec3 *x))
{
    struct shape s = { .form = SHAPE_HULL };
    vec3 x[16];
    if (hull_of_points(&s, dim, points(x), x, &failure)) diag("%s", failure.text);
    settle(&s, dim);
    check_cuts(name, &s, dim);
    shape_free(&s);
}

static void check_inscribed(int dim)
{
    struct shape s = { .form = SHAPE_HULL };
    double most = 0, least = INFINITY, volume;
    fracture_inscribe(&s, dim, &failure);
    for (int32_t i = 0; i < s.vertices; i++)
        most = fmax(most, v3_norm(s.vertex[i])), least = fmin(least, v3_norm(s.vertex[i]));
    settle(&s, dim);
    // 24 triangles of the polygon; the polyhedron of two frequencies, by its coordinates
    volume = s.volume / (dim == 2 ? M_PI : 4 * M_PI / 3);
    ok(!failure.status && most - least < 1e-15 && fabs(most - 1) < 1e-15,
       "%dD: what is inscribed in a ball has all corners on it", dim);
    ok(dim == 2 ? fabs(volume - 12 * sin(M_PI / 12) / M_PI) < 1e-14 : fabs(volume - 0.8735) < 1e-3,
       "%dD: it has %.4f of its volume", dim, volume);
    check_cuts(dim == 2 ? "inscribed polygon" : "inscribed polyhedron", &s, dim);
    shape_free(&s);
}

static void check_balls(int dim)
{
    vec3 x[FRACTURE_BALLS];
    int n = fracture_balls(x, dim);
    bool apart = true, inside = true;
    for (int i = 0; i < n; i++) {
        inside = inside && v3_norm(x[i]) + 1. / 3 < 1 + 1e-15;
        for (int j = 0; j < i; j++) apart = apart && v3_norm(v3_sub(x[i], x[j])) > 2. / 3 - 1e-15;
    }
    ok(n == (dim == 2 ? 7 : 13) && apart && inside, "%dD: %d balls of a third lie in a ball, apart",
       dim, n);
}

int main(void)
{
    check_hull("brick", 3, brick);
    check_hull("tetrahedron", 3, tetrahedron);
    check_hull("polygon", 2, polygon);
    for (int dim = 2; dim <= 3; dim++) check_inscribed(dim), check_balls(dim);
    return tap_done();
}
