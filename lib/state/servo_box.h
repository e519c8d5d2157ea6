/*
 * state/servo_box.h: a room between walls, whose size yields to a mean pressure: all its walls move in proportion to
 * their distances from its centre.
 *
 * Wall w is a plane with its normal n into the room. With the lever l = (x_w - centre) . n (m, not above 0), the
 * growth s of the room's size (1/s) and the strain rate e_w that is prescribed along n, the wall has along n the
 * velocity
 *
 *     dl/dt = v_w . n + (s + e_w) l,
 *
 * on top of its own motion v_w. The growth is one freedom [state/freedom.h] with the inertia M (kg m^2), pushed by
 * the pressure p_w on the faces A_w and by the normal forces F_w of the contacts:
 *
 *     M ds/dt = sum of (p_w A_w - F_w) l_w.
 *
 * At rest sum F_w |l_w| = sum p_w A_w |l_w|, which is dim V p where all walls of a box have the pressure p. The work
 * of the pressure is - p dV.
 *
 * In a step that begins at t the lever is that where the contacts act, t + a, and the wall has come
 *
 *     l(t + a) = (l_t + a v_w . n)/(1 - a (s + e_w))
 *
 * there: implicit in time from the beginning as from the end of the step, so that a step is undone to rounding, and
 * rates with the sum 0 keep the volume to the third order of dt.
 */
#pragma once

#include "state/packing.h"

/* Is the wall one of the room's? */
static inline bool servo_box_has(const struct wall *w)
{
    return w->load.way == LOAD_ROOM;
}
/* kg m^2: the inertia of the growth; 0: there is no room, or it does not yield */
double servo_box_mass(const struct packing *p);
/* 1/s: the growth; 0 without a room */
double servo_box_growth(const struct packing *p);

/* lever[p->walls] (m) = the levers at time t (s), 0 of other walls */
void servo_box_levers(const struct packing *p, double t, double *lever);
/* N m: what the pressures on the faces at time t (s) do to the growth with these levers */
double servo_box_force(const struct packing *p, const double *lever, double t);

/* The walls through a step in which the growth changes by `change` (1/s) where the contacts act; back: the
   inverse. */
void servo_box_move(struct packing *p, const double *lever, double change, bool back);
/* They are displaced in proportion, by `part` of their levers. */
void servo_box_displace(struct packing *p, const double *lever, double part);

/* After a step: does the size change by so little in a step that the next one can be made? Returns 0 or
   EX_DATAERR. */
int servo_box_check_growth(const struct packing *p, struct failure *failure);
