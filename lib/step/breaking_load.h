/*
 * step/breaking_load.h: what the reactions of a step do to grains that break: their damage [state/breakage.h]. Grains whose
 * damage is 1 break at the beginning of the next step [scene/breaking.h].
 *
 * The contacts of two bodies act together: their force is the sum of their reactions over the time step. The energy of their
 * impact is that of two masses that the reaction r stops, r^2/(2 m (1 + e_n)^2), 1/m = 1/m_a + 1/m_b; each of two grains
 * has half of it, and a grain all of it at a wall or a body that is held. A force F that lasts counts as F^2 dt^2/(2 m): with the time
 * steps of grains that fall through their radius it is small against what breaks them.
 */
#pragma once

#include "state/contact.h"
#include "state/packing.h"

/* The damage of p's bodies after a step that has solved these contacts. Returns 0 or EX_SOFTWARE. */
int breaking_load(struct packing *p, const struct contacts *s, struct failure *failure);
