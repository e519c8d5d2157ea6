/*
 * contact/spring.h: contacts with a stiffness, linear springs along n and across with Coulomb's law.
 *
 * With g the gap at the predicted positions, at which a step of length h begins, F = r/h, and x the stretch of the
 * springs there (m),
 *
 *     x_n = g - g_0,       0 <= r_n,  x_n + h u_n + F_n/k_n >= 0,  one of them zero,
 *     x_t = -F_t/k_t of the step before,      x_t + h u_t + F_t/k_t = 0 in stick,  |F_t| = mu F_n in slip:
 *
 * F_n is k_n times the overlap at the predicted positions of the next step, the implicit Euler step of a spring.
 * Divided by h this is the law of rigid contacts of
 *
 *     u~ = u + x/h + C r,   C = diag(c_n, c_t, c_t),   c = 1/(k h^2),
 *
 * so C is added to W_cc and x/h to the free velocity, and every method, solver and error sees a rigid contact.
 * With k_t = 2/7 k_n, C is for balls of one size the same multiple of W_cc along n and across. k_t is also within what
 * Mindlin's solution has for elastic balls, 2/3 to 1, where n and t of the sphere are as stiff as its mass lets them
 * oscillate alike [Schaefer, Dippel & Wolf 1996].
 *
 * The moments of rolling and pivoting friction have springs of the same kind, with the angle phi (rad) by which b is
 * turned against a,
 *
 *     phi = -M/k_r of the step before,   phi + h omega + M/k_r = 0 within |m_t| < mu_r r_n and |m_n| < mu_p r_n.
 *
 * k_r = k_t R^2 (N m), R the smaller radius: the moment is that of a spring k_t at the rim. For balls of one size
 * its compliance is then 7/5 of what it is along n and across, in units of W_cc.
 *
 * A bonded contact has the springs of its bond and no others; it has these once the bond has broken.
 *
 * What is remembered of a contact that pushes is in struct bond: x_t, a vector in space that turns with n and with the
 * mean spin of the pair about n, and is cut to the disc of the force that n has; phi, likewise; and g_0. It is the gap, if that is an
 * overlap, with which a pair is first seen: bodies that overlap in a scene, or that others push into each other within a
 * step, push nothing by that. It rises with the gap, and by g h^2 in a step, so that such bodies part at g h, to 0.
 *
 * An impact is a pair whose springs do not push and that approaches faster than gravity and loads make it in a step
 * [state/freedom.h]. Its law is Newton's, of u + E u^-, or where e_n = 0 that of u_n + g/h. With springs alone it would
 * rebound with a part of about c/W of its speed. Instead of C r it has C (r - r^): r^, the impulse of the impact, were
 * the pair alone. A pair alone then has Newton's law exactly, and where others hold it C bounds r. Its moment has no spring. e is 0
 * unless the pair is new: it has not pushed in the step before.
 *
 * Where a pair has a compliance alpha instead, k_n = 1/(alpha W h^2), W = 1/m_a + 1/m_b, so that C = alpha W whatever h is.
 * Such springs are no property of the bodies. When k changes they push as before: x_t and phi change by the ratio of k, and
 * g_0 takes the difference along n. g_0 rises by alpha g h^2, by which the push grows by a weight. An impact is any pair
 * that approaches so fast, also one that has pushed; its spring rests in the step, and pushes as before after it; e is that of
 * rigid contacts; and r^ of all contacts is found by
 * step/hit_bound.h, so that springs leave nothing of impacts.
 */
#pragma once

#include "state/contact.h"
#include "state/packing.h"

/* Of k_n: the default of k_t */
#define SPRING_ACROSS (2.0 / 7)

/* Sets what the springs of contact c do in the step: t, and c->en, c->et. old: what lasts of it, or NULL. Nothing where
   its pair is rigid. */
void spring_set(struct contact_law *t, const struct packing *p, struct contact *c,
                const struct bond *old);

/* What the law sees of D u~ besides u, E u^- and C r: law (m/s) along n, t1, t2; c (1/kg): C. dt: s */
void spring_seen(double dt, const struct contact *c, const struct contact_law *t, double law[3],
                 double compliance[2]);

/* m: of the springs when the step is over; and u_n, m/s, of the bodies. before: u_n^- */
struct spring_end {
    double stretch[3], un;
};
struct spring_end spring_end(const struct packing *p, const struct contact *c,
                             const struct contact_law *t, const struct found *found, double before);

/* The same of a moment, in rad/s; returns 1/(kg m^2), 0: rigid */
double spring_turn_seen(double dt, const struct contact_law *t, double law[3]);
/* turn (rad): of its spring when the step is over; moment: N m s */
void spring_turn_end(double dt, const struct contact_law *t, const double moment[3],
                     double turn[3]);

/* J: of springs stretched by x and turned by phi; one that is pulled along n has none */
double spring_energy(const struct contact_law *t, const double x[3], const double phi[3]);
/* J, at least 0: what an implicit step loses of it, k/2 times the square of what the stretch changes by */
double spring_implicit(const struct contact_law *t, const double end[3], const double phi[3]);

/* m, at most 0: g_0 when the step is over; gap and stretch (m): at its end */
double spring_rest_after(const struct packing *p, const struct contact *c,
                         const struct contact_law *t, double gap, double stretch);

/* J: what the rise of g_0 gives to the spring, whose gap was `end` and stretch x_n (m) when the step was over */
double spring_rise(const struct packing *p, const struct contact *c, const struct contact_law *t,
                   double end, double x);

/* m, at most 0: the gap that a contact has but for its spring, which carries the rest */
double spring_unloaded_gap(const struct contact *c, const struct contact_law *t);
