/*
 * state/pair_law.h: what two materials do to each other beyond Coulomb's friction and Newton's
 * restitution: a row of a table for each pair of materials.
 *
 * Cohesion: a constant pull f_c while the gap is below a range, and liquid bridges. A bridge of
 * volume V is made where two bodies touch, and ruptures at a distance; before it pulls with
 *
 *     f(g) = 2 pi R sigma cos(theta) (1 - g / sqrt(g^2 + c^2)),   c^2 = 2 V / (pi R)
 *
 * [Pitois, Moucheront & Chateau 2000, (7)], with R = 2 R_a R_b/(R_a + R_b), and 2 R_b at a wall
 * [Derjaguin], down to g = D = (1 + theta/2) V^(1/3) [Lian, Thornton & Adams 1993]. Its energy is
 * minus the integral of f from g to D, in closed form.
 *
 * Rolling and pivoting: the moment at a contact is within |m_t| <= mu_r r_n, |m_n| <= mu_p r_n.
 *
 * Adhesion with damage [Raous, Cangemi & Cocou 1999]: contact/contact_law.h.
 */
#pragma once

#include <stdbool.h>

/* Whether restitution is reduced where an impact would gain energy [step/balance.h]: of grains that are no balls,
   whose impacts gain by themselves; never; always */
enum impact_law { IMPACT_DEFAULT, IMPACT_NEWTON, IMPACT_BOUNDED, IMPACT_LAWS };

/* Of the range of `soft`, up to 1: a smaller one is lost in the rounding of W */
#define COMPLIANCE_LEAST 1e-9

struct pair_law {
    double cohesion, range; /* N, m */

    double volume, tension, wetting; /* m^3, N/m, rad: of a liquid bridge */

    double mu_r, mu_p;             /* m */
    double mu_r_ratio, mu_p_ratio; /* in addition, over the effective radius of the pair */

    double cn, ct;  /* N/m^3: stiffness of a bond, per area */
    double w;       /* J/m^2: its energy; 0: there is no adhesion */
    double eta;     /* N s/m: viscosity of its damage */
    double area;    /* m^2, in the plane m; 0: that of the smaller body's cross-section */
    double beta;    /* intensity of a bond that is made */
    double made;    /* s: the time at which pairs that touch are bonded */
    double forever; /* 1: whenever bodies meet, instead */

    double impact; /* enum impact_law */

    double kn,
        kt; /* N/m, in the plane of 1 m of thickness: stiffness of the contact along n and across; 0: rigid
                      [contact/spring.h] */
    double
        soft; /* instead of both, "auto": the compliance 1/(k_n dt^2) in units of the pair's 1/m_a + 1/m_b */
};

/* What is wrong with numbers that are in their ranges, or NULL */
const char *pair_law_trouble(const struct pair_law *law);

static inline bool pair_law_wets(const struct pair_law *l)
{
    return l->volume > 0 && l->tension > 0;
}
static inline bool pair_law_adheres(const struct pair_law *l)
{
    return l->w > 0;
}
static inline bool pair_law_springs(const struct pair_law *l)
{
    return l->kn > 0 || l->soft > 0;
}
static inline bool pair_law_rolls(const struct pair_law *l)
{
    return l->mu_r > 0 || l->mu_p > 0 || l->mu_r_ratio > 0 || l->mu_p_ratio > 0;
}
static inline bool pair_law_coheres(const struct pair_law *l)
{
    return l->cohesion > 0;
}
/* Does the pair hold together over a gap? */
static inline bool pair_law_attracts(const struct pair_law *l)
{
    return pair_law_coheres(l) || pair_law_wets(l) || pair_law_adheres(l);
}

/* The laws beyond friction and restitution: name, as in scenes, and whether a pair has it */
struct law_name {
    const char *name;
    bool (*is_of)(const struct pair_law *law);
};
extern const struct law_name law_names[]; /* one without a name ends them */
/* Has a pair any of them? */
bool pair_law_acts(const struct pair_law *law);

/* m: R of the bridge between bodies of these radii, or, b alone, between b and a wall */
double bridge_radius(double a, double b);
/* m: where it ruptures */
double bridge_reach(const struct pair_law *law);
/* N, and J (0 where it ruptures), at gap g (m); R as above */
double bridge_force(const struct pair_law *law, double R, double g);
double bridge_energy(const struct pair_law *law, double R, double g);
