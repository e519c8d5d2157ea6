/*
 * step/small_stress.h: edges, or the size, of a cell that yield to a stress, in small steps. Sweeps see the rates that the stress and
 * the reactions which persist from the step before make,
 *
 *     s* = s^- + (h F + J^T r^-)/m,
 *
 * and after the sweeps the rates and the bodies, which follow the flow, get what the new reactions change of it, J^T (r - r^-)/m
 * [state/freedom.h]. J^T r is a component of the sum of r (x) d over all contacts. It is stable for edges whose mass is
 * not far below that of the bodies: an edge of mass m that n bodies of mass m_0 hold oscillates by sqrt(n^(1/3) m_0/(2 m)) per step,
 * and with 1.15 for that it never rests.
 */
#pragma once

#include "step/small_run.h"

/* Has the cell edges so light that small steps would not follow them? */
bool small_stress_light(const struct packing *p);
/* J: of what yields */
double small_stress_energy(const struct packing *p);
/* N: what the stress pushes the faces by, all together */
double small_stress_forces(const struct packing *p);

/* A small step begins: r->cell.next gets what is known; by one thread, as what follows. */
void small_stress_begin(struct small_run *r);
/* After the sweeps: the rest */
void small_stress_end(struct small_run *r);
void small_stress_free(struct small_run *r);
