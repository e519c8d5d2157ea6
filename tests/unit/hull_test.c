/*
 * Hulls of points with noise: each corner of a body given several times, each time a little elsewhere, from 1e-16
 * to 1e-2 of its size; bodies turned, moved and scaled. Their volumes are known. The hull must be one that a shape
 * accepts, with that volume to the noise, and the faces of the body where noise is below 1e-8.
 */
#include "scene/hull.h"
#include "shape/solid.h"
#include "tap.h"

#include <string.h>

enum { MOST = 4000 };

static vec3 x[MOST];
static uint64_t state = 1;

static double draw(void)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 11) / 9007199254740992.0 - 0.5;
}

struct body {
    const char *name;
    int dim, faces, vertices;
    double volume;
    int (*points)(vec3 *out);
};

static int grid(vec3 *out, int n, double a, double b, double c)
{
    int m = 0;
    for (int k = 0; k < n * n * n; k++)
        out[m++] = v3(a * (k % n) / (n - 1), b * (k / n % n) / (n - 1), c * (k / n / n) / (n - 1));
    return m;
}

static int cube(vec3 *out)
{
    return grid(out, 2, 1, 1, 1);
}
static int cube_of_cubes(vec3 *out)
{
    return grid(out, 6, 1, 1, 1);
}
static int needle(vec3 *out)
{
    return grid(out, 2, 1, 0.01, 0.02);
}
static int plate(vec3 *out)
{
    return grid(out, 3, 1, 1, 1e-3);
}

static int tetrahedron(vec3 *out)
{
    out[0] = v3(0, 0, 0), out[1] = v3(1, 0, 0), out[2] = v3(0, 1, 0), out[3] = v3(0, 0, 1);
    return 4;
}

static int dodecahedron(vec3 *out)
{
    const double g = (1 + sqrt(5)) / 2;
    int n = 0;
    for (int k = 0; k < 8; k++) out[n++] = v3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    for (int k = 0; k < 4; k++) {
        double a = k & 1 ? 1 / g : -1 / g, b = k & 2 ? g : -g;
        out[n++] = v3(0, a, b), out[n++] = v3(a, b, 0), out[n++] = v3(b, 0, a);
    }
    return n;
}

static int prism(vec3 *out)
{
    for (int k = 0; k < 48; k++)
        out[k] = v3(cos(M_PI * (k / 2) / 12), sin(M_PI * (k / 2) / 12), k % 2);
    return 48;
}

static int square(vec3 *out)
{
    for (int k = 0; k < 25; k++) out[k] = v3(k % 5 / 4.0, k / 5 / 4.0, 0);
    return 25;
}

static int disc(vec3 *out)
{
    for (int k = 0; k < 36; k++) out[k] = v3(cos(M_PI * k / 18), sin(M_PI * k / 18), 0);
    return 36;
}

static struct body bodies[] = {
    { "a cube", 3, 6, 8, 1, cube },
    { "a cube with points on its sides and in it", 3, 6, 8, 1, cube_of_cubes },
    { "a needle", 3, 6, 8, 2e-4, needle },
    { "a plate", 3, 6, 8, 1e-3, plate },
    { "a tetrahedron", 3, 4, 4, 1.0 / 6, tetrahedron },
    { "a dodecahedron", 3, 12, 20, 0, dodecahedron },
    { "a prism of 24 sides", 3, 26, 48, 0, prism },
    { "a square of points", 2, 1, 4, 1, square },
    { "a polygon of 36 sides", 2, 1, 36, 0, disc },
};

/* Several times the points of a body, with noise */
static int scatter(const struct body *b, int times, double noise, double scale, double away)
{
    vec3 point[250];
    int n = 0, m = b->points(point);
    quat q =
        b->dim == 2 ? (quat){ 1, 0, 0, 0 } : quat_unit((quat){ draw(), draw(), draw(), draw() });
    vec3 o = v3(away * draw(), away * draw(), b->dim == 2 ? 0 : away * draw());
    for (int k = 0; k < times * m; k++) {
        vec3 d = v3(noise * draw(), noise * draw(), b->dim == 2 ? 0 : noise * draw());
        x[n++] = v3_add(o, v3_scale(scale, quat_turn(q, v3_add(point[k % m], d))));
    }
    return n;
}

/* The volume, in units of scale; what is wrong is in why. */
static double volume_of(struct shape *s, int dim, int n, double scale, struct failure *failure)
{
    struct solid_frame was;
    *s = (struct shape){ .form = SHAPE_HULL };
    if (hull_of_points(s, dim, n, x, failure) || solid_settle(s, dim, &was, failure) ||
        shape_finish(s, dim, failure))
        return NAN;
    return s->volume * pow(was.reach / scale, dim);
}

static void noisy(const struct body *b)
{
    int failed = 0, coarse = 0, cut = 0;
    char said[sizeof((struct failure *)0)->text] = "";
    for (int e = -16; e <= -2; e++)
        for (int k = 0; k < 6; k++) {
            struct shape s;
            struct failure failure = { 0 };
            double noise = pow(10, e), scale = k % 3 ? 1 : 1e-3, least = fmin(1, b->volume);
            int n = scatter(b, 1 + k, noise, scale, k % 2 ? 10 * scale : 0);
            double volume = volume_of(&s, b->dim, n, scale, &failure);
            if (noise < 1e-4 * least || failure.status == EX_SOFTWARE) {
                failed += failure.status != 0;
                coarse += !(fabs(volume / b->volume - 1) < 1e-9 + 30 * noise / least);
                cut += noise < 1e-8 && s.faces != b->faces;
                cut += noise < 1e-8 && s.vertices != b->vertices;
            }
            if (failure.status) strcpy(said, failure.text);
            shape_free(&s);
        }
    ok(!failed, "%s with noise up to 1e-4 has a hull %s", b->name, said);
    ok(!coarse, "  with its volume");
    ok(!cut, "  and its %d faces and %d corners, as long as noise is below 1e-8", b->faces,
       b->vertices);
}

/* More than faces are flat to, less than corners are apart */
static void welded(void)
{
    int more = 0;
    for (int k = 0; k < 50; k++) {
        struct shape s;
        struct failure failure = { 0 };
        volume_of(&s, 3, scatter(&bodies[0], 6, 6e-7, 1, k % 2 ? 10 : 0), 1, &failure);
        more += failure.status || s.vertices != 8;
        shape_free(&s);
    }
    ok(!more, "with noise of 6e-7 a cube has 8 corners, too");
}

static void far_away(void)
{
    struct shape s;
    struct failure failure = { 0 };
    vec3 o = v3(500000.2, 4649776.4, 312.7);
    int n = cube(x);
    for (int i = 0; i < n; i++) x[i] = v3_axpy(o, 1.3, x[i]);
    ok(fabs(volume_of(&s, 3, n, 1, &failure) / 2.197 - 1) < 1e-9 &&
           fabs(s.moment[0] - s.moment[1]) < 1e-9 && fabs(s.moment[0] - 2.0 / 9) < 1e-9,
       "a cube in map coordinates has its volume and moments %s", failure.text);
    shape_free(&s);
}

static void none(void)
{
    struct shape s;
    struct failure one = { 0 }, two = { 0 }, three = { 0 };
    for (int k = 0; k < 100; k++) x[k] = v3(draw(), draw(), 0);
    volume_of(&s, 3, 100, 1, &one), shape_free(&s);
    for (int k = 0; k < 100; k++) x[k] = v3(k, 2 * k, 3 * k);
    volume_of(&s, 3, 100, 1, &two), shape_free(&s);
    for (int k = 0; k < 100; k++) x[k] = v3(1, 2, 3);
    volume_of(&s, 3, 100, 1, &three), shape_free(&s);
    ok(one.status == EX_DATAERR && two.status == EX_DATAERR && three.status == EX_DATAERR,
       "points in a plane, on a line and in one place have none: %s", one.text);
}

int main(void)
{
    const double g = (1 + sqrt(5)) / 2;
    bodies[5].volume = (15 + 7 * sqrt(5)) / 4 * pow(2 / g, 3);
    bodies[6].volume = 12 * sin(M_PI / 12), bodies[8].volume = 18 * sin(M_PI / 18);
    for (size_t k = 0; k < sizeof bodies / sizeof bodies[0]; k++) noisy(&bodies[k]);
    welded();
    far_away();
    none();
    return tap_done();
}
