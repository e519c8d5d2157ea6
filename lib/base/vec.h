/* base/vec.h: vectors and rotations of space, passed by value. */
#pragma once

#include <math.h>

/* The larger and the smaller of two numbers. Where b is NaN the result is a. Inline, because libm's fmax and fmin are
   calls, which cost time in loops over all bodies. */
static inline double dmax(double a, double b)
{
    return b > a ? b : a;
}
static inline double dmin(double a, double b)
{
    return b < a ? b : a;
}

typedef struct {
    double x, y, z;
} vec3;

typedef struct {
    double w, x, y, z; /* unit quaternion w + xi + yj + zk: a rotation */
} quat;

static inline vec3 v3(double x, double y, double z)
{
    return (vec3){ x, y, z };
}
static inline vec3 v3_add(vec3 a, vec3 b)
{
    return v3(a.x + b.x, a.y + b.y, a.z + b.z);
}
static inline vec3 v3_sub(vec3 a, vec3 b)
{
    return v3(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline vec3 v3_scale(double s, vec3 a)
{
    return v3(s * a.x, s * a.y, s * a.z);
}
/* a + s b */
static inline vec3 v3_axpy(vec3 a, double s, vec3 b)
{
    return v3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}
/* The smaller, and the larger, of each component */
static inline vec3 v3_min(vec3 a, vec3 b)
{
    return v3(dmin(a.x, b.x), dmin(a.y, b.y), dmin(a.z, b.z));
}
static inline vec3 v3_max(vec3 a, vec3 b)
{
    return v3(dmax(a.x, b.x), dmax(a.y, b.y), dmax(a.z, b.z));
}
static inline double v3_dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline double v3_norm(vec3 a)
{
    return sqrt(v3_dot(a, a));
}
static inline vec3 v3_cross(vec3 a, vec3 b)
{
    return v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
/* t += s a b^T */
static inline void v3_outer(double t[3][3], double s, vec3 a, vec3 b)
{
    const double p[3] = { s * a.x, s * a.y, s * a.z }, q[3] = { b.x, b.y, b.z };
    for (int k = 0; k < 9; k++) t[k / 3][k % 3] += p[k / 3] * q[k % 3];
}
/* A unit vector across the unit vector n, the same for the same n */
static inline vec3 v3_across(vec3 n)
{
    vec3 e = fabs(n.x) < 0.7 ? v3(1, 0, 0) : v3(0, 1, 0), s = v3_axpy(e, -v3_dot(e, n), n);
    return v3_scale(1 / v3_norm(s), s);
}

static inline int v3_finite(vec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

static inline quat quat_mul(quat a, quat b)
{
    return (quat){ a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
                   a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                   a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                   a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w };
}

static inline quat quat_unit(quat q)
{
    double s = 1 / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return (quat){ s * q.w, s * q.x, s * q.y, s * q.z };
}

/* q applied to a, and its inverse */
static inline vec3 quat_turn(quat q, vec3 a)
{
    vec3 u = v3(q.x, q.y, q.z), t = v3_scale(2, v3_cross(u, a));
    return v3_add(v3_axpy(a, q.w, t), v3_cross(u, t));
}
static inline vec3 quat_turn_back(quat q, vec3 a)
{
    return quat_turn((quat){ q.w, -q.x, -q.y, -q.z }, a);
}

/*
 * The rotation by the vector a (rad), the exponential map: by its series up to an angle of 1,
 * beyond by halving the angle and squaring. Not by libm: its last bits differ on machines without
 * FMA.
 */
static inline quat quat_rotation(vec3 a)
{
    double h = v3_dot(a, a) / 4, s = 0.5; // the square of half the angle
    int halvings = 0;
    if (h == 0) return (quat){ 1, s * a.x, s * a.y, s * a.z }; // as below: 20 quotients are saved
    for (; h > 0.25 && h < INFINITY; halvings++) h /= 4, s /= 2;
    s *= 1 - h / 6 * (1 - h / 20 * (1 - h / 42 * (1 - h / 72 * (1 - h / 110 * (1 - h / 156)))));
    double c = 1 - h / 132 * (1 - h / 182);
    c = 1 - h / 2 * (1 - h / 12 * (1 - h / 30 * (1 - h / 56 * (1 - h / 90 * c))));
    quat q = { c, s * a.x, s * a.y, s * a.z };
    for (; halvings > 0; halvings--) q = quat_unit(quat_mul(q, q));
    return q;
}

/* The rotation that takes the unit vector `from` to `to` the short way, of a vector x across `from`; 0 where it is more
   than nearly half a turn */
static inline vec3 v3_turn_along(vec3 from, vec3 to, vec3 x)
{
    vec3 axis = v3_cross(from, to);
    double c = v3_dot(from, to);
    if (!(c > -0.999)) return v3(0, 0, 0);
    // Rodrigues: x + axis x x + axis x (axis x x)/(1 + c)
    vec3 y = v3_cross(axis, x);
    return v3_axpy(v3_add(x, y), 1 / (1 + c), v3_cross(axis, y));
}
