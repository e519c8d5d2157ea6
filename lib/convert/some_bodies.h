/*
 * convert/some_bodies.h: a packing of some of the bodies of another, for formats that have grains only.
 */
#ifndef NSD_SOME_BODIES_H
#define NSD_SOME_BODIES_H

#include "state/selection.h"

struct some_bodies {
    struct packing bodies;  /* owns the bodies */
    struct packing packing; /* these with all else of the other packing, which is borrowed */
};

/* Bodies of groups and kinds that c names, in their order. Returns 0, or EX_SOFTWARE with nothing to free. */
int some_bodies_init(struct some_bodies *s, const struct packing *p, const struct selection *c,
                     struct failure *failure);
void some_bodies_free(struct some_bodies *s);

#endif
