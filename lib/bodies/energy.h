/* bodies/energy.h: the energy that the bodies of a packing have, and how fast they are. */
#ifndef NSD_ENERGY_H
#define NSD_ENERGY_H

#include "bodies/packing.h"

struct energy {
    double kinetic;   /* J: of their motion and their rotation */
    double potential; /* J: in gravity, 0 at the origin */
    double fastest;   /* m/s */
};

/* Bodies without mass count for the fastest alone. */
struct energy energy_of(const struct packing *p);

#endif
