/*
 * scene/stiffness.h: the stiffness of contacts that a scene or a command line gives [contact/spring.h].
 *
 * It is k_n in N/m, or a compliance alpha: "auto". Then each contact has, in each step,
 *
 *     k_n = 1/(alpha W dt^2),   W = 1/m_a + 1/m_b (of a wall, and of a body that does not move, 0),
 *
 * so that C = alpha W for any masses and time steps, which decides how fast solvers converge, and a spring acts within
 * a step. A contact that carries a force F overlaps by alpha W F dt^2.
 */
#pragma once

#include "scene/scene.h"
#include "state/packing.h"

#define COMPLIANCE_AUTO                                                                            \
    1e-2 /* docs/wall: forces are unique, and sweeps do not grow with the pile */
/* Of W_cc: with a smaller compliance 1/(k dt^2) sweeps grow with the packing as with rigid contacts */
#define COMPLIANCE_SOFT 1e-3

struct stiffness {
    double k;    /* N/m; 0: rigid, or */
    double soft; /* 1: alpha; 0: none */
};

/* Gives a scene this law a stiffness? */
static inline bool stiffness_given(const struct scene_law *l)
{
    return pair_law_springs(&l->pair_law) || l->young > 0;
}
/* All pairs that will have a stiffness have some, by which what lasts of springs is known, until stiffness_build(). */
void stiffness_expect(struct packing *p, const struct scene *s);
/* k_n and k_t of all pairs of a packing whose bodies have been built, as its scene has them. Returns 0, or EX_DATAERR where no
   body has the diameter that Young's modulus needs. */
int stiffness_build(struct packing *p, const struct scene *s, struct failure *failure);
/* By a text, as --stiffness has it: a number above 0 (N/m), "rigid", "auto" or "auto:ALPHA". Returns 0, or EX_USAGE where it is
   none of these. */
int stiffness_read(struct stiffness *to, const char *text, struct failure *failure);
/* Sets that of all pairs of materials; rigid: springs are forgotten. Returns 0 or EX_SOFTWARE. */
int stiffness_set(struct packing *p, struct stiffness to, struct failure *failure);
/* Have all pairs of materials this one? */
bool stiffness_is(const struct packing *p, struct stiffness s);
/* The compliance of two bodies of the mean mass, in units of their W_nn; the stiffest pair of those with k_n; 0: none */
double stiffness_softness(const struct packing *p);
/* The smallest and the largest of all pairs: k_n, N/m, and alpha; both 0: none */
void stiffness_range(const struct packing *p, struct stiffness range[2]);
