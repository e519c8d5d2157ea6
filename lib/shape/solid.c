/* shape/solid.c: integrals over shapes, and principal axes [shape/solid.h]. */
#include "shape/solid.h"

#include <stdlib.h>
#include <string.h>

enum {
    LINES_SPACE = 300,   /* a side of the grid of lines: 1e-4 of the moments */
    LINES_PLANE = 20000, /* lines in the plane: 1e-6 */
    JACOBI_SWEEPS = 30   /* at most; five do */
};

static const double AXES_THERE = 1e-9; /* off-diagonal parts, of the trace, that are rounding */
static const double FLAT = 1e-9;       /* volume, of the cube of the reach, that is none */

/* ---- sums of simple parts ---- */

/* Integrals from the origin, while parts are added up */
struct solid_sums {
    double volume, first[3], second[3][3];
};

/* The tetrahedron 0, a, b, c; in the plane (dim 2) the triangle 0, a, b */
static void add_simplex(struct solid_sums *t, int dim, vec3 a, vec3 b, vec3 c)
{
    double det = dim == 2 ? a.x * b.y - a.y * b.x : v3_dot(a, v3_cross(b, c));
    double volume = det / (dim == 2 ? 2 : 6), mean = volume / (dim + 1);
    vec3 corner[3] = { a, b, c }, sum = v3(0, 0, 0);
    for (int k = 0; k < dim; k++) sum = v3_add(sum, corner[k]);
    t->volume += volume;
    t->first[0] += mean * sum.x, t->first[1] += mean * sum.y, t->first[2] += mean * sum.z;
    double part = det / (dim == 2 ? 24 : 120);
    v3_outer(t->second, part, sum, sum);
    for (int k = 0; k < dim; k++) v3_outer(t->second, part, corner[k], corner[k]);
}

/* Something of this volume and with these second moments about its own centre at c */
static void solid_add_part(struct solid_sums *t, double volume, vec3 c, double own[3][3])
{
    t->volume += volume;
    t->first[0] += volume * c.x, t->first[1] += volume * c.y, t->first[2] += volume * c.z;
    v3_outer(t->second, volume, c, c);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) t->second[i][j] += own[i][j];
}

static void add_ball(struct solid_sums *t, int dim, vec3 c, double r)
{
    double volume = dim == 2 ? M_PI * r * r : 4 * M_PI / 3 * r * r * r;
    double k = volume * r * r / (dim + 2);
    double own[3][3] = { { k, 0, 0 }, { 0, k, 0 }, { 0, 0, dim == 2 ? 0 : k } };
    solid_add_part(t, volume, c, own);
}

/*
 * Along its axis u, of length l: a cylinder, and two half balls that together are one, whose matter
 * is l/2 further out. In the plane a rectangle and two half discs.
 */
static void add_capsule(struct solid_sums *t, int dim, vec3 a, vec3 b, double r)
{
    vec3 d = v3_sub(b, a), middle = v3_scale(0.5, v3_add(a, b));
    double l = v3_norm(d), h = l / 2;
    double trunk = (dim == 2 ? 2 * r : M_PI * r * r) * l;
    double ends = dim == 2 ? M_PI * r * r : 4 * M_PI / 3 * r * r * r;
    double out = dim == 2 ? 4 * r / (3 * M_PI) : 3 * r / 8; // centre of a half from its flat side
    double across = trunk * r * r / (dim + 1) + ends * r * r / (dim + 2);
    double along = trunk * l * l / 12 + ends * (h * h + 2 * h * out + r * r / (dim + 2));
    double own[3][3] = { { across, 0, 0 }, { 0, across, 0 }, { 0, 0, dim == 2 ? 0 : across } };
    if (l > 0) v3_outer(own, (along - across) / (l * l), d, d);
    solid_add_part(t, trunk + ends, middle, own);
}

/* ---- lines through unions ---- */

struct chord {
    double lo, hi;
};

/* Where the line (x, y, z) along x is in a ball */
static struct chord solid_in_ball(vec3 c, double r, double y, double z)
{
    double h2 = r * r - (y - c.y) * (y - c.y) - (z - c.z) * (z - c.z);
    double h = h2 > 0 ? sqrt(h2) : -INFINITY;
    return (struct chord){ c.x - h, c.x + h };
}

/* What is left of a chord where n . x <= at */
static void solid_cut(struct chord *k, vec3 n, double at, double y, double z)
{
    double rest = at - n.y * y - n.z * z;
    if (n.x > 1e-14)
        k->hi = fmin(k->hi, rest / n.x);
    else if (n.x < -1e-14)
        k->lo = fmax(k->lo, rest / n.x);
    else if (rest < 0)
        k->lo = INFINITY, k->hi = -INFINITY;
}

/* In the cylinder of radius r around a segment, without round ends */
static struct chord solid_in_tube(vec3 a, vec3 b, double r, double y, double z)
{
    vec3 d = v3_sub(b, a), u = v3_scale(1 / v3_norm(d), d), e = v3(1, 0, 0);
    vec3 o = v3_sub(v3(0, y, z), a); // the point x = 0 of the line, from a
    vec3 p = v3_axpy(e, -u.x, u), q = v3_axpy(o, -v3_dot(o, u), u);
    double A = v3_dot(p, p), B = v3_dot(p, q), C = v3_dot(q, q) - r * r, D = B * B - A * C;
    struct chord k = { -INFINITY, INFINITY };
    if (A < 1e-14 ? C > 0 : D <= 0) return (struct chord){ INFINITY, -INFINITY };
    if (A >= 1e-14) k = (struct chord){ (-B - sqrt(D)) / A, (-B + sqrt(D)) / A };
    solid_cut(&k, u, v3_dot(u, b), y, z);
    solid_cut(&k, v3_scale(-1, u), -v3_dot(u, a), y, z);
    return k;
}

/* Over a face, out to `round`: between its plane and that one, and within its sides */
static struct chord solid_over_face(const struct shape *s, int32_t f, vec3 n, double y, double z)
{
    struct chord k = { -INFINITY, INFINITY };
    double at = v3_dot(n, s->vertex[s->corner[s->first[f]]]);
    solid_cut(&k, n, at + s->round, y, z);
    solid_cut(&k, v3_scale(-1, n), -at, y, z);
    for (int32_t i = s->first[f], end = s->first[f + 1]; i < end; i++) {
        vec3 a = s->vertex[s->corner[i]],
             b = s->vertex[s->corner[i + 1 < end ? i + 1 : s->first[f]]];
        vec3 out = v3_cross(v3_sub(b, a), n);
        solid_cut(&k, out, v3_dot(out, a), y, z);
    }
    return k;
}

static vec3 face_normal(const struct shape *s, int32_t f)
{
    vec3 n = v3(0, 0, 0);
    for (int32_t i = s->first[f], end = s->first[f + 1]; i < end; i++)
        n = v3_add(n, v3_cross(s->vertex[s->corner[i]],
                               s->vertex[s->corner[i + 1 < end ? i + 1 : s->first[f]]]));
    return v3_scale(1 / v3_norm(n), n);
}

/* All chords of a line; in[] has room for them. In the plane a side of the polygon is a face. */
static int find_chords(const struct shape *s, int dim, const vec3 *normal, double y, double z,
                       struct chord *in)
{
    int n = 0;
    for (int32_t i = 0; i < s->vertices; i++)
        in[n++] = solid_in_ball(s->vertex[i], shape_round(s, i), y, z);
    if (!shape_has_faces(s)) return n;
    struct chord core = { -INFINITY, INFINITY };
    for (int32_t f = 0; f < s->faces; f++)
        for (int32_t i = s->first[f], end = s->first[f + 1]; i < end; i++) {
            vec3 a = s->vertex[s->corner[i]],
                 b = s->vertex[s->corner[i + 1 < end ? i + 1 : s->first[f]]];
            // in the plane tubes are the strips beside the sides
            in[n++] = solid_in_tube(a, b, s->round, y, z);
            if (dim == 3) continue;
            vec3 out = v3(b.y - a.y, a.x - b.x, 0);
            solid_cut(&core, out, v3_dot(out, a), y, z);
        }
    for (int32_t f = 0; f < s->faces && dim == 3; f++) {
        solid_cut(&core, normal[f], v3_dot(normal[f], s->vertex[s->corner[s->first[f]]]), y, z);
        in[n++] = solid_over_face(s, f, normal[f], y, z);
    }
    in[n++] = core;
    return n;
}

static int compare_chords(const void *one, const void *other)
{
    const struct chord *a = one, *b = other;
    return (a->lo > b->lo) - (a->lo < b->lo);
}

/* What a line with this share of the section adds */
static void solid_add_line(struct solid_sums *t, struct chord *in, int n, double y, double z,
                           double share)
{
    int count = 0;
    for (int k = 0; k < n; k++)
        if (in[k].lo < in[k].hi) in[count++] = in[k];
    qsort(in, (size_t)count, sizeof *in, compare_chords);
    for (int k = 0; k < count;) {
        struct chord c = in[k++];
        while (k < count && in[k].lo <= c.hi) c.hi = fmax(c.hi, in[k++].hi);
        double a = c.lo, b = c.hi, m0 = share * (b - a), m1 = 0.5 * share * (b * b - a * a);
        double m2 = share / 3 * (b * b * b - a * a * a);
        t->volume += m0;
        t->first[0] += m1, t->first[1] += y * m0, t->first[2] += z * m0;
        t->second[0][0] += m2, t->second[0][1] += y * m1, t->second[0][2] += z * m1;
        t->second[1][1] += y * y * m0, t->second[1][2] += y * z * m0;
        t->second[2][2] += z * z * m0;
    }
}

static int solid_add_lines(struct solid_sums *t, const struct shape *s, int dim,
                           struct failure *failure)
{
    size_t room = (size_t)s->vertices + (size_t)s->corners + (size_t)s->faces + 2;
    struct chord *in = malloc(room * sizeof *in);
    vec3 *normal = malloc(((size_t)s->faces + 1) * sizeof *normal);
    if (!in || !normal) {
        free(in), free(normal);
        return failure_set(failure, EX_SOFTWARE, "no memory for a shape");
    }
    for (int32_t f = 0; f < s->faces && dim == 3; f++) normal[f] = face_normal(s, f);
    double lo[2] = { INFINITY, INFINITY }, hi[2] = { -INFINITY, -INFINITY };
    for (int32_t i = 0; i < s->vertices; i++) {
        double r = shape_round(s, i);
        lo[0] = fmin(lo[0], s->vertex[i].y - r), hi[0] = fmax(hi[0], s->vertex[i].y + r);
        lo[1] = fmin(lo[1], s->vertex[i].z - r), hi[1] = fmax(hi[1], s->vertex[i].z + r);
    }
    int n = dim == 2 ? LINES_PLANE : LINES_SPACE, m = dim == 2 ? 1 : n;
    double dy = (hi[0] - lo[0]) / n, dz = dim == 2 ? 1 : (hi[1] - lo[1]) / n;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < m; j++) {
            double y = lo[0] + (i + 0.5) * dy, z = dim == 2 ? 0 : lo[1] + (j + 0.5) * dz;
            solid_add_line(t, in, find_chords(s, dim, normal, y, z, in), y, z, dy * dz);
        }
    for (int i = 1; i < 3; i++)
        for (int j = 0; j < i; j++) t->second[i][j] = t->second[j][i];
    free(in), free(normal);
    return 0;
}

/* ---- a shape ---- */

static bool overlapping(const struct shape *s)
{
    for (int32_t i = 0; i < s->vertices; i++)
        for (int32_t j = 0; j < i; j++)
            if (v3_norm(v3_sub(s->vertex[i], s->vertex[j])) < s->ball[i] + s->ball[j]) return true;
    return false;
}

static void solid_add_faces(struct solid_sums *t, const struct shape *s, int dim)
{
    for (int32_t f = 0; f < s->faces; f++) {
        int32_t a = s->first[f], end = s->first[f + 1];
        for (int32_t i = a; i < end && dim == 2; i++)
            add_simplex(t, 2, s->vertex[s->corner[i]],
                        s->vertex[s->corner[i + 1 < end ? i + 1 : a]], v3(0, 0, 0));
        for (int32_t i = a + 2; i < end && dim == 3; i++)
            add_simplex(t, 3, s->vertex[s->corner[a]], s->vertex[s->corner[i - 1]],
                        s->vertex[s->corner[i]]);
    }
}

static int integrate(struct solid *out, const struct shape *s, int dim, struct failure *failure)
{
    struct solid_sums t = { 0 };
    bool lines = s->form == SHAPE_CLUMP ? overlapping(s) : s->form == SHAPE_HULL && s->round > 0;
    if (lines && solid_add_lines(&t, s, dim, failure)) return failure->status;
    if (!lines && s->form == SHAPE_HULL) solid_add_faces(&t, s, dim);
    if (s->form == SHAPE_CAPSULE) add_capsule(&t, dim, s->vertex[0], s->vertex[1], s->round);
    for (int32_t i = 0; i < s->vertices && !lines && s->form == SHAPE_CLUMP; i++)
        add_ball(&t, dim, s->vertex[i], s->ball[i]);
    *out = (struct solid){ .volume = t.volume };
    double m = 1 / t.volume;
    vec3 c = out->centre = v3(m * t.first[0], m * t.first[1], m * t.first[2]);
    memcpy(out->second, t.second, sizeof out->second);
    v3_outer(out->second, -t.volume, c, c);
    return 0;
}

/* The middle of the vertices where the origin is far from them, for there differences of large numbers would be
   taken; else the origin, so that what is described about it keeps its bits */
static vec3 near_to(const struct shape *s)
{
    vec3 lo = v3(INFINITY, INFINITY, INFINITY), hi = v3_scale(-1, lo);
    for (int32_t i = 0; i < s->vertices; i++)
        lo = v3_min(lo, s->vertex[i]), hi = v3_max(hi, s->vertex[i]);
    vec3 middle = v3_scale(0.5, v3_add(lo, hi));
    return v3_norm(middle) > 2 * v3_norm(v3_sub(hi, lo)) ? middle : v3(0, 0, 0);
}

int solid_of(struct solid *out, const struct shape *s, int dim, struct failure *failure)
{
    struct shape near = *s;
    vec3 o = near_to(s);
    near.vertex = calloc((size_t)s->vertices + 1, sizeof *near.vertex);
    if (!near.vertex) return failure_set(failure, EX_SOFTWARE, "no memory for a shape");
    for (int32_t i = 0; i < s->vertices; i++) near.vertex[i] = v3_sub(s->vertex[i], o);
    integrate(out, &near, dim, failure);
    out->centre = v3_add(out->centre, o);
    free(near.vertex);
    return failure->status;
}

/* ---- principal axes ---- */

/* Turns S so that it is diagonal [Jacobi]; axis[k] is the direction of S[k][k]. */
static void diagonalise(double S[3][3], vec3 axis[3])
{
    double V[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    double trace = S[0][0] + S[1][1] + S[2][2];
    for (int sweep = 0; sweep < JACOBI_SWEEPS; sweep++)
        for (int p = 0; p < 2; p++)
            for (int q = p + 1; q < 3; q++) {
                if (fabs(S[p][q]) <= 1e-16 * trace) continue;
                double a = (S[q][q] - S[p][p]) / (2 * S[p][q]);
                double t = copysign(1, a) / (fabs(a) + sqrt(a * a + 1));
                double c = 1 / sqrt(t * t + 1), s = t * c;
                for (int k = 0; k < 3; k++) {
                    double x = S[k][p], y = S[k][q];
                    S[k][p] = c * x - s * y, S[k][q] = s * x + c * y;
                }
                for (int k = 0; k < 3; k++) {
                    double x = S[p][k], y = S[q][k], u = V[k][p], v = V[k][q];
                    S[p][k] = c * x - s * y, S[q][k] = s * x + c * y;
                    V[k][p] = c * u - s * v, V[k][q] = s * u + c * v;
                }
            }
    for (int k = 0; k < 3; k++) axis[k] = v3(V[0][k], V[1][k], V[2][k]);
}

/* The rotation that takes x, y, z to three axes */
static quat rotation_to(const vec3 e[3])
{
    double xx = e[0].x, yy = e[1].y, zz = e[2].z;
    quat q = { 1 + xx + yy + zz, e[1].z - e[2].y, e[2].x - e[0].z, e[0].y - e[1].x };
    if (q.w < 0.25) { // the largest of four, of which at least one is 1
        if (xx >= yy && xx >= zz)
            q = (quat){ q.x, 1 + xx - yy - zz, e[0].y + e[1].x, e[2].x + e[0].z };
        else if (yy >= zz)
            q = (quat){ q.y, e[0].y + e[1].x, 1 - xx + yy - zz, e[1].z + e[2].y };
        else
            q = (quat){ q.z, e[2].x + e[0].z, e[1].z + e[2].y, 1 - xx - yy + zz };
    }
    return quat_unit(q);
}

static quat principal_axes(double S[3][3], int dim)
{
    double trace = S[0][0] + S[1][1] + S[2][2];
    double off = fmax(fabs(S[0][1]), fmax(fabs(S[0][2]), fabs(S[1][2])));
    vec3 axis[3];
    if (dim == 2 || off <= AXES_THERE * trace) return (quat){ 1, 0, 0, 0 };
    diagonalise(S, axis);
    axis[2] = v3_cross(axis[0], axis[1]); // right-handed; its sign means nothing
    return rotation_to(axis);
}

/* Moments that differ by rounding are the same, so that a cube turns as a ball does. */
static void even_out(double m[3])
{
    for (int k = 0; k < 3; k++) {
        int l = (k + 1) % 3;
        if (fabs(m[k] - m[l]) < AXES_THERE * m[k]) m[k] = m[l] = fmin(m[k], m[l]);
    }
}

int solid_settle(struct shape *s, int dim, struct solid_frame *was, struct failure *failure)
{
    struct solid o = { 0 };
    return solid_of(&o, s, dim, failure) ? failure->status
                                         : solid_settle_as(s, dim, &o, was, failure);
}

int solid_settle_as(struct shape *s, int dim, const struct solid *of, struct solid_frame *was,
                    struct failure *failure)
{
    struct solid o = *of;
    double reach = 0;
    if (!v3_finite(o.centre)) return failure_set(failure, EX_DATAERR, "has no volume");
    for (int32_t i = 0; i < s->vertices; i++) {
        double r = shape_round(s, i);
        reach = fmax(reach, v3_norm(v3_sub(s->vertex[i], o.centre)) + r);
    }
    double size = dim == 2 ? reach * reach : reach * reach * reach;
    if (o.volume < 0) return failure_set(failure, EX_DATAERR, "is turned inside out");
    if (!(o.volume > FLAT * size))
        return failure_set(failure, EX_DATAERR, "is flat: it has no volume");
    *was = (struct solid_frame){ reach, o.centre, principal_axes(o.second, dim) };
    double unit = 1 / reach;
    for (int32_t i = 0; i < s->vertices; i++) {
        vec3 x = v3_scale(unit, quat_turn_back(was->turn, v3_sub(s->vertex[i], o.centre)));
        s->vertex[i] = dim == 2 ? v3(x.x, x.y, 0) : x;
        s->ball[i] *= unit;
    }
    s->round *= unit;
    s->volume = o.volume / size;
    double k = 1 / (o.volume * reach * reach), d[3];
    for (int i = 0; i < 3; i++) d[i] = k * o.second[i][i];
    for (int i = 0; i < 3; i++) s->moment[i] = d[(i + 1) % 3] + d[(i + 2) % 3];
    if (dim == 2) s->moment[0] = s->moment[1] = s->moment[2] = d[0] + d[1];
    even_out(s->moment);
    return 0;
}
