/* step/small_stiff.c: what stiffnesses and bonds of materials make of a pair [step/small_stiff.h]. */
#include "step/small_stiff.h"

#include "contact/contact_law.h"
#include "contact/spring.h"
#include "state/rotation.h"

#include <math.h>
#include <stdlib.h>

/* k h^2 W of a contact at most: 16 small steps in an impact without damping */
#define RESOLVED 0.04
/* Small steps of a step: one whose springs need more is made at once, as many would cost more than its solve */
enum { SPRINGS_MOST = 1000 };
/* Restitution at least, and damping ratios at most */
#define E_LEAST   0.01
#define ZETA_MOST 20.0
/* Steps of the oscillator that they are sought with, in units of 1/frequency; between, they are linear */
static const double STEP[2] = { 0.01, 0.2 };
enum { BISECTIONS = 40 };

/* ---- what pairs of materials give ---- */

/* Of a pair alone, whose spring is damped by zeta: its speed when it parts, in units of that before, in steps of h. It has touched
   half a step before the first one. */
static double rebound(double zeta, double h)
{
    double x = -0.5 * h, u = -1;
    while (x < 0) {
        const double next = (u - h * x) / (1 + 2 * zeta * h);
        if (!(next > u)) break;
        u = next, x += h * u;
    }
    return u > 0 ? u : 0;
}

static void set_zeta(double zeta[2], double e)
{
    for (int j = 0; j < 2 && e < 1; j++) {
        double lo = 0, hi = ZETA_MOST;
        for (int k = 0; k < BISECTIONS; k++) {
            const double is = 0.5 * (lo + hi);
            *(rebound(is, STEP[j]) > fmax(e, E_LEAST) ? &lo : &hi) = is;
        }
        zeta[j] = hi;
    }
}

struct small_stiffness *small_stiff_table(const struct packing *p, double interval)
{
    const int32_t n = p->materials * p->materials;
    struct small_stiffness *table = calloc((size_t)n + 1, sizeof *table);
    for (int32_t k = 0; table && k < n; k++) {
        struct small_stiffness *y = &table[k];
        if (!pair_law_springs(&p->law[k])) continue;
        y->kn = p->law[k].kn, y->kt = p->law[k].kt;
        y->soft = p->law[k].soft * interval * interval;
        set_zeta(y->zeta[0], p->en[k]), set_zeta(y->zeta[1], p->et[k]);
    }
    return table;
}

bool small_stiff_acts(const struct packing *p)
{
    return packing_has_springs(p) || packing_adheres(p);
}

/* kg: h times what a dashpot pushes by for each m/s */
static double damping(const double zeta[2], double h, double k, double w)
{
    const double step = h * sqrt(k * w), part = fmin(1, step / STEP[1]);
    return 2 * (zeta[0] + part * (zeta[1] - zeta[0])) * step / w;
}

double small_stiff_area(const struct packing *p, int32_t a, int32_t b)
{
    const struct contact c = { .a = a, .b = b };
    return pair_law_adheres(&p->law[packing_pair(p, a, b)]) ? contact_laws_area(p, &c) : 0;
}

void small_stiff_bond(double x[SPRING_COUNT], const struct packing *p, int32_t a, int32_t b,
                      double S)
{
    const struct pair_law *l = &p->law[packing_pair(p, a, b)];
    const struct contact c = { .a = a, .b = b };
    x[SPRING_SN] = p->dt * S * l->cn, x[SPRING_ST] = p->dt * S * l->ct;
    x[SPRING_SW] = S * l->w, x[SPRING_SETA] = S * l->eta;
    x[SPRING_FRESH] = S > 0 && l->forever ? l->beta : 0,
    x[SPRING_TOUCH] = contact_laws_touch(p, &c);
}

void small_stiff_set(double x[SPRING_COUNT], const struct small_stiffness *table,
                     const struct packing *p, int32_t a, int32_t b, double wn, double wt)
{
    const struct small_stiffness *k = &table[packing_pair(p, a, b)];
    const double h = p->dt, W = packing_inverse_mass(p, a) + packing_inverse_mass(p, b);
    double kn = k->kn, kt = k->kt;
    if (k->soft > 0) kn = 1 / (k->soft * W), kt = SPRING_ACROSS * kn;
    x[SPRING_KN] = x[SPRING_KT] = x[SPRING_GN] = x[SPRING_GT] = 0;
    x[SPRING_YIELD] = a < 0 && p->wall[-1 - a].load.way ? h : 0;
    small_stiff_bond(x, p, a, b, small_stiff_area(p, a, b));
    if (!(kn > 0) || !isfinite(kn)) return;
    x[SPRING_KN] = h * kn, x[SPRING_KT] = h * kt;
    x[SPRING_GN] = damping(k->zeta[0], h, kn, wn);
    x[SPRING_GT] = damping(k->zeta[1], h, kt, wt);
}

/* ---- how many small steps ---- */

/* Of bodies: the largest 1/m, and by how much more a contact at the rim of one may have */
struct lightest {
    double im, turns;
};

static struct lightest lightest_of(const struct packing *p)
{
    struct lightest y = { 0, 1 };
    for (int64_t i = 0; i < p->n; i++) {
        if (!(p->mass[i] > 0)) continue;
        const vec3 m = rotation_moments(p, i);
        const double least = p->dim == 2 ? m.z : fmin(m.x, fmin(m.y, m.z));
        y.im = fmax(y.im, 1 / p->mass[i]);
        y.turns = fmax(y.turns, 1 + p->radius[i] * p->radius[i] * p->mass[i] / least);
    }
    return y;
}

/* m^2/kg: the largest S/m of bonds with this law, where the lighter of two bodies decides their area */
static double bond_per_mass(const struct packing *p, const struct pair_law *l,
                            const struct lightest *y)
{
    double most = 0;
    if (!pair_law_adheres(l)) return 0;
    if (l->area > 0) return l->area * y->im;
    for (int64_t i = 0; i < p->n; i++) {
        const double r = p->radius[i], S = p->dim == 2 ? 2 * r : M_PI * r * r;
        if (p->mass[i] > 0) most = fmax(most, S / p->mass[i]);
    }
    return most;
}

/* 1/s^2: the largest k W of a pair of materials */
static double stiffest(const struct packing *p, const struct pair_law *l, const struct lightest *y)
{
    const double soft = l->soft > 0 ? 1 / (l->soft * p->dt * p->dt) : 0;
    const double along = l->soft > 0 ? soft : 2 * l->kn * y->im;
    const double across = l->soft > 0 ? SPRING_ACROSS * soft : 2 * l->kt * y->im;
    const double S = 2 * bond_per_mass(p, l, y), turns = p->shape ? y->turns : 1;
    return fmax(turns * fmax(along, S * l->cn), y->turns * fmax(across, S * l->ct));
}

double small_stiff_count(const struct packing *p)
{
    double most = 0;
    if (!small_stiff_acts(p)) return 0;
    const struct lightest y = lightest_of(p);
    for (int32_t k = 0; k < p->materials * p->materials; k++)
        most = fmax(most, stiffest(p, &p->law[k], &y));
    return p->dt * sqrt(most / RESOLVED);
}

bool small_stiff_exceeds(const struct packing *p)
{
    return small_stiff_count(p) > SPRINGS_MOST;
}
