/* The algebra of the second-order cone, against what defines it. */
#include "base/jordan.h"

#include "tap.h"

#include <gsl/gsl_rng.h>

static gsl_rng *rng;

static double number(double least, double most)
{
    return least + (most - least) * gsl_rng_uniform(rng);
}

/* Inside K, the eigenvalues from 1e-6 to 1 */
static void inside(double x[3])
{
    double angle = number(0, 6.3), l = pow(10, number(-6, 0)), h = l + pow(10, number(-6, 0));
    x[0] = (h + l) / 2, x[1] = (h - l) / 2 * cos(angle), x[2] = (h - l) / 2 * sin(angle);
}

static double apart(const double a[3], const double b[3])
{
    double e = 0, size = 0;
    for (int k = 0; k < 3; k++) e += (a[k] - b[k]) * (a[k] - b[k]), size += a[k] * a[k];
    return sqrt(e / size);
}

int main(void)
{
    double scaled = 0, back = 0, divided = 0, border = 0, centred = 0, kept = 0;
    rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int i = 0; i < 10000; i++) {
        double x[3], z[3], dx[3], a[3], b[3], l[3];
        struct scaling F;
        inside(x), inside(z);
        for (int k = 0; k < 3; k++) dx[k] = number(-1, 1);
        if (!scaling_of(&F, x, z)) {
            scaled = INFINITY;
            break;
        }
        scaling_apply(&F, x, l), scaling_inverse(&F, z, a);
        scaled = fmax(scaled, apart(l, a));
        scaling_apply(&F, dx, a), scaling_inverse(&F, a, b);
        back = fmax(back, apart(dx, b) / (jordan_dot(F.v, F.v)));
        jordan_quotient(l, dx, a), jordan_product(l, a, b);
        divided = fmax(divided, apart(dx, b) * jordan_det(l) / (l[0] * l[0]));
        double step = jordan_to_border(x, dx);
        for (int k = 0; k < 3; k++) a[k] = x[k] + fmin(step, 1e9) * dx[k];
        double least = a[0] - jordan_tail(a);
        border = fmax(border, step < INFINITY ? fabs(least) / (x[0] + step) : least < 0);
        double gap = pow(10, number(-12, 0)), tau[3];
        for (int k = 0; k < 3; k++) tau[k] = x[k] - z[k], a[k] = x[k], b[k] = z[k];
        jordan_centre(a, b, gap);
        double p[3], g[3] = { gap, 0, 0 };
        jordan_product(a, b, p);
        centred = fmax(centred, fabs(p[0] - g[0]) / (gap + 1e-15 * a[0] * b[0]));
        for (int k = 0; k < 3; k++) kept = fmax(kept, fabs(a[k] - b[k] - tau[k]));
    }
    ok(scaled < 1e-6, "F x = F^-1 z, to %.1e", scaled);
    ok(back < 1e-10, "F^-1 F = 1, to %.1e", back);
    ok(divided < 1e-10, "l o (c / l) = c, to %.1e", divided);
    ok(border < 1e-9, "a step ends on the border, to %.1e", border);
    ok(centred < 1e-3, "x o z = gap where centred, to %.1e", centred);
    ok(kept < 1e-12, "x - z as it was, to %.1e", kept);
    double x[3] = { 1, 1, 0 }, z[3] = { 1, 0, 0 };
    struct scaling F;
    ok(!scaling_of(&F, x, z), "on the border there is no scaling");
    gsl_rng_free(rng);
    return tap_done();
}
