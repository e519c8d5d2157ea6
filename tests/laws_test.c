/* The laws beyond friction and restitution by themselves: forces are the slopes of energies, the
   damage of a bond follows its equation. */
#include "bodies/tie.h"
#include "tap.h"

#include <math.h>

/* The largest difference between a bridge's force and the slope of its energy, relative */
static double slope_error(const struct law *l, double R)
{
    double worst = 0, most = bridge_force(l, R, 0), end = bridge_reach(l), h = 1e-6 * end;
    for (int k = 1; k < 1000; k++) {
        double g = end * k / 1000;
        double slope = (bridge_energy(l, R, g + h) - bridge_energy(l, R, g - h)) / (2 * h);
        worst = fmax(worst, fabs(slope - bridge_force(l, R, g)) / most);
    }
    return worst;
}

static void test_bridge(void)
{
    const struct law l = { .volume = 2e-10, .tension = 0.072, .wetting = 0.4 };
    double R = bridge_radius(1e-3, 3e-3), end = bridge_reach(&l);
    ok(fabs(R - 1.5e-3) < 1e-18, "R of two balls is their harmonic mean");
    ok(fabs(bridge_radius(1e9, 3e-3) / bridge_radius(0, 3e-3) - 1) < 1e-6,
       "a boundary is a very large ball");
    ok(slope_error(&l, R) < 1e-6, "a bridge's force is the slope of its energy");
    ok(bridge_energy(&l, R, end) == 0 && bridge_force(&l, R, end) == 0, "it ruptures");
    double touch = 2 * M_PI * R * l.tension * cos(l.wetting);
    ok(fabs(bridge_force(&l, R, 0) / touch - 1) < 1e-14 && bridge_force(&l, R, -1e-6) == touch,
       "where bodies touch it pulls with 2 pi R sigma cos(theta)");
    // Rabinovich, Esayanur & Moudgil 2005, the other way to write it: 1/(1 + g/(2 d))
    double g = 0.3 * end, d = g / 2 * (-1 + sqrt(1 + 2 * l.volume / (M_PI * R * g * g)));
    ok(fabs(bridge_force(&l, R, g) / (touch / (1 + g / (2 * d))) - 1) < 1e-12,
       "apart with the closed form");
}

int main(void)
{
    test_bridge();
    return tap_done();
}
