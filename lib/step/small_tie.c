/* step/small_tie.c: attraction and static friction of pairs of materials [step/small_tie.h]. */
#include "step/small_tie.h"

#include "contact/contact_law.h"

#include <math.h>

bool small_tie_holds(const struct packing *p)
{
    bool any = false;
    for (int32_t k = 0; p->law && k < p->materials * p->materials; k++)
        any = any || pair_law_coheres(&p->law[k]) || pair_law_wets(&p->law[k]);
    return any;
}

/* N: the most that a pair of materials attracts by, of the largest bodies */
static double tie_force(const struct packing *p, const struct pair_law *l)
{
    const double bridge = pair_law_wets(l) ? bridge_force(l, 2 * packing_whole(p).large, 0) : 0;
    return (pair_law_coheres(l) ? l->cohesion : 0) + bridge;
}

/* kg: 0 where no body moves */
static double lightest_of(const struct packing *p)
{
    double least = INFINITY;
    for (int64_t i = 0; i < p->n; i++)
        if (p->mass[i] > 0) least = fmin(least, p->mass[i]);
    return least < INFINITY ? least : 0;
}

double small_tie_most(const struct packing *p)
{
    double most = 0;
    for (int32_t k = 0; p->law && k < p->materials * p->materials; k++)
        most = fmax(most, tie_force(p, &p->law[k]));
    const double mass = most > 0 ? lightest_of(p) : 0;
    return mass > 0 ? most / mass : 0;
}

double small_tie_range(const struct packing *p, double h)
{
    double range = 0;
    if (!small_tie_holds(p)) return 0;
    for (int32_t k = 0; k < p->materials * p->materials; k++)
        if (pair_law_coheres(&p->law[k])) range = fmax(range, p->law[k].range);
    return fmax(range, contact_laws_touch_most(p)) + 2 * h * h * small_tie_most(p);
}

double small_tie_reach(const struct packing *p)
{
    return small_tie_holds(p) || packing_adheres(p) ? contact_laws_reach(p) : 0;
}

double small_tie_speed(const struct packing *p)
{
    const double a = small_tie_most(p);
    return fmin(p->dt * a, sqrt(2 * a * small_tie_reach(p)));
}

void small_tie_set(double x[HOLD_COUNT], const struct packing *p, int32_t a, int32_t b, double h)
{
    const struct pair_law *l = &p->law[packing_pair(p, a, b)];
    const struct contact c = { .a = a, .b = b };
    const double R = bridge_radius(a < 0 ? 0 : p->radius[a], p->radius[b]);
    double w = p->mass[b] > 0 ? 1 / p->mass[b] : 0;
    if (a >= 0 && p->mass[a] > 0) w += 1 / p->mass[a];
    for (int k = 0; k < HOLD_COUNT; k++) x[k] = 0;
    x[HOLD_COHESION] = pair_law_coheres(l) ? l->cohesion : 0;
    x[HOLD_BRIDGE] = pair_law_wets(l) ? bridge_force(l, R, 0) : 0;
    x[HOLD_TOUCH] = contact_laws_touch(p, &c);
    x[HOLD_RANGE] = fmax(l->range, x[HOLD_TOUCH] + 0.5 * h * h * w * x[HOLD_COHESION]);
    x[HOLD_C2] = x[HOLD_BRIDGE] > 0 ? 2 * l->volume / (M_PI * R) : 1;
    x[HOLD_REACH] = bridge_reach(l);
}

void small_tie_stick(double mu[2], double *v_s, const struct packing *p, int32_t pair)
{
    const bool sticks = p->mu_s[pair] > p->mu[pair];
    mu[0] = sticks ? p->mu_s[pair] : p->mu[pair], mu[1] = p->mu[pair];
    *v_s = sticks ? p->v_s[pair] : 0;
}
