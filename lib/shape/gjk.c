#include "shape/gjk.h"

enum { ITERATIONS = 64 }; /* polyhedra of a hundred corners take ten */

static const double ENOUGH = 1e-12; /* relative: no support is nearer by more */

/* A corner of the Minkowski difference b - a */
struct gjk_corner {
    vec3 w, a, b;
};

struct simplex {
    int n;
    struct gjk_corner c[4];
    double part[4]; /* the nearest point to the origin is their mean with these weights */
};

static struct gjk_corner support(const struct core *a, const struct core *b, vec3 d)
{
    int32_t i = 0, j = 0;
    double top = v3_dot(d, a->v[0]), bottom = v3_dot(d, b->v[0]);
    for (int32_t k = 1; k < a->n; k++) {
        double at = v3_dot(d, a->v[k]);
        if (at > top) top = at, i = k;
    }
    for (int32_t k = 1; k < b->n; k++) {
        double at = v3_dot(d, b->v[k]);
        if (at < bottom) bottom = at, j = k;
    }
    return (struct gjk_corner){ v3_sub(b->v[j], a->v[i]), a->v[i], b->v[j] };
}

static void gjk_keep(struct simplex *s, int n, const int which[], const double part[])
{
    struct simplex to = { .n = n };
    for (int k = 0; k < n; k++) to.c[k] = s->c[which[k]], to.part[k] = part[k];
    *s = to;
}

/* Each of these leaves the corners whose face has the point nearest to the origin, and its weights. */
static void gjk_near_segment(struct simplex *s, int i, int j)
{
    vec3 a = s->c[i].w, d = v3_sub(s->c[j].w, a);
    double length2 = v3_dot(d, d), t = length2 > 0 ? -v3_dot(a, d) / length2 : 0;
    if (t <= 0) {
        gjk_keep(s, 1, (int[]){ i }, (double[]){ 1 });
        return;
    }
    if (t >= 1) {
        gjk_keep(s, 1, (int[]){ j }, (double[]){ 1 });
        return;
    }
    gjk_keep(s, 2, (int[]){ i, j }, (double[]){ 1 - t, t });
}

/* [Ericson, Real-time collision detection, 5.1.5] */
static void gjk_near_triangle(struct simplex *s, int i, int j, int k)
{
    vec3 a = s->c[i].w, b = s->c[j].w, c = s->c[k].w, ab = v3_sub(b, a), ac = v3_sub(c, a);
    double d1 = -v3_dot(ab, a), d2 = -v3_dot(ac, a), d3 = -v3_dot(ab, b), d4 = -v3_dot(ac, b);
    double d5 = -v3_dot(ab, c), d6 = -v3_dot(ac, c);
    double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (d1 <= 0 && d2 <= 0) {
        gjk_keep(s, 1, (int[]){ i }, (double[]){ 1 });
    } else if (d3 >= 0 && d4 <= d3) {
        gjk_keep(s, 1, (int[]){ j }, (double[]){ 1 });
    } else if (d6 >= 0 && d5 <= d6) {
        gjk_keep(s, 1, (int[]){ k }, (double[]){ 1 });
    } else if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        gjk_near_segment(s, i, j);
    } else if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        gjk_near_segment(s, i, k);
    } else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        gjk_near_segment(s, j, k);
    } else {
        double sum = 1 / (va + vb + vc);
        gjk_keep(s, 3, (int[]){ i, j, k }, (double[]){ va * sum, vb * sum, vc * sum });
    }
}

static vec3 nearest_point(const struct simplex *s)
{
    vec3 x = v3(0, 0, 0);
    for (int k = 0; k < s->n; k++) x = v3_axpy(x, s->part[k], s->c[k].w);
    return x;
}

/* Is the origin on the other side of the plane of three corners than the fourth? */
static bool gjk_beyond(const struct simplex *s, int i, int j, int k, int other)
{
    vec3 a = s->c[i].w, n = v3_cross(v3_sub(s->c[j].w, a), v3_sub(s->c[k].w, a));
    double origin = -v3_dot(n, a), inside = v3_dot(n, v3_sub(s->c[other].w, a));
    return origin * inside <= 0;
}

/* Of the faces that the origin is beyond, the nearest; false: it is inside. */
static bool near_tetrahedron(struct simplex *s)
{
    static const int face[4][4] = {
        { 0, 1, 2, 3 }, { 0, 1, 3, 2 }, { 0, 2, 3, 1 }, { 1, 2, 3, 0 }
    };
    struct simplex best = { 0 };
    double least = INFINITY;
    for (int f = 0; f < 4; f++) {
        const int *c = face[f];
        if (!gjk_beyond(s, c[0], c[1], c[2], c[3])) continue;
        struct simplex one = *s;
        gjk_near_triangle(&one, c[0], c[1], c[2]);
        vec3 x = nearest_point(&one);
        if (v3_dot(x, x) < least) least = v3_dot(x, x), best = one;
    }
    if (least == INFINITY) return false;
    *s = best;
    return true;
}

static bool gjk_reduce(struct simplex *s)
{
    if (s->n == 2) gjk_near_segment(s, 0, 1);
    if (s->n == 3) gjk_near_triangle(s, 0, 1, 2);
    return s->n < 4 || near_tetrahedron(s);
}

static bool gjk_has(const struct simplex *s, vec3 w)
{
    for (int k = 0; k < s->n; k++)
        if (s->c[k].w.x == w.x && s->c[k].w.y == w.y && s->c[k].w.z == w.z) return true;
    return false;
}

static struct nearest result(const struct simplex *s)
{
    struct nearest o = { 0, { 0, 0, 0 }, { 0, 0, 0 } };
    for (int k = 0; k < s->n; k++)
        o.a = v3_axpy(o.a, s->part[k], s->c[k].a), o.b = v3_axpy(o.b, s->part[k], s->c[k].b);
    o.distance = v3_norm(v3_sub(o.b, o.a));
    return o;
}

struct nearest gjk_nearest(const struct core *a, const struct core *b)
{
    struct simplex s = { 1, { support(a, b, v3_sub(b->centre, a->centre)) }, { 1 } };
    vec3 x = s.c[0].w;
    double last = INFINITY;
    for (int k = 0; k < ITERATIONS; k++) {
        double x2 = v3_dot(x, x);
        if (!(x2 > 0) || !(x2 < last)) break;
        last = x2;
        struct gjk_corner next = support(a, b, x); // the farthest towards the origin
        if (x2 - v3_dot(x, next.w) <= ENOUGH * x2 || gjk_has(&s, next.w)) break;
        struct simplex was = s;
        s.c[s.n++] = next;
        if (!gjk_reduce(&s)) return (struct nearest){ 0, next.a, next.b };
        x = nearest_point(&s);
        if (!(v3_dot(x, x) < x2)) { // rounding: what was there was as near
            s = was;
            break;
        }
    }
    return result(&s);
}
