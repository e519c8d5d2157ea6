/*
 * shape/load.h: what a boundary yields to that is free along or about one axis: a force, as a
 * piston at constant pressure, or a torque.
 *
 * How it moves besides is prescribed: the load's speed adds to the boundary's own velocity.
 *
 * The walls of a room [state/servo_box.h] have one load together: the size of the room.
 */
#ifndef NSD_LOAD_H
#define NSD_LOAD_H

#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

/* A plane turns about its normal, in which it stays the plane that it is. */
enum load_way { LOAD_NONE, LOAD_GLIDES, LOAD_TURNS, LOAD_ROOM, LOAD_WAYS };

struct load {
    int32_t way; /* enum load_way */
    vec3 axis;   /* unit vector */
    vec3 point;  /* m: a point on the axis, of one that turns; of a room its centre */
    double
        mass; /* kg that move along the axis; kg m^2 about it; kg m^2: its part of a room's, of all of
                     which 0 stands for a room that does not yield */
    double force; /* N along the axis, N m about it; its weight is in it. Pushes add to it. */
    int32_t
        spread; /* 1: force and pushes are pressures, Pa, in the plane N/m, on the face that the walls
                       beside it leave [wall_face()] */
    double speed; /* m/s, rad/s; of a room 1/s: the growth of its size, of all its walls the same */
    double rate;  /* 1/s: strain rate that is prescribed along the axis, of a room's wall; else 0 */
    double travel; /* m, rad: how far it has come */
};

/* Does a room change by a tenth of its size in a step of dt (s)? Its walls would go through grains. */
static inline bool load_grows_too_fast(const struct load *l, double dt)
{
    double part = (l->speed + l->rate) * dt;
    return !(part < 0.1 && part > -0.1);
}

#endif
