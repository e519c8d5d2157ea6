/*
 * problem/offset.h: what the velocity at a contact has besides those of the two bodies.
 *
 * Both parts enter the contact problem as one constant, in struct rebound:
 *
 *     u = P* qdot + moves,   u~ = D^-1 (u + E u^- + law)
 */
#ifndef NSD_OFFSET_H
#define NSD_OFFSET_H

#include "bodies/contact.h"
#include "bodies/packing.h"

/* (n, t1, t2), m/s */
struct offset {
    double moves[3]; /* part of u, before the step as after it */
    double law[3];   /* what the law alone sees */
};

/* Whether the contact may have an offset; where not, offset_of() gives zeros. */
bool offset_in(const struct packing *pack, const struct contact *c);
/* un: u_n before the step of the bodies alone, m/s */
void offset_of(const struct packing *pack, const struct contact *c, double un, struct offset *o);

#endif
