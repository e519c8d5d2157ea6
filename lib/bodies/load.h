/*
 * bodies/load.h: a boundary, or an edge of the cell, that is free along or about one axis and yields
 * to a force there: a piston at constant pressure, a plate under torque, a cell under stress.
 *
 * How it moves besides is prescribed: the load's speed adds to the boundary's own velocity.
 */
#ifndef NSD_LOAD_H
#define NSD_LOAD_H

#include "base/vec.h"

#include <stdint.h>

enum load_way { LOAD_NONE, LOAD_GLIDES, LOAD_TURNS, LOAD_WAYS };

struct load {
    int32_t way;   /* enum load_way */
    vec3 axis;     /* unit vector */
    vec3 point;    /* m: a point on the axis, of one that turns */
    double mass;   /* kg that move along the axis; kg m^2 about it */
    double force;  /* N along the axis; N m about it; of the cell's edge k Pa (in the plane N/m) on
                      the face that the other edges span, positive where it draws the edge out */
    double speed;  /* m/s, rad/s; not of an edge, whose rate it is */
    double travel; /* m, rad: how far it has come; not of an edge */
};

#endif
