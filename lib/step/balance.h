/*
 * step/balance.h: the balances of energy and momentum over one step.
 *
 * The equation of motion M (v+ - v-) = dt F + H r times the mean velocity is, to rounding and
 * whatever r is [Kelvin & Tait 1867, art. 308: an impulse works by the mean of the velocities
 * before and after it]:
 *
 *     T+ - T- = gravity + loads + drives - dissipation
 *
 *     gravity      dt sum m g . (v+ + v-)/2
 *     loads        dt sum f (s+ + s-)/2, of the freedoms [state/freedom.h] and of forces from outside
 *                  [state/external_force.h]
 *     drives       - sum r . w: w is what the motions that are prescribed (walls, fixed
 *                  bodies, the cell) are in the velocity of the contact, their mean over the
 *                  step; and what the flow of the cell does to bodies
 *     dissipation  - sum r . (u+ + u-)/2
 *
 * and where pairs are tied [contact/contact_law.h] what their energy takes is no dissipation:
 *
 *     T+ - T- = gravity + loads + drives + rise - dissipation - bond_change - broken
 *
 * rise: what overlaps that a packing starts with give to springs as they rise [contact/spring.h].
 *
 * Bodies that are moved apart after the step [step/project.h] are lifted without a velocity, which gravity is not:
 *
 *     U+ - U- = projection - gravity,    U = - sum m g . x, with theta = 1/2
 *
 * Each of the four is a sum of its own, none a difference of the others. Momentum changes by the
 * weight, dt sum m g, by forces from outside and by the impulse of walls, fixed bodies and the cell's flow. Where
 * the cell repeats, T- is not T+ of the step before: a body that is replaced by its image has
 * another velocity; the energy of the peculiar velocities is the same. balance_step() leaves -T'- in peculiar_change, to
 * which the end of the step adds T'+.
 *
 * An impact under Newton's law with friction may gain energy [Kane 1984]: a rod that strikes a floor at an angle and
 * whose tip reverses its slip. gained is what impacts have gained, the pairs of which approached with restitution and
 * whose friction did more work than restitution took; step/balance.h bounds it.
 *
 * Without restitution a contact that holds has u+ = 0 and dissipates -r . u-/2, which is negative
 * where the step has begun with separating bodies; over an impact it is what the law takes.
 */
#pragma once

#include "state/report.h"
#include "step/impulse.h"

/* Of the step that begins where the packing is, by the reactions of its contacts, whose sums are
   given, too. Bodies count where of[n] is true; NULL: all. Returns 0 or EX_SOFTWARE. */
int balance_step(struct balance *b, const struct packing *p, const struct contacts *s,
                 const struct impulses *sum, const bool *of, struct failure *failure);

/* What the impact of a pair of bodies has gained in addition to the energy that its approach could give up */
struct gain {
    double work,
        scale; /* J: of its contacts, which are from this on; work > 0: gained. 0, 0: no impact */
};
/* The first contact after i that is of another pair; the images of one body count as one. */
int64_t balance_next_pair(const struct contacts *s, int64_t i);
/* Less than this part of the scale is rounding, or what the solve leaves. */
#define GAIN_LEAST 1e-10

/*
 * Impacts that gain no energy.
 *
 * Newton's law returns the normal velocity whatever friction does, and friction that reverses the slip of a lever
 * does work: a rod may strike a floor with e_n = 1 and have 1.5 times its energy afterwards [Kane 1984]. Where the
 * contacts of a pair would gain [balance_gains()], the pair's restitution is reduced to s (e_n, e_t), 0 <= s < 1,
 *
 *     -ENOUGH scale <= work(s) <= 0,
 *
 * by regula falsi over whole solves: everything that touches is solved with it. s = 0 gives no gain, for without
 * restitution the kinetic energy of an impact cannot grow. The contacts keep their reduced e_n and e_t.
 */

struct rebound_search;

/* Of solved contacts. *search: NULL at first; to be freed by rebound_free(). Reduces restitutions; *again: they are to
   be solved once more, and this is to be called again. Returns 0 or EX_SOFTWARE. */
int rebound_reduce(struct rebound_search **search, const struct packing *p, struct contacts *s,
                   bool *again, struct failure *failure);
void rebound_free(struct rebound_search *search); /* may be NULL */
