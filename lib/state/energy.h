/* state/energy.h: the energy that the bodies of a packing have, and how fast they are. */
#ifndef NSD_ENERGY_H
#define NSD_ENERGY_H

#include "state/packing.h"

struct energy {
    double kinetic;   /* J: of their motion and their rotation */
    double potential; /* J: in gravity, 0 at the origin */
    double fastest;   /* m/s */
};

/* Bodies without mass count for the fastest alone. */
struct energy energy_of(const struct packing *p);

/* J: of translation, by the peculiar velocities v - L (x - origin) in a cell whose edges move at L e; of bodies with
   own[n], NULL: of all. The image of a body has the same. */
double energy_peculiar(const struct packing *p, const bool *own);
/* Is it another than that of the velocities, or may it be at some time? */
bool energy_has_peculiar(const struct packing *p);

#endif
