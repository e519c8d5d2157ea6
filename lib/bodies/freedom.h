/*
 * bodies/freedom.h: degrees of freedom beyond those of the grains: a boundary that a load pushes
 * along an axis or turns about one, an edge of the cell that yields to a stress.
 *
 * Each is one number, a speed s, with a mass m (kg; kg m^2 where it turns) and a force f (N; N m):
 * m ds/dt = f + what the contacts push. It enters the velocity of a contact, u_c += J_c s, and so
 * the contact problem like any other unknown: W = H^T M^-1 H has its rows as well.
 */
#ifndef NSD_FREEDOM_H
#define NSD_FREEDOM_H

#include "base/vec.h"
#include "bodies/contact.h"

struct freedom {
    int32_t boundary; /* the boundary that it moves; -1: the cell's edge */
    int edge;         /* of the cell */
    bool turns;       /* about the axis, not along it */
    vec3 axis, point; /* unit vector; m: a point on the axis, of the predicted position */
    double mass;      /* kg, or kg m^2 */
    double force;     /* N, or N m, of this step */
    double speed;     /* m/s, or rad/s, before the step */
};

#endif
