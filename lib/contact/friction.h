/*
 * contact/friction.h: static and kinetic friction. A pair of kinds may have besides mu, its kinetic friction, a static
 * one mu_s and a speed v_s. A contact's friction in a step is
 *
 *     mu_s where |u_t-| <= v_s,  else mu,
 *
 * u_t- the sliding velocity with which the step begins. It is explicit: known before the step is solved, which is one
 * of Coulomb's law with that number. Nothing is remembered of earlier steps but the velocities.
 */
#ifndef NSD_FRICTION_H
#define NSD_FRICTION_H

#include "state/contact.h"
#include "state/packing.h"

/* The friction of contacts that have just been found */
void friction_choose(struct contacts *s, const struct packing *p);

#endif
