/*
 * step/hit_bound.h: impacts of contacts with a stiffness: whose restitution neighbours make impossible, or that springs soften.
 *
 * Newton's law may ask for what others do not allow: a ball in a wedge in which it locks would have to leave both
 * walls. The compliance of the springs then bounds the impulse, by about k dt^2 W times that of the pair
 * alone, which is more the stiffer they are. Where an impact pushes more than HIT_MOST times what its pair would alone, the step is solved with
 * e = 0 for such pairs, and again with so much of their e that none pushes more than HIT_MOST times what it needs with
 * e = 0, if impulses are linear in e.
 *
 * A body that meets others pushes its impulse on through contacts that have been loaded before, and through those of bodies much
 * lighter than itself, whose compliance leaves part of its approach: alpha times the ratio of the masses. Springs whose stiffness
 * follows from the time step [scene/stiffness.h] are no property of the bodies, and must not act on impacts. Where they leave more
 * than HIT_LEFT of the fastest approach, and more than gravity makes in a step, the step is solved again with C (r - r') in
 * place of C r: r', what the contacts pushed, less what their springs pushed before the step. This is the proximal point
 * iteration for the law of rigid contacts, where x keeps the overlaps that there are.
 */
#pragma once

#include "state/contact.h"
#include "state/packing.h"

#define HIT_MOST 10.0
#define HIT_LEFT 1e-2
/* At most; each leaves x/(1 + x) of what the one before has left, x = C/W of the heaviest body */
#define HIT_ROUNDS 40
#define HIT_CYCLE  3 /* rounds, the last of which extrapolates */

struct hit_search;

/* Of solved contacts. *search: NULL at first; to be freed by hit_free(). Reduces restitutions and compliances; *again: they
   are to be solved again, after which this is called again. Returns 0 or EX_SOFTWARE. */
int hit_reduce(struct hit_search **search, const struct packing *p, struct contacts *s, bool *again,
               struct failure *failure);
void hit_free(struct hit_search *search); /* may be NULL */
