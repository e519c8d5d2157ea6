#include "measure/ball_part.h"

#include <math.h>

double ball_volume(int dim, double radius)
{
    return dim == 2 ? M_PI * radius * radius : 4.0 / 3 * M_PI * radius * radius * radius;
}

/* acos and asin where rounding may have led beyond 1 */
static double arc_cos(double x)
{
    return acos(fmin(fmax(x, -1), 1));
}
static double arc_sin(double x)
{
    return asin(fmin(fmax(x, -1), 1));
}
static double root_of(double x)
{
    return sqrt(fmax(x, 0));
}

/* The area of the disc x^2 + y^2 < r^2 with x > a, y > b; a, b >= 0 */
static double quadrant(double r, double a, double b)
{
    if (!(a * a + b * b < r * r)) return 0;
    return 0.5 * r * r * (arc_cos(b / r) - arc_sin(a / r)) - 0.5 * b * root_of(r * r - b * b) -
           0.5 * a * root_of(r * r - a * a) + a * b;
}

/* The exterior angle between the circles x = a and y = b on the unit sphere, of x > a, y > b */
static double corner(double a, double b)
{
    return arc_cos(-a * b / sqrt((1 - a * a) * (1 - b * b)));
}

/* The arc of the circle x = a on the unit sphere with y > b, z > c, an angle */
static double arc(double a, double b, double c)
{
    double rho = root_of(1 - a * a);
    return 0.5 * M_PI - arc_sin(b / rho) - arc_sin(c / rho);
}

/* The unit ball with x > a, y > b, z > c, all >= 0 */
static double octant(double a, double b, double c)
{
    if (!(a * a + b * b + c * c < 1)) return 0;
    double S = 2 * M_PI - corner(a, b) - corner(b, c) - corner(c, a);
    S -= a * arc(a, b, c) + b * arc(b, c, a) + c * arc(c, a, b);
    double flat = a * quadrant(root_of(1 - a * a), b, c) + b * quadrant(root_of(1 - b * b), c, a) +
                  c * quadrant(root_of(1 - c * c), a, b);
    return fmax((S - flat) / 3, 0);
}

/* The unit ball or disc with x[k] > a[k] for all k < dim. A bound of -1 or less is none. */
static double ball_part_beyond(int dim, const double a[3])
{
    double b[3] = { a[0], a[1], dim == 3 ? a[2] : 0 }, whole[3] = { a[0], a[1], a[2] };
    int times = 1;
    for (int k = 0; k < 3 && k < dim; k++) {
        if (a[k] >= 1) return 0;
        if (a[k] <= -1) {
            b[k] = 0, times *= 2; // both halves, mirrored
        } else if (a[k] < 0) {
            double mirrored[3] = { a[0], a[1], a[2] };
            mirrored[k] = -a[k], whole[k] = -1;
            return ball_part_beyond(dim, whole) - ball_part_beyond(dim, mirrored);
        }
    }
    return times * (dim == 3 ? octant(b[0], b[1], b[2]) : quadrant(1, b[0], b[1]));
}

double ball_in_box(int dim, vec3 x, double radius, const double lo[3], const double hi[3])
{
    const double at[3] = { x.x, x.y, x.z };
    double bound[2][3], sum = 0, unit = radius * radius * (dim == 3 ? radius : 1);
    int inside = 1;
    for (int k = 0; k < 3 && k < dim; k++) {
        bound[0][k] = (lo[k] - at[k]) / radius, bound[1][k] = (hi[k] - at[k]) / radius;
        if (!(bound[0][k] < 1 && bound[1][k] > -1 && bound[0][k] < bound[1][k])) return 0;
        inside = inside && bound[0][k] <= -1 && bound[1][k] >= 1;
    }
    if (inside) return ball_volume(dim, radius);
    for (int corners = 0; corners < 1 << dim; corners++) {
        double a[3] = { 0, 0, 0 };
        int sign = 1;
        for (int k = 0; k < 3 && k < dim; k++) {
            int side = corners >> k & 1;
            a[k] = bound[side][k];
            if (side) sign = -sign;
        }
        sum += sign * ball_part_beyond(dim, a);
    }
    return fmax(sum, 0) * unit;
}

/* The area that two discs of radii r and R share, their centres d apart */
static double lens(double d, double r, double R)
{
    if (d >= r + R) return 0;
    if (d <= fabs(R - r)) return M_PI * fmin(r, R) * fmin(r, R);
    double x = (d * d + r * r - R * R) / (2 * d), y = d - x; // of the chord, from either centre
    return r * r * arc_cos(x / r) - x * root_of(r * r - x * x) + R * R * arc_cos(y / R) -
           y * root_of(R * R - y * y);
}

/* Legendre's polynomial of degree n at x, and its derivative, by its recurrence */
static double legendre(int n, double x, double *slope)
{
    double before = 1, now = x;
    for (int k = 2; k <= n; k++) {
        double next = ((2 * k - 1) * x * now - (k - 1) * before) / k;
        before = now, now = next;
    }
    *slope = n * (x * now - before) / (x * x - 1);
    return now;
}

double ball_in_cylinder(int dim, double d, double radius, double R)
{
    enum { POINTS = 32 };
    if (dim == 2) return lens(d, radius, R);
    if (d >= radius + R) return 0;
    if (d + radius <= R) return ball_volume(3, radius);
    double sum = 0;
    for (int k = 0; k < POINTS / 2; k++) { // slices at z = radius x: mirrored, twice
        double x = cos(M_PI * (k + 0.75) / (POINTS + 0.5)), slope;
        for (int i = 0; i < 4; i++) x -= legendre(POINTS, x, &slope) / slope;
        legendre(POINTS, x, &slope);
        sum += 4 / ((1 - x * x) * slope * slope) * lens(d, radius * root_of(1 - x * x), R);
    }
    return sum * radius;
}
