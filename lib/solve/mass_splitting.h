/*
 * solve/mass_splitting.h: slots whose contacts are solved as if their bodies were lighter, k times, because k
 * processes push a body at once: each step is as much shorter, and no solution is another [mass
 * splitting, Tonge et al. 2012]. W~_cc and all that follows from it are those of the lighter bodies in
 * the sweeps, and the true ones where errors are computed; the bodies themselves stay as they are.
 */
#pragma once

#include "solve/fill.h"

#include <stdbool.h>
#include <stdint.h>

struct mass_splitting {
    int64_t n;
    int64_t *slot; /* [n] */
    bool held;     /* the slots have the numbers of lighter bodies, */
    double *other; /* [n][width] and here are the true ones; or the other way round */
    int width;     /* numbers of a slot that lighter bodies change, found by filling it twice, */
    int *number;   /* [width] and which of all they are */
    int all;       /* numbers of a slot */
    double **at;   /* [all] work space: where they are */
};

/* p->brake of contacts with slower[contact] > 1; they are held. To be called when the slots are filled, as
   fill_slot() is. -1 when memory is short. */
int mass_splitting_make(struct problem *p, const struct filling *f, const double *slower);
/* Whether the sweeps' numbers are to be in the slots, or the true ones; p->brake may be NULL. */
void mass_splitting_hold(struct problem *p, bool hold);
