/*
 * scene/inlet.h: inlets and outlets at the beginning of a step: first the removals, in the scene's
 * order, then the pours.
 *
 * A removal takes every body whose centre is in its region. Grain n of a pour (n from 0) is due as
 * soon as n <= rate (t - from); by mass, as soon as the mass of the grains before it is at most that.
 * Its radius is a function of the seed, the pour and n; its place, of these and the step: some are
 * tried, and the first is taken where it touches nothing, neither now nor in the predicted
 * position. Where there is none, the grain waits for the next step, and those after it wait too: the
 * pour is slower then, and no size is preferred.
 *
 * So nothing depends on threads, nor on where runs begin and end: all that is remembered is how many
 * grains a pour has brought, and their mass, which documents hold. Doing it twice is doing it once.
 */
#pragma once

#include "scene/scene.h"
#include "state/contact.h"
#include "state/packing.h"

struct flow {
    struct scene
        scene; /* the packing's, read again; empty where nothing comes or goes. Groups of pours and removals
                           are rows of the packing's names. */
};

/* Of the scene that the packing keeps. Returns 0, EX_DATAERR (the scene is not the packing's) or
   EX_SOFTWARE; *flow needs to be freed only after 0. */
int flow_read(struct flow *flow, const struct packing *p, struct failure *failure);
void flow_free(struct flow *flow);

/*
 * What happens at the beginning of the packing's next step; it is added to p->events. *changed: are
 * there other bodies than before? The contacts of the last step (or NULL) are then told of the bodies'
 * new rows, and those of bodies that are gone are dropped. Returns 0, EX_DATAERR or EX_SOFTWARE.
 */
int flow_step(const struct flow *flow, struct packing *p, struct contacts *last, bool *changed,
              struct failure *failure);

/* Bodies are taken away by another program: row[i] is where body i goes, in the same order; < 0: it is gone. Returns 0 or
   EX_SOFTWARE. */
int flow_drop(struct packing *p, struct contacts *last, const int32_t *row,
              struct failure *failure);
