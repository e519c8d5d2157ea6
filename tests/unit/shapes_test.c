/* shapes_test.c: volumes and moments of shapes, how they turn, where they meet, what contacts give. */
#include "contact/detect.h"
#include "scene/hull.h"
#include "scene/scene_build.h"
#include "shape/gjk.h"
#include "shape/meet.h"
#include "shape/solid.h"
#include "solve/apply.h"
#include "solve/assembly.h"
#include "solve/prepare.h"
#include "state/placement.h"
#include "state/rotation.h"
#include "step/move.h"
#include "step/step.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

static uint64_t state = 1;

static double noise(void) /* in [-1, 1] */
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(int64_t)state / 0x1p63;
}

static vec3 noise3(void)
{
    return v3(noise(), noise(), noise());
}

static bool near(double a, double b, double part)
{
    return fabs(a - b) <= part * fabs(b);
}

/* The packing of a scene; ends the test where there is none. */
static struct packing build(const char *text)
{
    struct scene s;
    struct packing p;
    struct failure failure = { 0 };
    if (scene_parse(&s, text, strlen(text), NULL, &failure) ||
        scene_build(&p, &s, NULL, &failure)) {
        printf("Bail out! %s\n", failure.text);
        exit(1);
    }
    scene_free(&s);
    return p;
}

/* A scene of one body of a shape */
static struct packing one(const char *dim, const char *shape, const char *body)
{
    char text[2000];
    snprintf(text, sizeof text,
             "{%s \"dt\": 0.01, \"density\": 1, \"shapes\": {\"it\": %s}, "
             "\"bodies\": [{\"x\": [0, 0%s], \"shape\": \"it\"%s}]}",
             dim, shape, *dim ? "" : ", 0", body);
    return build(text);
}

/* ---- volumes and moments ---- */

/* Mass and the sorted principal moments of a body of density 1 */
static void check_solid(const char *name, const char *dim, const char *shape, double mass,
                        double Ia, double Ib, double Ic, double part)
{
    struct packing p = one(dim, shape, "");
    vec3 I = rotation_moments(&p, 0);
    double m[3] = { I.x, I.y, I.z };
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++)
            if (m[k] > m[k + 1]) {
                double was = m[k];
                m[k] = m[k + 1], m[k + 1] = was;
            }
    if (*dim) m[0] = Ia, m[1] = Ib, m[2] = p.inertia[0];
    ok(near(p.mass[0], mass, part) && near(m[0], Ia, part) && near(m[1], Ib, part) &&
           near(m[2], Ic, part),
       "%s: mass %.6g and moments %.6g %.6g %.6g are right to %g", name, p.mass[0], m[0], m[1],
       m[2], part);
    packing_free(&p);
}

static void solids_are_right(void)
{
    check_solid("brick", "", "{\"box\": [2, 3, 4]}", 24, 26, 40, 50, 1e-13);
    // the corner of a cube of side 1: int x^2 = 1/60, int xy = 1/120, centre (1, 1, 1)/4
    check_solid("corner of a cube", "",
                "{\"points\": [[0,0,0],[1,0,0],[0,1,0],[0,0,1],[0.1,0.1,0.1]]}", 1.0 / 6, 1.0 / 96,
                1.0 / 96, 1.0 / 60, 1e-12);
    double r = 0.5, l = 2, V = M_PI * r * r * l, B = 4 * M_PI / 3 * r * r * r;
    double along = V * r * r / 2 + B * 0.4 * r * r;
    double across = V * (r * r / 4 + l * l / 12) + B * (0.4 * r * r + l * l / 4 + 3 * l * r / 8);
    check_solid("capsule", "", "{\"capsule\": {\"length\": 2, \"radius\": 0.5}}", V + B, along,
                across, across, 1e-13);
    double b = 4 * M_PI / 3, I = 0.4 * b;
    check_solid("two balls apart", "", "{\"balls\": [[-2, 0, 0, 1], [2, 0, 0, 1]]}", 2 * b, 2 * I,
                2 * I + 8 * b, 2 * I + 8 * b, 1e-13);
    check_solid("prism of six sides", "",
                "{\"regular\": {\"sides\": 6, \"radius\": 1, \"height\": 2}}", 3 * sqrt(3),
                3 * sqrt(3) * 5 / 12, 3 * sqrt(3) * (5.0 / 24 + 1.0 / 3),
                3 * sqrt(3) * (5.0 / 24 + 1.0 / 3), 1e-12);
    double lens = M_PI * (4 + 1) * 1 / 12; // of two unit balls 1 apart
    struct packing p = one("", "{\"balls\": [[0, 0, 0, 1], [1, 0, 0, 1]]}", "");
    ok(near(p.mass[0], 2 * b - lens, 2e-4), "balls that overlap count once: %.6g, %.6g", p.mass[0],
       2 * b - lens);
    packing_free(&p);
    p = one("", "{\"box\": [2, 3, 4], \"round\": 0.5}", "");
    double steiner = 24 + 52 * 0.5 + M_PI * 0.25 * 9 + 4 * M_PI / 3 * 0.125;
    ok(near(p.mass[0], steiner, 2e-4), "a rounded brick has Steiner's volume: %.6g, %.6g",
       p.mass[0], steiner);
    packing_free(&p);
    check_solid("square", "\"dim\": 2,", "{\"box\": [2, 3]}", 6, 1, 1, 6 * 13.0 / 12, 1e-13);
    check_solid("capsule of the plane", "\"dim\": 2,",
                "{\"capsule\": {\"length\": 2, \"radius\": 0.5}}", 2 + M_PI / 4, 1, 1,
                2 * (4 + 1) / 12.0 + M_PI / 4 * (0.5 * 0.25 + 1 + 4 * 2 * 0.5 / (3 * M_PI)), 1e-13);
}

/* A hull against its points, drawn at random: mass and moments by counting */
static void hulls_by_sampling(void)
{
    vec3 x[12];
    struct shape s = { .form = SHAPE_HULL };
    struct failure failure = { 0 };
    for (int i = 0; i < 12; i++) x[i] = noise3();
    hull_of_points(&s, 3, 12, x, &failure);
    struct solid o;
    solid_of(&o, &s, 3, &failure);
    double inside = 0, xx = 0, n = 200000;
    vec3 sum = v3(0, 0, 0);
    vec3 *normal = calloc((size_t)s.faces + 1, sizeof *normal);
    double *at = calloc((size_t)s.faces + 1, sizeof *at);
    for (int32_t f = 0; f < s.faces; f++) {
        const int32_t *c = s.corner + s.first[f];
        normal[f] = v3_cross(v3_sub(s.vertex[c[1]], s.vertex[c[0]]),
                             v3_sub(s.vertex[c[2]], s.vertex[c[0]]));
        at[f] = v3_dot(normal[f], s.vertex[c[0]]);
    }
    for (int k = 0; k < n; k++) {
        vec3 y = noise3();
        bool in = true;
        for (int32_t f = 0; f < s.faces && in; f++) in = v3_dot(normal[f], y) <= at[f];
        if (in) inside++, sum = v3_add(sum, y), xx += y.x * y.x;
    }
    double volume = 8 * inside / n, second = 8 * xx / n - volume * o.centre.x * o.centre.x;
    ok(!failure.status && near(o.volume, volume, 0.02) && near(o.second[0][0], second, 0.03) &&
           v3_norm(v3_sub(o.centre, v3_scale(1 / inside, sum))) < 0.01,
       "a hull of 12 points has the volume that sampling finds: %.4g, %.4g", o.volume, volume);
    free(normal), free(at);
    shape_free(&s);
}

static void axes_are_found(void)
{
    // the same brick, described aslant by its corners
    char text[1000] = "{\"points\": [";
    quat q = quat_unit((quat){ 0.3, 0.5, -0.2, 0.7 });
    for (int i = 0; i < 8; i++) {
        vec3 x = quat_turn(q, v3(i & 1 ? 1 : -1, i & 2 ? 1.5 : -1.5, i & 4 ? 2 : -2));
        char corner[120];
        snprintf(corner, sizeof corner, "%s[%.17g, %.17g, %.17g]", i ? "," : "", x.x + 5, x.y - 3,
                 x.z + 1);
        strcat(text, corner);
    }
    strcat(text, "]}");
    check_solid("brick aslant, away from the origin", "", text, 24, 26, 40, 50, 1e-9);
    struct packing p = one("", text, "");
    const struct shape *s = packing_shape(&p, 0);
    double most = 0;
    for (int i = 0; i < 8; i++) { // every corner of the description is one of the body's
        vec3 x = quat_turn(q, v3(i & 1 ? 1 : -1, i & 2 ? 1.5 : -1.5, i & 4 ? 2 : -2));
        double least = INFINITY;
        for (int32_t k = 0; k < s->vertices; k++) {
            vec3 y = v3_scale(p.radius[0], quat_turn(p.q[0], s->vertex[k]));
            least = fmin(least, v3_norm(v3_sub(x, y)));
        }
        most = fmax(most, least);
    }
    ok(most < 1e-9 && s->faces == 6, "it is placed as it was described: off by %.2g", most);
    packing_free(&p);
}

/* ---- turning ---- */

/* A brick without forces, spun about its middle axis and a little more, for `t` s: the error of its
   energy, of L, and how often it has turned over */
static quat spin(double dt, double t, double *energy, double *momentum, int *flips)
{
    struct packing p = one("", "{\"box\": [1, 2, 3]}", ", \"w\": [0.01, 5, 0.01]");
    struct contacts none = { 0 };
    struct failure failure = { 0 };
    p.dt = dt, p.g = v3(0, 0, 0);
    contacts_alloc_found(&none);
    vec3 L = rotation_momentum(&p, 0, p.q[0], p.w[0]);
    double E = energy_of(&p).kinetic, side = 1;
    *energy = *momentum = 0, *flips = 0;
    for (int64_t k = 0; k < (int64_t)(t / dt + 0.5); k++) {
        move_step(&p, &none, NULL, &failure);
        vec3 now = rotation_momentum(&p, 0, p.q[0], p.w[0]);
        *energy = fmax(*energy, fabs(energy_of(&p).kinetic / E - 1));
        *momentum = fmax(*momentum, v3_norm(v3_sub(now, L)) / v3_norm(L));
        double up = quat_turn(p.q[0], v3(0, 1, 0)).y;
        if (fabs(up) > 0.9 && up * side < 0) side = -side, ++*flips;
    }
    quat q = p.q[0];
    contacts_free(&none);
    packing_free(&p);
    return q;
}

static double apart(quat a, quat b)
{
    double c = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z, s = c < 0 ? -1 : 1;
    return sqrt((a.w - s * b.w) * (a.w - s * b.w) + (a.x - s * b.x) * (a.x - s * b.x) +
                (a.y - s * b.y) * (a.y - s * b.y) + (a.z - s * b.z) * (a.z - s * b.z));
}

static void tops_turn(void)
{
    double E[3], L[3];
    int flips;
    spin(1e-2, 100, &E[0], &L[0], &flips);
    ok(L[0] < 1e-11, "a top without forces keeps L over 10000 steps: to %.2g", L[0]);
    ok(E[0] < 1e-3, "and its energy, without a drift: to %.2g", E[0]);
    ok(flips >= 5, "about its middle axis it turns over again and again [Dzhanibekov]: %d times",
       flips);
    spin(5e-3, 100, &E[1], &L[1], &flips);
    ok(E[0] / E[1] > 3.5 && E[0] / E[1] < 4.5, "the energy's error is of order 2: %.3g a halving",
       E[0] / E[1]);
    quat fine = spin(1e-4, 2, &E[2], &L[2], &flips);
    double one_off = apart(spin(1e-2, 2, &E[2], &L[2], &flips), fine);
    double half_off = apart(spin(5e-3, 2, &E[2], &L[2], &flips), fine);
    ok(one_off / half_off > 3.5 && one_off / half_off < 4.5,
       "and so is that of its orientation: %.3g a halving", one_off / half_off);

    // a symmetric top precesses about L with |L|/I_across, whatever the step
    struct packing p = one("", "{\"box\": [1, 1, 3]}", ", \"w\": [1, 0, 4]");
    struct contacts none = { 0 };
    struct failure failure = { 0 };
    contacts_alloc_found(&none);
    p.dt = 0.1, p.g = v3(0, 0, 0);
    vec3 I = rotation_moments(&p, 0), L0 = rotation_momentum(&p, 0, p.q[0], p.w[0]);
    double rate = v3_norm(L0) / I.x;
    vec3 axis = v3_scale(1 / v3_norm(L0), L0), end;
    for (int k = 0; k < 100; k++) move_step(&p, &none, NULL, &failure);
    end = quat_turn(p.q[0], v3(0, 0, 1));
    vec3 want = quat_turn(quat_rotation(v3_scale(10 * rate, axis)), v3(0, 0, 1));
    ok(v3_norm(v3_sub(end, want)) < 1e-11, "a symmetric top precesses exactly: off by %.2g",
       v3_norm(v3_sub(end, want)));
    contacts_free(&none);
    packing_free(&p);

    // there and back again
    p = one("", "{\"box\": [1, 2, 3]}", ", \"w\": [1, -2, 3]");
    struct packing was;
    packing_copy(&was, &p, &failure);
    contacts_alloc_found(&none);
    move_step(&p, &none, NULL, &failure), move_back(&p, &none, &failure);
    ok(v3_norm(v3_sub(p.w[0], was.w[0])) < 1e-13 && apart(p.q[0], was.q[0]) < 1e-14,
       "a step back undoes a step");
    contacts_free(&none);
    packing_free(&p), packing_free(&was);
}

/* ---- meeting ---- */

enum hull_kind { SHARP, ROUNDED, WEDGES };

/* A corner of a hull; of a wedge it lies in an octant of the unit sphere */
static vec3 hull_point(enum hull_kind kind)
{
    const vec3 x = noise3();
    if (kind != WEDGES) return x;
    return v3_scale(1 / v3_norm(x), v3(fabs(x.x), fabs(x.y), x.z));
}

/* Two hulls of noise in a scene, where and how they are turned */
static struct packing two_hulls(double distance, enum hull_kind kind)
{
    const int corners = kind == WEDGES ? 24 : 10;
    char text[4000] = "{\"dt\": 0.001, \"mu\": 0.5, \"density\": 1, \"overlap\": true, "
                      "\"gravity\": [0,0,0], \"shapes\": {";
    for (int k = 0; k < 2; k++) {
        char *at = text + strlen(text);
        at += sprintf(at, "%s\"%c\": {\"points\": [", k ? "," : "", 'a' + k);
        for (int i = 0; i < corners; i++) {
            const vec3 x = hull_point(kind);
            at += sprintf(at, "%s[%.9g, %.9g, %.9g]", i ? "," : "", x.x, x.y, x.z);
        }
        sprintf(at, "]%s}", kind == ROUNDED ? ", \"round\": 0.2" : "");
    }
    vec3 d = noise3(), v = noise3(), w = noise3(), u = noise3();
    d = v3_scale(distance / v3_norm(d), d);
    sprintf(text + strlen(text),
            "}, \"bodies\": [{\"x\": [0,0,0], \"shape\": \"a\", \"orientation\": \"random\", "
            "\"v\": [%.9g, %.9g, %.9g], \"w\": [%.9g, %.9g, %.9g]}, "
            "{\"x\": [%.9g, %.9g, %.9g], \"shape\": \"b\", \"orientation\": \"random\", "
            "\"w\": [%.9g, %.9g, %.9g]}]}",
            d.x + v.x, d.y + v.y, d.z + v.z, w.x, w.y, w.z, d.x, d.y, d.z, u.x, u.y, u.z);
    return build(text);
}

static void distances_are_right(void)
{
    double worst = 0, swapped = 0;
    for (int k = 0; k < 300; k++) {
        vec3 a[8], b[8];
        for (int i = 0; i < 8; i++) a[i] = noise3(), b[i] = v3_add(noise3(), v3(2.5, noise(), 0));
        struct core ca = { .n = 8, .v = a }, cb = { .n = 8, .v = b, .centre = v3(2.5, 0, 0) };
        struct nearest o = gjk_nearest(&ca, &cb);
        struct nearest back = gjk_nearest(&cb, &ca);
        swapped = fmax(swapped, fabs(o.distance - back.distance));
        if (!(o.distance > 0)) continue;
        // the connection is a separating axis that is as long as it separates
        vec3 n = v3_scale(1 / o.distance, v3_sub(o.b, o.a));
        worst = fmax(worst, fabs(core_bottom(&cb, n) - core_top(&ca, n) - o.distance));
    }
    ok(worst < 1e-9, "the shortest connection of hulls separates them by its length: to %.2g",
       worst);
    ok(swapped < 1e-9, "either way round: to %.2g", swapped);
}

static void cubes_meet(void)
{
    struct packing p = build(
        "{\"dt\": 0.001, \"overlap\": true, \"shapes\": {\"c\": {\"box\": [1, 1, 1]}}, \"bodies\": "
        "["
        "{\"x\": [0, 0, 0], \"shape\": \"c\"}, {\"x\": [0.3, 0.2, 0.99], \"shape\": \"c\"}]}");
    struct contacts s = { 0 };
    struct failure failure = { 0 };
    detect_contacts_at(&s, &p, p.x, 0, 0, &failure);
    double area = 0;
    bool up = s.n == 4;
    for (int64_t i = 0; i < s.n; i++) {
        up = up && fabs(s.c[i].n.z - 1) < 1e-14 && fabs(s.c[i].gap + 0.01) < 1e-12;
        area += fabs((s.c[i].x.x - 0.15) * (s.c[i].x.y - 0.1));
    }
    ok(up && near(area, 0.7 * 0.8, 1e-12),
       "cube on cube: four places at the corners of the overlap");
    p.q[1] = quat_rotation(v3(0, 0, M_PI / 4)), p.x[1] = v3(0, 0, 0.99);
    detect_contacts_at(&s, &p, p.x, 0, 0, &failure);
    ok(s.n == 4, "turned by 45 degrees the overlap has eight corners, and four places are kept: %d",
       (int)s.n);
    // tipped: corners leave one by one, each with its own gap
    p.q[1] = quat_rotation(v3(0.01, 0.02, 0)), p.x[1] = v3(0, 0, 1.0);
    detect_contacts_at(&s, &p, p.x, 0, 1, &failure);
    double lo = INFINITY, hi = -INFINITY;
    for (int64_t i = 0; i < s.n; i++) lo = fmin(lo, s.c[i].gap), hi = fmax(hi, s.c[i].gap);
    ok(s.n == 4 && near(hi - lo, 0.03, 0.05), "tipped, each corner has its own gap: %.3g to %.3g",
       lo, hi);
    // edge across edge
    p.q[0] = quat_rotation(v3(M_PI / 4, 0, 0)), p.q[1] = quat_rotation(v3(0, M_PI / 4, 0));
    p.x[1] = v3(0.1, -0.05, sqrt(2) - 0.01);
    detect_contacts_at(&s, &p, p.x, 0, 0, &failure);
    ok(s.n == 1 && near(s.c[0].gap, -0.01, 1e-9) && fabs(s.c[0].n.z - 1) < 1e-9 &&
           fabs(s.c[0].x.x - 0.1) < 1e-9 + 1 * 0.11,
       "crossed edges meet in one place");
    contacts_free(&s);
    packing_free(&p);
}

/* Hulls whose shortest connection has no length meet, wherever the lowest corner of one is [shape/meet.c, incident()]. */
static void overlaps_are_found(void)
{
    int overlap = 0, missed = 0;
    for (int k = 0; k < 2000; k++) {
        struct packing p = two_hulls(0.6 + 0.4 * noise(), WEDGES);
        const struct positions at = { .x = p.x, .q = p.q };
        struct placed placed;
        struct place place[PLACES_MOST];
        struct failure failure = { 0 };
        placed_init(&placed, &p, &at, &failure);
        const struct core a = placed_core(&placed, 0, 0), b = placed_core(&placed, 1, 0);
        const bool apart = gjk_nearest(&a, &b).distance > 0;
        overlap += !apart, missed += !apart && !meet_cores(3, &a, &b, 0, place);
        placed_free(&placed), packing_free(&p);
    }
    ok(overlap > 100 && !missed, "hulls that overlap meet: %d pairs, %d missed", overlap, missed);
}

/* ---- what contacts give ---- */

static void steps_keep_momentum(bool rounded)
{
    double force = 0, moment = 0, work = 0, worst = 0;
    int met = 0;
    for (int k = 0; k < 60; k++) {
        struct packing p = two_hulls(0.9, rounded ? ROUNDED : SHARP);
        struct contacts s = { 0 };
        struct report r = { 0 };
        struct failure failure = { 0 };
        struct step_opt o = { .alpha = 0, .order = ORDER_COLOUR };
        p.overlap = OVERLAP_KEEP;
        detect_contacts(&s, &p, 0, NULL, &failure);
        o.solve = (struct solve_opt){ .global = &solver_nlgs,
                                      .method = methods[k % METHOD_COUNT],
                                      .criterion = CRITERION_NATURAL,
                                      .eps = 1e-12,
                                      .max_sweeps = 100000,
                                      .relax = 1,
                                      .threads = 1,
                                      .local = { .newton_eps = 1e-13, .newton_max = 100 } };
        vec3 before = v3(0, 0, 0), spin_before = before, after = before, spin_after = before;
        double E = energy_of(&p).kinetic;
        for (int i = 0; i < 2; i++) {
            before = v3_axpy(before, p.mass[i], p.v[i]);
            spin_before = v3_add(spin_before, rotation_momentum(&p, i, p.q[i], p.w[i]));
            spin_before =
                v3_axpy(spin_before, p.mass[i], v3_cross(p.x[i], p.v[i])); // before the step
        }
        step_solve(&p, &s, &o, &r, &failure), move_step(&p, &s, NULL, &failure);
        for (int i = 0; i < 2; i++) {
            after = v3_axpy(after, p.mass[i], p.v[i]);
            spin_after = v3_add(spin_after, rotation_momentum(&p, i, p.q[i], p.w[i]));
            spin_after = v3_axpy(spin_after, p.mass[i], v3_cross(p.x[i], p.v[i]));
        }
        met += s.n > 0;
        force = fmax(force, v3_norm(v3_sub(after, before)));
        moment = fmax(moment, v3_norm(v3_sub(spin_after, spin_before)));
        work = fmax(work, energy_of(&p).kinetic / E - 1);
        worst = fmax(worst, r.err.natural);
        contacts_free(&s);
        packing_free(&p);
    }
    const char *what = rounded ? "rounded" : "sharp";
    ok(met > 20 && force < 1e-12, "%s hulls that hit keep their momentum (%d met): to %.2g", what,
       met, force);
    ok(moment < 1e-12, "and their angular momentum: to %.2g", moment);
    ok(work < 1e-6 && worst < 1e-10, "and gain no energy: %.2g, natural %.2g", work, worst);
}

/* W by the blocks of assembly is W by the bodies of the sweep. */
static void assembly_is_sweep(void)
{
    struct packing p = build(
        "{\"dt\": 0.01, \"mu\": 0.5, \"overlap\": true, \"shapes\": {\"c\": {\"box\": [1, 1.2, "
        "0.9]}, \"p\": {\"capsule\": {\"length\": 1, \"radius\": 0.3}}}, \"walls\": [{\"box\": "
        "{\"x\": [0, 3], \"y\": [0, 3], \"z\": [0, null]}}], \"bodies\": [{\"count\": 4, "
        "\"shape\": \"c\", \"size\": 0.8, \"jitter\": 0}, {\"count\": 9, \"radius\": 0.4, "
        "\"jitter\": 0, \"box\": {\"x\": [0, 3], \"y\": [0, 3], \"z\": [0.5, null]}}, "
        "{\"count\": 4, \"shape\": \"p\", \"orientation\": \"random\"}]}");
    struct contacts s = { 0 };
    struct failure failure = { 0 };
    struct problem q;
    struct assembly A;
    struct delassus W;
    struct apply a;
    detect_contacts(&s, &p, 0.5, NULL, &failure);
    prepare_packing(&q, &p, &s, &(struct prepare_opt){ .rho_factor = 1, .order = ORDER_COLOUR },
                    &failure);
    assembly_init(&A, &q, &failure), assembly_blocks(&A, &W, &failure);
    double *x = calloc((size_t)(3 * q.slots) + 4, sizeof *x),
           *y = calloc((size_t)(3 * q.slots) + 4, sizeof *y);
    double *f = calloc((size_t)(3 * q.n) + 4, sizeof *f),
           *v = calloc((size_t)(3 * q.n) + 4, sizeof *v);
    double *zero = calloc((size_t)(3 * q.n) + 4, sizeof *zero), most = 0, size = 0;
    for (int64_t i = 0; i < q.slots; i++)
        for (int k = 0; k < 3 && q.contact[i] >= 0; k++)
            f[3 * q.contact[i] + k] = x[3 * i + k] = noise();
    apply_init(&a, &q);
    problem_apply(&q, &a, x, y);
    delassus_apply(&W, f, zero, v);
    for (int64_t i = 0; i < q.slots; i++)
        for (int k = 0; k < 3 && q.contact[i] >= 0; k++) {
            most = fmax(most, fabs(y[3 * i + k] - v[3 * q.contact[i] + k]));
            size = fmax(size, fabs(y[3 * i + k]));
        }
    ok(q.lever && q.n > 30 && most < 1e-13 * size,
       "W by blocks is W by levers, over %d contacts: to %.2g", (int)q.n, most / size);
    free(x), free(y), free(f), free(v), free(zero);
    apply_free(&a), assembly_free(&A), delassus_free(&W), problem_free(&q);
    contacts_free(&s);
    packing_free(&p);
}

int main(void)
{
    solids_are_right();
    hulls_by_sampling();
    axes_are_found();
    tops_turn();
    distances_are_right();
    cubes_meet();
    overlaps_are_found();
    steps_keep_momentum(false);
    steps_keep_momentum(true);
    assembly_is_sweep();
    return tap_done();
}
