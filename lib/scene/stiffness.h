/*
 * scene/stiffness.h: the stiffness that contacts of a packing need [contact/spring.h].
 *
 * The least stiffness with which the heaviest load that stands in the packing overlaps a contact by at most STATIC of
 * the smallest radius, and its fastest impact by at most IMPACT of it:
 *
 *     k >= F / (STATIC r),   k >= m v^2 / (IMPACT r)^2.
 *
 * F is the largest of the weight of the heaviest body; and, on a cross-section (2 R)^2 of the largest body, in the plane
 * 2 R, of the weight of a column as high as the bodies are and may fall, at their mean density and a share DENSE of space,
 * and of the pressure of loads and of the cell, at the time at which it is largest. v is the fastest speed of a body or
 * wall and of what falls or is driven by a load, as the time step has it [scene/time_step.h], m the heaviest body. Bodies
 * that inlets bring count.
 */
#pragma once

#include "scene/scene.h"
#include "state/packing.h"

#define STIFFNESS_STATIC 1e-4 /* radii of the smallest body */
#define STIFFNESS_IMPACT 1e-2
/* Of W_cc: with a smaller compliance 1/(k dt^2) sweeps grow with the packing as with rigid contacts */
#define STIFFNESS_SOFT 1e-3

/* *k: N/m, as above. Returns 0, or EX_DATAERR where nothing moves or is loaded, or EX_SOFTWARE. */
int stiffness_needed(double *k, const struct packing *p, struct failure *failure);
/* Gives a scene this law a stiffness? */
static inline bool stiffness_given(const struct scene_law *l)
{
    return l->pair_law.kn > 0 || l->young > 0 || l->softest;
}
/* All pairs that will have a stiffness have some, by which what lasts of springs is known, until stiffness_build(). */
void stiffness_expect(struct packing *p, const struct scene *s);
/* k_n and k_t of all pairs of a packing whose bodies have been built, as its scene has them. Returns as the former. */
int stiffness_build(struct packing *p, const struct scene *s, struct failure *failure);
/* *k by a text, as --stiffness has it: a number above 0 (N/m), "rigid" (0) or "auto" (needed). The same returns, and EX_USAGE
   where it is none of these. */
int stiffness_read(double *k, const char *text, const struct packing *p, struct failure *failure);
/* Sets k_n = k and k_t of all pairs of materials; k = 0: rigid, and springs are forgotten. Returns 0 or EX_SOFTWARE. */
int stiffness_set(struct packing *p, double k, struct failure *failure);
/* The compliance of two bodies of the mean mass, in units of their W_nn; the stiffest pair; 0: rigid */
double stiffness_softness(const struct packing *p);
/* N/m: the smallest and the largest k_n of all pairs; both 0: rigid */
void stiffness_range(const struct packing *p, double k[2]);
