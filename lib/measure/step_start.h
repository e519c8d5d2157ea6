/*
 * measure/step_start.h: the beginning of the step that a frame's contacts belong to, and the sums of their reactions.
 * A document has either end of the step; the reactions lead from one to the other.
 */
#ifndef NSD_STEP_START_H
#define NSD_STEP_START_H

#include "measure/snapshot.h"
#include "step/contact_motion.h"

struct step_start {
    const struct packing *p; /* where the step begins */
    struct impulses sum;
    struct packing back; /* the frame moved back, if it is the step's end */
};

/* Of solved contacts. Returns 0 or EX_SOFTWARE; to be freed either way. */
int step_start_init(struct step_start *m, const struct snapshot *s, struct failure *failure);
void step_start_free(struct step_start *m);

#endif
