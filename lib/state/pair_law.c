/* state/pair_law.c: the checks of a pair's law, and the liquid bridge [state/pair_law.h]. */
#include "state/pair_law.h"

#include "base/vec.h"

#include <math.h>
#include <stddef.h>

const struct law_name law_names[] = {
    { "cohesion", pair_law_coheres }, { "capillary", pair_law_wets },
    { "rolling", pair_law_rolls },    { "stiffness", pair_law_springs },
    { "adhesion", pair_law_adheres }, { 0 },
};

bool pair_law_acts(const struct pair_law *l)
{
    bool any = l->impact > 0;
    for (const struct law_name *k = law_names; k->name; k++) any = any || k->is_of(l);
    return any;
}

const char *pair_law_trouble(const struct pair_law *l)
{
    if (!(l->wetting < M_PI / 2)) return "the wetting angle must lie in [0, pi/2)";
    if (l->w > 0 && !(l->cn > 0)) return "the stiffness of a bond must be positive";
    if (!(l->impact < IMPACT_LAWS) || l->impact != floor(l->impact))
        return "an impact is Newton's or bounded: 0, 1 or 2";
    if ((l->kn > 0) != (l->kt > 0))
        return "the stiffness of a contact must be positive along n and across, or 0 for both";
    if (l->soft > 0 && !(l->soft >= COMPLIANCE_LEAST))
        return "the compliance of a contact must be 0 or at least 1e-9";
    return NULL;
}

double bridge_radius(double a, double b)
{
    return a > 0 ? 2 * a * b / (a + b) : 2 * b;
}

double bridge_reach(const struct pair_law *l)
{
    return pair_law_wets(l) ? (1 + l->wetting / 2) * cbrt(l->volume) : 0;
}

/* N: with which bodies that touch are pulled together. The cosine is not libm's, whose last bits differ
   between machines, as those of its hypot do. */
static double at_touch(const struct pair_law *l, double R)
{
    return 2 * M_PI * R * l->tension * quat_rotation(v3(2 * l->wetting, 0, 0)).w;
}

static double hypotenuse(double g, double c)
{
    return sqrt(g * g + c * c);
}

double bridge_force(const struct pair_law *l, double R, double g)
{
    double c = sqrt(2 * l->volume / (M_PI * R));
    if (g <= 0) return at_touch(l, R);
    return g >= bridge_reach(l) ? 0 : at_touch(l, R) * (1 - g / hypotenuse(g, c));
}

double bridge_energy(const struct pair_law *l, double R, double g)
{
    double c = sqrt(2 * l->volume / (M_PI * R)), end = bridge_reach(l);
    if (g >= end) return 0;
    double apart = fmax(g, 0), overlap = fmin(g, 0);
    // the integral of 1 - g/hypot(g, c) is g - hypot(g, c), here without its cancellation
    double rest = c * c / (apart + hypotenuse(apart, c)) - c * c / (end + hypotenuse(end, c));
    return at_touch(l, R) * (overlap - rest);
}
