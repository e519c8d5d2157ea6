/* base/jordan.c: products, steps, centring and scaling of one second-order cone. */
#include "base/jordan.h"

void jordan_product(const double a[3], const double b[3], double out[3])
{
    out[0] = jordan_dot(a, b);
    out[1] = a[0] * b[1] + b[0] * a[1], out[2] = a[0] * b[2] + b[0] * a[2];
}

void jordan_quotient(const double l[3], const double c[3], double out[3])
{
    out[0] = (l[0] * c[0] - l[1] * c[1] - l[2] * c[2]) / jordan_det(l);
    out[1] = (c[1] - l[1] * out[0]) / l[0], out[2] = (c[2] - l[2] * out[0]) / l[0];
}

double jordan_to_border(const double x[3], const double dx[3])
{
    double a = jordan_det(dx), b = x[0] * dx[0] - x[1] * dx[1] - x[2] * dx[2], c = jordan_det(x);
    double root = b * b - a * c, step = INFINITY;
    if (root >= 0) {
        double r = sqrt(root), first = c / (-b + r), second = c / (-b - r);
        if (first > 0) step = fmin(step, first);
        if (second > 0) step = fmin(step, second);
    }
    return dx[0] < 0 ? fmin(step, -x[0] / dx[0]) : step;
}

void jordan_centre(double x[3], double z[3], double gap)
{
    double tau[3] = { x[0] - z[0], x[1] - z[1], x[2] - z[2] }, t = jordan_tail(tau);
    double f[2]; // eigenvalues of x; z's are gap / f
    for (int k = 0; k < 2; k++) {
        double l = k ? tau[0] - t : tau[0] + t, root = sqrt(l * l + 4 * gap);
        f[k] = l > 0 ? (l + root) / 2 : 2 * gap / (root - l);
    }
    double xt = (f[0] - f[1]) / 2, zt = (gap / f[0] - gap / f[1]) / 2;
    x[0] = (f[0] + f[1]) / 2, z[0] = (gap / f[0] + gap / f[1]) / 2;
    for (int k = 1; k < 3; k++) {
        x[k] = t > 0 ? xt * tau[k] / t : 0;
        z[k] = t > 0 ? zt * tau[k] / t : 0;
    }
}

bool scaling_of(struct scaling *F, const double x[3], const double z[3])
{
    double dx = jordan_det(x), dz = jordan_det(z);
    if (!(dx > 0) || !(dz > 0)) return false;
    double rx = 1 / sqrt(dx), rz = 1 / sqrt(dz);
    double g = sqrt((1 + jordan_dot(x, z) * rx * rz) / 2);
    double w[3] = { (z[0] * rz + x[0] * rx) / (2 * g), (z[1] * rz - x[1] * rx) / (2 * g),
                    (z[2] * rz - x[2] * rx) / (2 * g) };
    double n = 1 / sqrt(2 * (w[0] + 1));
    F->v[0] = (w[0] + 1) * n, F->v[1] = w[1] * n, F->v[2] = w[2] * n;
    F->eta = sqrt(sqrt(dz / dx));
    return isfinite(F->eta);
}

void scaling_apply(const struct scaling *F, const double a[3], double out[3])
{
    double s = 2 * jordan_dot(F->v, a);
    out[0] = F->eta * (s * F->v[0] - a[0]);
    out[1] = F->eta * (s * F->v[1] + a[1]), out[2] = F->eta * (s * F->v[2] + a[2]);
}

void scaling_inverse(const struct scaling *F, const double a[3], double out[3])
{
    const struct scaling inverse = { { F->v[0], -F->v[1], -F->v[2] }, 1 / F->eta };
    scaling_apply(&inverse, a, out);
}
