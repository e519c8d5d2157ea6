/*
 * base/jordan.h: the second-order cone K = { |x_t| <= x_0 } of three numbers and its Jordan
 * algebra,
 *
 *     x o z = (x.z, x_0 z_t + z_0 x_t),
 *
 * whose eigenvalues are x_0 +- |x_t|; and the scaling of Nesterov and Todd, a symmetric F that maps
 * x and z, both inside K, to one point l = F x = F^-1 z.
 */
#pragma once

#include <math.h>
#include <stdbool.h>

/* |x_t| */
static inline double jordan_tail(const double x[3])
{
    return sqrt(x[1] * x[1] + x[2] * x[2]);
}

static inline double jordan_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* x_0^2 - |x_t|^2 */
static inline double jordan_det(const double x[3])
{
    double t = jordan_tail(x);
    return (x[0] - t) * (x[0] + t);
}

/* out = a o b */
void jordan_product(const double a[3], const double b[3], double out[3]);
/* out such that l o out = c; l inside K */
void jordan_quotient(const double l[3], const double c[3], double out[3]);

/* The largest a for which x + a dx is in K, x inside K; INFINITY if there is none. */
double jordan_to_border(const double x[3], const double dx[3]);

/* Moves x and z to the point of the central path, x o z = gap (1, 0, 0), with the same x - z. */
void jordan_centre(double x[3], double z[3], double gap);

/* F = eta (2 v v' - J), J = diag(1, -1, -1) */
struct scaling {
    double v[3], eta;
};

/* F = that of x and z; false where one of them is too near the border of K. */
bool scaling_of(struct scaling *F, const double x[3], const double z[3]);
/* out = F a; out = F^-1 a */
void scaling_apply(const struct scaling *F, const double a[3], double out[3]);
void scaling_inverse(const struct scaling *F, const double a[3], double out[3]);
