/*
 * step/small_stiff.h: what a stiffness of contacts and bonds of adhesion between two materials make of a pair in small steps
 * [solve/small_spring.h], and how many small steps they need.
 *
 * A pair alone that meets with u_n = -1 at x = 0 moves by x'' = - x - 2 zeta x' in units of the spring's frequency, until
 * x + 2 zeta x' is 0, and then parts with e. zeta follows from e_n so, with e = 0.01 at least, and from e_t by the same function.
 */
#pragma once

#include "solve/small_spring.h"
#include "state/packing.h"

/* Of two materials */
struct small_stiffness {
    double kn, kt; /* N/m */
    double
        soft; /* s^2: or 1/(k W) instead, where the stiffness follows from the step [state/pair_law.h] */
    double zeta[2][2]; /* damping ratios along n and across: in fine steps and in coarse ones */
};

/* Has any pair of materials springs or bonds? */
bool small_stiff_acts(const struct packing *p);
/* The small steps that they need in a step of the packing's dt (s); 0: there are none */
double small_stiff_count(const struct packing *p);
/* Are they more than a step is made in? */
bool small_stiff_exceeds(const struct packing *p);

/* [materials^2], where a whole step has `interval` (s). NULL when memory is short; to be freed */
struct small_stiffness *small_stiff_table(const struct packing *p, double interval);
/* m^2: of a bond of these; 0: they have none */
double small_stiff_area(const struct packing *p, int32_t a, int32_t b);
/* Of x, what a bond of area S (m^2) has */
void small_stiff_bond(double x[SPRING_COUNT], const struct packing *p, int32_t a, int32_t b,
                      double S);
/* x = that of bodies a (< 0: wall -1-a) and b, in steps of the packing's dt; wn, wt: 1/kg, of the contact along n and across. What
   lasts is not set. Springs at a wall that a load moves yield. */
void small_stiff_set(double x[SPRING_COUNT], const struct small_stiffness *table,
                     const struct packing *p, int32_t a, int32_t b, double wn, double wt);
