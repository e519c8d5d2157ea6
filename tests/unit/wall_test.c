/* What must hold of walls: the nearest place of each shape by a search over its surface, meshes by
   all of their triangles, motions by finite differences, and motion on them by closed solutions. */
#include "contact/detect.h"
#include "shape/mesh.h"
#include "step/move.h"
#include "step/step.h"
#include "tap.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.141592653589793

static gsl_rng *rng;

static void must(int failed, struct failure *failure)
{
    if (!failed) return;
    printf("Bail out! %s\n", failure->text);
    exit(1);
}

static double draw(double lo, double hi)
{
    return lo + (hi - lo) * gsl_rng_uniform(rng);
}

static vec3 draw_unit(void)
{
    vec3 a;
    do a = v3(draw(-1, 1), draw(-1, 1), draw(-1, 1));
    while (v3_norm(a) < 0.1 || v3_norm(a) > 1);
    return v3_scale(1 / v3_norm(a), a);
}

/* ---- shapes ---- */

/* The surface in its own frame: the axis is z, the direction x */
static vec3 surface_point(const struct wall *w, double u, double v)
{
    const double *s = w->size;
    double angle = (w->arc > 0 ? w->arc : 2 * PI) * u, rho = s[0], z = v * s[2];
    switch (w->shape) {
    case WALL_RECTANGLE:
        return v3((u - 0.5) * s[0], (v - 0.5) * s[1], 0);
    case WALL_DISC:
        rho = s[0] + v * (s[1] - s[0]), z = 0;
        break;
    case WALL_CONE:
        rho = s[0] + v * (s[1] - s[0]);
        break;
    case WALL_SPHERE:
        rho = s[0] * sin(PI * v), z = s[0] * cos(PI * v);
        break;
    default:
        if (s[2] == 0) z = 20 * (v - 0.5);
    }
    return v3(rho * cos(angle), rho * sin(angle), z);
}

/* The least distance, by a grid that closes in on its best point from several of its cells */
static double search(const struct wall *w, vec3 c)
{
    enum { N = 60 };
    double best = INFINITY, bu = 0, bv = 0, lo[2] = { 0, 0 }, hi[2] = { 1, 1 };
    bool closed = w->shape != WALL_RECTANGLE && w->arc == 0; // in u
    for (int round = 0; round < 12; round++) {
        for (int i = 0; i <= N; i++)
            for (int j = 0; j <= N; j++) {
                double u = lo[0] + (hi[0] - lo[0]) * i / N, v = lo[1] + (hi[1] - lo[1]) * j / N;
                double d = v3_norm(v3_sub(c, surface_point(w, u, v)));
                if (d < best) best = d, bu = u, bv = v;
            }
        double wide[2] = { 0.15 * (hi[0] - lo[0]), 0.15 * (hi[1] - lo[1]) };
        lo[0] = fmax(bu - wide[0], closed ? -1 : 0), hi[0] = fmin(bu + wide[0], closed ? 2 : 1);
        lo[1] = fmax(bv - wide[1], 0), hi[1] = fmin(bv + wide[1], 1);
    }
    return best;
}

/* Wall k of the kinds tried, with axis n and direction `along` in space */
static struct wall draw_shape(int shape, bool sector)
{
    struct wall w = wall_plane(v3(0, 0, 0), draw_unit(), 0);
    vec3 e = draw_unit();
    w.along = v3_axpy(e, -v3_dot(e, w.n), w.n);
    w.along = v3_scale(1 / v3_norm(w.along), w.along);
    w.shape = shape, w.side = WALL_BOTH;
    for (int k = 0; k < 3; k++) w.size[k] = draw(0.3, 2);
    if (shape == WALL_DISC) w.size[1] = w.size[0] + draw(0.1, 1);
    if (shape == WALL_DISC && draw(0, 1) < 0.3) w.size[0] = 0;
    if (shape == WALL_CYLINDER && draw(0, 1) < 0.3) w.size[2] = 0;
    if (sector) w.arc = draw(0.2, 6);
    return w;
}

static void test_shapes(void)
{
    for (int shape = WALL_RECTANGLE; shape < WALL_MESH; shape++)
        for (int sector = 0; sector < 2; sector++) {
            if (sector && shape != WALL_CYLINDER && shape != WALL_CONE) continue;
            double off = 0, apart = 0;
            for (int k = 0; k < 60; k++) {
                struct wall w = draw_shape(shape, sector);
                vec3 in = v3_scale(draw(0, 3), draw_unit()), across = v3_cross(w.n, w.along);
                vec3 c = v3_axpy(v3_axpy(v3_scale(in.x, w.along), in.y, across), in.z, w.n);
                struct touch t;
                if (wall_shape_trouble(&w, 3) || !wall_nearest(&w, 3, c, 1, &t)) off = INFINITY;
                off = fmax(off, fabs(t.distance - search(&w, in)));
                vec3 place = v3_axpy(c, -t.distance, t.n);
                place = v3(v3_dot(place, w.along), v3_dot(place, across), v3_dot(place, w.n));
                apart = fmax(apart, search(&w, place));
            }
            ok(off < 1e-6 && apart < 1e-6, "%s%s: the nearest place, off by %.1g m",
               sector ? "sector of a " : "", wall_shape_name[shape], fmax(off, apart));
        }
}

static void test_sides(void)
{
    struct wall w = draw_shape(WALL_SPHERE, false);
    struct touch t;
    w.size[0] = 1, w.side = WALL_INSIDE;
    vec3 d = draw_unit();
    wall_nearest(&w, 3, v3_scale(1.25, d), 0.5, &t);
    ok(fabs(t.distance + 0.25) < 1e-15 && v3_dot(t.n, d) < -1 + 1e-12,
       "inside a sphere: a point outside is at a negative distance");
    w.side = WALL_OUTSIDE;
    wall_nearest(&w, 3, v3_scale(0.75, d), 0.5, &t);
    ok(fabs(t.distance + 0.25) < 1e-15 && v3_dot(t.n, d) > 1 - 1e-12, "outside: the reverse");
    w = draw_shape(WALL_CYLINDER, false);
    w.size[0] = 1, w.size[2] = 2, w.side = WALL_INSIDE;
    vec3 c = v3_axpy(v3_scale(1.25, w.along), 1, w.n);
    ok(wall_nearest(&w, 3, c, 0.3, &t) && !wall_nearest(&w, 3, c, 0.2, &t),
       "a ball that is wholly outside has left a tube that ends");
    w.size[2] = 0;
    ok(wall_nearest(&w, 3, c, 0.2, &t), "but not one without an end");
}

/* ---- meshes ---- */

/* n x n squares of two triangles over [0, 1]^2 at z = height */
static void sheet(struct mesh *m, int n, double (*height)(double, double))
{
    struct failure failure = { 0 };
    *m = (struct mesh){ 0 };
    must(mesh_alloc(m, 6 * n * n, 2 * n * n, &failure),
         &failure); // corners not exchange, as in STL
    for (int e = 0; e < 2 * n * n; e++)
        for (int k = 0; k < 3; k++) {
            static const int at[2][3][2] = { { { 0, 0 }, { 1, 0 }, { 1, 1 } },
                                             { { 0, 0 }, { 1, 1 }, { 0, 1 } } };
            double x = (e / 2 % n + at[e % 2][k][0]) / (double)n;
            double y = (e / 2 / n + at[e % 2][k][1]) / (double)n;
            m->vertex[3 * e + k] = v3(x, y, height(x, y));
            m->element[e][k] = 3 * e + k;
        }
}

static double flat(double x, double y)
{
    (void)x, (void)y;
    return 0;
}
static double groove(double x, double y)
{
    (void)y;
    return fabs(x - 0.5);
}
static double ridge(double x, double y)
{
    return -groove(x, y);
}
static double hills(double x, double y)
{
    return 0.1 * sin(9 * x) * cos(7 * y);
}

static void test_minima(void)
{
    struct failure failure = { 0 };
    struct touch t[TOUCHES_MOST];
    struct {
        const char *what;
        double (*height)(double, double);
        int wanted;
        double distance;
    } of[] = { { "a flat sheet is met once", flat, 1, 0.25 },
               { "a groove twice", groove, 2, 0.25 * sqrt(0.5) },
               { "a ridge once", ridge, 1, 0.25 } };
    for (int k = 0; k < 3; k++) {
        struct mesh m;
        struct surface s;
        sheet(&m, 8, of[k].height);
        must(mesh_check(&m, 3, &failure) || surface_init(&s, &m, 0, m.elements, 0, &failure),
             &failure);
        bool good = true;
        for (int i = 0; i < 200; i++) { // above inner points, edges and corners
            double y = i % 3 == 0 ? draw(0.3, 0.7) : i % 3 == 1 ? 0.5 : 0.5 + 1e-17;
            double x = k ? 0.5 : i % 2 ? 0.5 : i % 4 ? y : draw(0.3, 0.7);
            int n = surface_touches(&s, v3(x, y, 0.25), 0.3, t);
            good &= n == of[k].wanted && fabs(t[0].distance - of[k].distance) < 1e-14;
        }
        ok(good, "%s", of[k].what);
        surface_free(&s), mesh_free(&m);
    }
}

/* The distance of c from a triangle, by closing in on it */
static double brute(const vec3 *x, vec3 c)
{
    double best = INFINITY, ba = 0, bb = 0, wide = 0.5, a0 = 0.5, b0 = 0.5;
    for (int round = 0; round < 30; round++, wide *= 0.6, a0 = ba, b0 = bb)
        for (int i = -6; i <= 6; i++)
            for (int j = -6; j <= 6; j++) {
                double a = fmin(fmax(a0 + wide * i / 6, 0), 1), b = b0 + wide * j / 6;
                b = fmin(fmax(b, 0), 1 - a);
                vec3 p =
                    v3_add(v3_scale(1 - a - b, x[0]), v3_add(v3_scale(a, x[1]), v3_scale(b, x[2])));
                double d = v3_norm(v3_sub(c, p));
                if (d < best) best = d, ba = a, bb = b;
            }
    return best;
}

static void test_distance(void)
{
    struct failure failure = { 0 };
    struct mesh m;
    struct surface s;
    struct touch t[TOUCHES_MOST];
    double off = 0;
    sheet(&m, 6, hills);
    must(surface_init(&s, &m, 0, m.elements, 0, &failure), &failure);
    for (int i = 0; i < 60; i++) {
        vec3 c = v3(draw(-0.2, 1.2), draw(-0.2, 1.2), draw(-0.4, 0.4));
        double least = INFINITY, found = INFINITY;
        for (int32_t e = 0; e < m.elements; e++) least = fmin(least, brute(&m.vertex[3 * e], c));
        int n = surface_touches(&s, c, 1, t);
        for (int k = 0; k < n; k++) found = fmin(found, t[k].distance);
        off = fmax(off, fabs(found - least));
        for (int k = 0; k < n; k++) off = fmax(off, t[k].distance < least - 1e-6 ? 1 : 0);
    }
    ok(off < 1e-6, "the least distance from hills, off by %.1g m", off);
    surface_free(&s), mesh_free(&m);
}

/* The same triangles one by one: what the tree finds is what is there. */
static void test_tree(void)
{
    struct failure failure = { 0 };
    struct mesh m;
    struct surface s;
    struct touch t[TOUCHES_MOST], one[TOUCHES_MOST];
    bool good = true;
    sheet(&m, 70, hills);
    must(surface_init(&s, &m, 0, m.elements, 0, &failure), &failure);
    for (int i = 0; i < 20; i++) {
        vec3 c = v3(draw(0, 1), draw(0, 1), draw(-0.2, 0.2));
        double least = INFINITY, found = INFINITY;
        for (int32_t e = 0; e < m.elements; e++) {
            struct surface alone;
            must(surface_init(&alone, &m, e, 1, 0, &failure), &failure);
            if (surface_touches(&alone, c, 1, one)) least = fmin(least, one[0].distance);
            surface_free(&alone);
        }
        int n = surface_touches(&s, c, least * (1 + 1e-9), t);
        for (int k = 0; k < n; k++) found = fmin(found, t[k].distance);
        good &= fabs(found / least - 1) < 1e-12;
    }
    ok(good, "a tree of %d triangles finds the nearest of them all", m.elements);
    surface_free(&s), mesh_free(&m);
}

/* ---- motions ---- */

static void test_velocity(void)
{
    struct failure failure = { 0 };
    struct drives d = { 0 };
    must(drives_alloc(&d, 4, 3, &failure), &failure);
    d.row[0] = (struct drive_row){ -1, 0 }, d.row[1] = (struct drive_row){ 2, 5 };
    d.row[2] = (struct drive_row){ 4, -1 };
    for (int k = 0; k < 4; k++)
        d.drive[k] = (struct drive){ .turns = k != 1,
                                     .signal = k % 3,
                                     .axis = draw_unit(),
                                     .point = draw_unit(),
                                     .value = draw(0.5, 2),
                                     .frequency = draw(0.1, 1),
                                     .phase = draw(0, 6),
                                     .from = -10,
                                     .until = 10,
                                     .clock = 0.3,
                                     .rows = k % 3 == DRIVE_TABLE ? 3 : 0 };
    double off = 0, spin = 0, h = 1e-5;
    for (int i = 0; i < 50; i++) {
        double t = draw(-0.9, 1.2);
        vec3 x = v3_scale(3, draw_unit()), other = draw_unit();
        struct pose before = drives_pose(&d, 0, 4, t - h), after = drives_pose(&d, 0, 4, t + h);
        struct pose now = drives_pose(&d, 0, 4, t);
        vec3 v = v3_scale(1 / (2 * h), v3_sub(pose_of(&after, x), pose_of(&before, x)));
        vec3 found =
            drives_velocity(&d, 0, 4, (struct drive_step){ t - h, t + h, 2 * h }, pose_of(&now, x));
        off = fmax(off, v3_norm(v3_sub(v, found)));
        vec3 turned =
            v3_scale(1 / (2 * h), v3_sub(quat_turn(after.q, other), quat_turn(before.q, other)));
        vec3 w = drives_spin(&d, 0, 4, (struct drive_step){ t - h, t + h, 2 * h });
        spin = fmax(spin, v3_norm(v3_sub(turned, v3_cross(w, quat_turn(now.q, other)))));
    }
    ok(off < 1e-7, "velocities are the differences of places, to %.1g m/s", off);
    ok(spin < 1e-7, "and spins those of orientations, to %.1g rad/s", spin);
    drives_free(&d);
}

static struct step_opt options(void)
{
    return (struct step_opt){ .solve = { .global = &solver_nlgs,
                                         .method = &local_exact,
                                         .criterion = CRITERION_NATURAL,
                                         .eps = 1e-12,
                                         .max_sweeps = 20000,
                                         .relax = 1,
                                         .threads = 1,
                                         .local = { .newton_eps = 1e-13, .newton_max = 100 } } };
}

/* A disc of 1 kg in the plane, in a circle around the origin */
static void disc_in_circle(struct packing *p, double R, double r, double angle)
{
    struct failure failure = { 0 };
    must(packing_init(p, 2, 1, &failure) || packing_alloc_walls(p, 1, &failure), &failure);
    p->dt = 1e-3, p->g = v3(0, -9.81, 0), p->overlap = OVERLAP_PROJECT, p->mu[0] = 10;
    p->radius[0] = r, p->mass[0] = 1, p->inertia[0] = 0.5 * r * r;
    p->x[0] = v3((R - r) * sin(angle), -(R - r) * cos(angle), 0);
    p->wall[0] = wall_plane(v3(0, 0, 0), v3(0, 0, 1), 0);
    p->wall[0].shape = WALL_CYLINDER, p->wall[0].size[0] = R;
}

static void step(struct packing *p, struct contacts *c)
{
    const struct step_opt o = options();
    struct report rep = { 0 };
    struct failure failure = { 0 };
    must(step_advance(p, c, NULL, &o, &rep, &failure), &failure);
}

/* A disc that rolls in a trough: (3/2) (R - r) phi'' = - g sin phi */
static void test_rolling(void)
{
    struct packing p;
    struct contacts c = { 0 };
    double R = 1, r = 0.2, first = 0, last = 0, before = 0;
    int crossings = 0;
    disc_in_circle(&p, R, r, 0.02);
    before = p.x[0].x;
    for (int k = 0; k < 12000; k++) {
        step(&p, &c);
        double x = p.x[0].x;
        if (before < 0 && x >= 0) {
            double t = p.t - p.dt * x / (x - before);
            if (!crossings++) first = t;
            last = t;
        }
        before = x;
    }
    double period = (last - first) / (crossings - 1), wanted = 2 * PI * sqrt(1.5 * (R - r) / 9.81);
    ok(crossings > 4 && fabs(period / wanted - 1) < 1e-3,
       "a disc rolls to and fro in a trough in %.5f s, %.5f by theory", period, wanted);
    contacts_free(&c), packing_free(&p);
}

/* A spinning circle: the disc inside, if it does not slip, stands still in space and turns. */
static void test_spinning(void)
{
    struct packing p;
    struct contacts c = { 0 };
    struct failure failure = { 0 };
    double R = 1, r = 0.25, w = 2;
    disc_in_circle(&p, R, r, 0);
    must(drives_alloc(&p.drives, 1, 0, &failure), &failure);
    p.drives.drive[0] =
        (struct drive){ .turns = 1, .axis = v3(0, 0, 1), .value = w, .until = INFINITY };
    p.wall[0].drives = 1;
    p.w[0].z = w * R / r;
    must(packing_check(&p, &failure), &failure);
    for (int k = 0; k < 1000; k++) step(&p, &c);
    ok(fabs(p.x[0].x) < 1e-9 && fabs(p.w[0].z - w * R / r) < 1e-9,
       "a disc at the bottom of a circle that turns under it stays there, to %.1g m", p.x[0].x);
    contacts_free(&c), packing_free(&p);
}

/* A ball on a plate that shakes by a sin(w t): it leaves where a w^2 sin(w t) = g, and comes back
   when its parabola meets the plate. */
static void test_shaken(void)
{
    struct packing p;
    struct contacts c = { 0 };
    struct failure failure = { 0 };
    double r = 0.01, a = 1e-3, g = 9.81, f = 20, w = 2 * PI * f, left = 0, back = 0;
    must(packing_init(&p, 3, 1, &failure) || packing_alloc_walls(&p, 1, &failure), &failure);
    p.dt = 1e-5, p.g = v3(0, 0, -g), p.overlap = OVERLAP_PROJECT;
    p.radius[0] = r, p.mass[0] = 1, p.inertia[0] = 0.4 * r * r, p.x[0] = v3(0, 0, r);
    p.wall[0] = wall_plane(v3(0, 0, 0), v3(0, 0, 1), 0);
    must(drives_alloc(&p.drives, 1, 0, &failure), &failure);
    p.drives.drive[0] = (struct drive){ .axis = v3(0, 0, 1),
                                        .signal = DRIVE_SINE,
                                        .value = a,
                                        .frequency = f,
                                        .from = -INFINITY,
                                        .until = INFINITY };
    p.wall[0].drives = 1;
    must(packing_check(&p, &failure), &failure);
    for (int k = 0; k < 5000 && !back; k++) {
        step(&p, &c);
        double gap = p.x[0].z - r - a * sin(w * p.t);
        if (!left && p.t > 0.25 / f / 4 && gap > 1e-6) left = p.t;
        if (left && p.t > left + 0.003 && gap < 1e-6) back = p.t;
    }
    double t0 = asin(g / (a * w * w)) / w, t1 = t0 + 1e-4;
    while (a * sin(w * t0) + a * w * cos(w * t0) * (t1 - t0) - g / 2 * (t1 - t0) * (t1 - t0) >
           a * sin(w * t1))
        t1 += 1e-6;
    ok(fabs(left - t0) < 3e-3 && fabs(back - t1) < 2e-4,
       "a ball on a shaken plate flies from %.5f s to %.5f s, by theory %.5f to %.5f", left, back,
       t0, t1);
    contacts_free(&c), packing_free(&p);
}

int main(void)
{
    rng = gsl_rng_alloc(gsl_rng_mt19937);
    test_shapes();
    test_sides();
    test_minima();
    test_distance();
    test_tree();
    test_velocity();
    test_rolling();
    test_spinning();
    test_shaken();
    gsl_rng_free(rng);
    return tap_done();
}
