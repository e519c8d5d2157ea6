/*
 * step/contact_motion.h: how the bodies, or the body and the wall, of a contact move on the average of the step
 * in which it acts: the mean of the velocities before and after it, by which energy is exact [step/balance.h]. The
 * velocity is that of the material that the contact touches: of a wall its drives, load and belt; of an image across
 * the border of the cell what the motion of the edges adds.
 */
#pragma once

#include "step/impulse.h"

struct contact_motion {
    vec3 wall, wall_spin; /* m/s, rad/s: of the wall's material at the contact; 0 between bodies */
    vec3 u, w;            /* m/s, rad/s: of b relative to a, at the contact */
};

/* In the step that begins where the packing is, whose reactions have these sums */
struct contact_motion contact_motion(const struct packing *p, const struct impulses *sum,
                                     const struct contact *c);

/* J: what the step's reaction r and moment (NULL: there is none) take of the energy */
struct contact_loss {
    double impact, friction; /* - r_n u_n; - r_t . u_t - moment . w */
};
struct contact_loss contact_loss(const struct contact_motion *m, const struct contact *c,
                                 const double r[3], const double *moment);
/* J: what they do on the wall */
double contact_wall_work(const struct contact_motion *m, const struct contact *c, const double r[3],
                         const double *moment);
