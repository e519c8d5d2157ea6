/*
 * measure/step_motion.h: how bodies move on the average of the step that the contacts belong to, from
 * the reactions: v- and v+ differ by dt g + sum r / m, and a document has one of the two.
 */
#ifndef NSD_STEP_MOTION_H
#define NSD_STEP_MOTION_H

#include "measure/snapshot.h"

struct step_motion {
    vec3 *v, *w; /* [n] m/s, rad/s: (v- + v+)/2 */
};

/* -1 when memory is short; to be freed either way. */
int step_motion_init(struct step_motion *m, const struct snapshot *s);
void step_motion_free(struct step_motion *m);

/* m/s: the relative velocity of b at contact i by that motion, in its basis (n, t1, t2) */
void step_motion_at(const struct step_motion *m, const struct snapshot *s, int64_t i, double u[3]);

#endif
