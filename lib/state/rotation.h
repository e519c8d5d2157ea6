/*
 * state/rotation.h: how bodies turn whose principal moments of inertia differ.
 *
 * Between two impulses a body keeps its angular momentum L in space, and its angular velocity
 * w = I(q)^-1 L changes as q does. A step is
 *
 *     free turning by (1 - theta) dt, L + the moments of the reactions, free turning by theta dt
 *
 * as it is for positions. The free turning is split [Touma & Wisdom 1994] into the motion of a
 * spherical top of the middle moment I_m, exact, and rotations about the two other axes of the body:
 *
 *     |L|^2/(2 I_m) + (1/I_a - 1/I_m) L_a^2/2 + (1/I_b - 1/I_m) L_b^2/2,
 *
 * each exact, in the order a/2, b, a/2. L is kept to rounding, the energy up to a bounded error of
 * order dt^2, and a symmetric top (I_a or I_b = I_m) moves exactly. theta = 1/2: the step is of order
 * 2 and the same backwards. Bodies whose moments are equal, balls and cubes, and all in the plane take
 * the way that balls always took: w is constant.
 */
#pragma once

#include "state/packing.h"

/* The shape of body i where it turns otherwise than a ball, else NULL */
static inline const struct shape *rotation_shape(const struct packing *p, int64_t i)
{
    const struct shape *s = p->dim == 3 && p->mass[i] > 0 ? packing_shape(p, i) : NULL;
    return s && (s->moment[0] != s->moment[1] || s->moment[1] != s->moment[2]) ? s : NULL;
}
static inline bool rotation_is(const struct packing *p, int64_t i)
{
    return rotation_shape(p, i) != NULL;
}

/* kg m^2: its principal moments; their mean is inertia[i] */
static inline vec3 rotation_moments(const struct packing *p, int64_t i)
{
    const struct shape *s = rotation_shape(p, i);
    if (!s) return v3(p->inertia[i], p->inertia[i], p->inertia[i]);
    const double *m = s->moment, unit = 3 / (m[0] + m[1] + m[2]);
    return v3_scale(unit * p->inertia[i], v3(m[0], m[1], m[2]));
}

/* kg m^2/s: L of body i at orientation q with angular velocity w, and w of L */
vec3 rotation_momentum(const struct packing *p, int64_t i, quat q, vec3 w);
vec3 rotation_spin(const struct packing *p, int64_t i, quat q, vec3 L);

/* I^1/2 a and I^-1/2 a */
vec3 rotation_root(const struct packing *p, int64_t i, quat q, vec3 a);
vec3 rotation_inverse_root(const struct packing *p, int64_t i, quat q, vec3 a);

/* q after a free turning for dt (s; < 0: back) with angular momentum L */
quat rotation_turn(const struct packing *p, int64_t i, quat q, vec3 L, double dt);

/* The orientation at which contacts are detected, and the angular velocity there before the
   reactions */
quat rotation_predict(const struct packing *p, int64_t i);
vec3 rotation_predict_spin(const struct packing *p, int64_t i, quat predicted);

/* J, twice: of turning, I w . w */
static inline double rotation_energy2(const struct packing *p, int64_t i, quat q, vec3 w)
{
    if (!rotation_is(p, i)) return p->inertia[i] * v3_dot(w, w);
    return v3_dot(w, rotation_momentum(p, i, q, w));
}

/* The energy that the bodies of a packing have, and how fast they are. */

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
