/*
 * step/breaking_load.h: what the reactions of a step do to grains that break: their damage [state/breakage.h]. Grains whose
 * damage is 1 break at the beginning of the next step [scene/breaking.h].
 *
 * The contacts of two bodies act together: their force is the sum of their reactions over the time step. The energy of their
 * impact is - sum r . u/(2 (1 + e_n)), u their velocities at the beginning of the step: that of two masses m, whose approach
 * r = (1 + e_n) m |u| reverses, is m u^2/2; bodies that rest on each other have none, however large their forces are. Each of
 * two grains has half of it, and a grain all of it at a wall or a body that is held.
 */
#pragma once

#include "state/contact.h"
#include "state/packing.h"

/* The velocities at the beginning of a step; v NULL: nothing asks for them */
struct breaking_start {
    vec3 *v, *w; /* [n] m/s, rad/s */
};
/* Of p, brought back into its cell as the step does. Returns 0 or EX_SOFTWARE. */
int breaking_start(struct breaking_start *start, struct packing *p, struct failure *failure);
void breaking_start_free(struct breaking_start *start);

/* The damage of p's bodies after a step that has solved these contacts. Returns 0 or EX_SOFTWARE. */
int breaking_load(struct packing *p, const struct contacts *s, const struct breaking_start *start,
                  struct failure *failure);
