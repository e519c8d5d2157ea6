/*
 * contact/contact_law.h: what the laws of state/pair_law.h do at the contacts of a step, and what they leave for
 * the next.
 *
 * A step begins at the predicted positions, at gap g, and the next one, h later, at g + h u_n: u is
 * the velocity after the step. What ties a pair together over that way is an impulse
 *
 *     p = - h f_c n - h S beta^2 C (d + h u),     r = r* + p,     C = diag(c_n, c_t, c_t)
 *
 * f_c: the pull of cohesion and of a liquid bridge. d: the jump at the beginning, max(0, g) along n
 * and, across, how far the pair is sheared since it was bonded. r is what the bodies feel; r*, the
 * push of one surface on the other, is on Signorini's condition, for a pair that is apart
 * u_n + g/h >= 0, and on Coulomb's law with mu (1 - beta): what is no longer bonded rubs.
 *
 * Adhesion with damage [Raous, Cangemi & Cocou 1999]: S beta^2/2 d.C d - S w beta is the energy of a
 * bond, and beta falls where that and the viscosity eta ask for it,
 *
 *     eta beta' = - max(0, beta q - w),   q = c_n max(0, d_n + h u_n)^2 + c_t |d_t + h u_t|^2,
 *
 * by the implicit step beta = (h w + eta beta)/(h q + eta), and with eta = 0 beta = w/q. A bond of
 * less than a thousandth is broken: it would never end.
 *
 * Bodies touch whose gap is at most rounding at the predicted positions, or at the first ones [contact/touching.h], and those
 * that push each other in a step, also if they rebound.
 *
 * Where a shape is, a pair has several places: they share its pull and the area of bonds that are made in
 * one step, and bonds keep their place [contact/bond_anchor.h].
 */
#pragma once

#include "state/contact.h"
#include "state/packing.h"

/*
 * Static and kinetic friction. A pair of materials may have besides mu, its kinetic friction, a static
 * one mu_s and a speed v_s. A contact's friction in a step is
 *
 *     mu_s where |u_t-| <= v_s,  else mu,
 *
 * u_t- the sliding velocity with which the step begins. It is explicit: known before the step is solved, which is one
 * of Coulomb's law with that number. Nothing is remembered of earlier steps but the velocities.
 */

/* The friction of contacts that have just been found */
void friction_choose(struct contacts *s, const struct packing *p);

/* m: pairs with at most this gap touch */
double contact_laws_touch(const struct packing *p, const struct contact *c);
/* m: no pair touches with a larger gap */
double contact_laws_touch_most(const struct packing *p);
/* m^2: of a bond, of all places of a pair together; discs are 1 m deep */
double contact_laws_area(const struct packing *p, const struct contact *c);
/* Are pairs with this law bonded in this step if they touch? A time belongs to the step that it is in, [t, t + dt), or
   to the one that begins there but for rounding. */
bool contact_laws_bond(const struct packing *p, const struct pair_law *l);
/* m: contacts are to be sought up to this gap */
double contact_laws_reach(const struct packing *p);
/*
 * contacts->law[n] of contacts that have just been detected, by the laws and the bonds of the packing;
 * bonds are made. Where adhesion holds mu is that of what is not bonded; it and a gap let nothing
 * rebound. Returns 0 or EX_SOFTWARE.
 */
int contact_laws_find(struct contacts *s, const struct packing *p, struct failure *failure);
/* Does anything but touch make this a contact? */
static inline bool contact_law_holds(const struct contact_law *t)
{
    return t->pull > 0 || t->beta > 0;
}

/* out[3] (N s): r*, the push of one surface on the other, which is on Coulomb's law: r less p. dt: s */
static inline void contact_law_push(double dt, const struct contact_law *t, const struct found *f,
                                    double out[3])
{
    double way = t->jump[0] + dt * (f->u[0] - t->offset);
    out[0] = f->r[0] + dt * (t->pull + t->stiff[0] * way);
    for (int k = 1; k < 3; k++) out[k] = f->r[k] + dt * t->stiff[1] * (t->jump[k] + dt * f->u[k]);
}

/* What has become of a tie when the step is over */
struct contact_law_end {
    double gap, slip[2]; /* m */
    double stretch[3];   /* m: of the contact's springs; 0: rigid */
    double turn[3];      /* rad: of the spring of its moment; 0: rigid */
    double beta;
    bool wet;
};
/* moment (N m s): of the contact; NULL: it has none */
struct contact_law_end contact_law_end(const struct packing *p, const struct contact *c,
                                       const struct contact_law *t, const struct found *found,
                                       const double *moment);

/* J: what the step has changed of the energy that is stored at the contact, what is stored then, and
   what was given up by bonds that broke and by liquid that joined */
struct contact_law_account {
    double change, stored, broken;
    double implicit; /* lost by the implicit step of springs, at least 0 [contact/spring.h] */
    double rise;     /* what the rise of g_0 has given to the spring, part of change */
};
struct contact_law_account contact_law_account(const struct packing *p, const struct contact *c,
                                               const struct contact_law *t,
                                               const struct contact_law_end *end);

/* m: rolling and pivoting friction of the pair of body a (< 0: wall -1-a) and body b; with the part over its effective radius,
   r1 r2/(r1 + r2) of the balls around the bodies, r at a wall */
void contact_laws_rolling(const struct packing *p, int32_t a, int32_t b, double *mu_r,
                          double *mu_p);

/* Leaves of a bond, of a pair that had another law, what lasts under this one; false: nothing does. */
bool contact_law_carries(const struct pair_law *law, struct bond *bond);

/* p->bonds = what lasts of the contacts' ties; the bodies have not moved yet. Returns 0 or
   EX_SOFTWARE. */
int contact_laws_keep(struct packing *p, const struct contacts *s, struct failure *failure);
