/*
 * step/hit_bound.h: impacts of contacts with a stiffness whose restitution neighbours make impossible.
 *
 * Newton's law may ask for what others do not allow: a ball in a wedge in which it locks would have to leave both
 * walls. The compliance of the springs then bounds the impulse, by about k dt^2 W times that of the pair
 * alone, which is more the stiffer they are. Where an impact pushes more than HIT_MOST times what its pair would alone, the step is solved with
 * e = 0 for such pairs, and again with so much of their e that none pushes more than HIT_MOST times what it needs with
 * e = 0, if impulses are linear in e.
 */
#pragma once

#include "state/contact.h"
#include "state/packing.h"

#define HIT_MOST 10.0

struct hit_search;

/* Of solved contacts. *search: NULL at first; to be freed by hit_free(). Reduces restitutions; *again: they are to be
   solved again, after which this is called again. Returns 0 or EX_SOFTWARE. */
int hit_reduce(struct hit_search **search, const struct packing *p, struct contacts *s, bool *again,
               struct failure *failure);
void hit_free(struct hit_search *search); /* may be NULL */
