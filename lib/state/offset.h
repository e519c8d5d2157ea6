/*
 * state/offset.h: what the contact law sees of a gap, and of a wall that bends towards a body on its
 * way, as a velocity:
 *
 *     u~ = D^-1 (u + E u^- + law n)
 *
 * It enters the contact problem as a constant, in struct rebound.
 */
#pragma once

#include "state/contact.h"
#include "state/packing.h"

/* Whether the contact may have an offset; where not, offset_of() is 0. t: its law, or NULL. Springs see the gap themselves. */
bool offset_in(const struct packing *pack, const struct contact *c, const struct contact_law *t);
/* m/s; un: u_n before the step, m/s */
double offset_of(const struct packing *pack, const struct contact *c, const struct contact_law *t,
                 double un);
