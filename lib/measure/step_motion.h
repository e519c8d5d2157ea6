/*
 * measure/step_motion.h: how bodies, boundaries and the cell move on the average of the step that the
 * contacts belong to: the mean of before and after it. A document has one of the two; the reactions
 * make the other.
 */
#ifndef NSD_STEP_MOTION_H
#define NSD_STEP_MOTION_H

#include "measure/snapshot.h"

struct step_motion {
    const struct packing *p; /* the frame */
    struct packing other;    /* the other end of the step */
};

/* Of solved contacts. Returns 0 or EX_SOFTWARE; to be freed either way. */
int step_motion_init(struct step_motion *m, const struct snapshot *s, struct why *why);
void step_motion_free(struct step_motion *m);

/* m/s: the relative velocity of b at a contact by that motion, in its basis (n, t1, t2) */
void step_motion_at(const struct step_motion *m, const struct contact *c, double u[3]);
/* m/s: the boundary's, of a contact with one */
vec3 step_motion_boundary(const struct step_motion *m, const struct contact *c);

#endif
