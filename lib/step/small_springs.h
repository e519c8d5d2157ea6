/*
 * step/small_springs.h: contacts with a stiffness and bonds of adhesion in small steps [solve/small_spring.h]: what pairs of
 * materials give them, how many small steps they need, and what lasts of them.
 *
 * A pair alone that meets with u_n = -1 at x = 0 moves by x'' = - x - 2 zeta x' in units of the spring's frequency, until
 * x + 2 zeta x' is 0, and then parts with e. zeta follows from e_n so, with e = 0.01 at least, and from e_t by the same function.
 */
#pragma once

#include "step/small_run.h"

/* The small steps that springs and bonds need in a step of the packing's dt (s); 0: there are none */
double small_springs_count(const struct packing *p);
/* Are they more than a step is made in? */
bool small_springs_stiff(const struct packing *p);

/* Of two materials */
struct small_stiffness {
    double kn, kt, soft; /* N/m; or the compliance instead [state/pair_law.h] */
    double zeta[2][2];   /* damping ratios along n and across: in fine steps and in coarse ones */
};
/* [materials^2] l->stiffness, of a packing with springs or bonds. False when memory is short. */
bool small_springs_table(struct small_list *l, const struct packing *p);
/* x = that of bodies a (< 0: wall -1-a) and b, in steps of the packing's dt; wn, wt: 1/kg, of the contact along n and across. What
   lasts is not set. Springs at a wall that a load moves yield. */
void small_springs_set(double x[SPRING_COUNT], const struct small_list *l, const struct packing *p,
                       int32_t a, int32_t b, double wn, double wt);

/* The list, just made, gets the springs of the packing; those of points where they have been found */
void small_springs_recall(struct small_run *r);
void small_springs_recall_points(struct small_run *r);
/* J: what is stored where the bodies are, and what breaking has given up in the interval so far; of points, where bodies move as
   of[] */
struct small_spring_sums {
    double stored, broken;
};
struct small_spring_sums small_springs_sums(const struct small_run *r);
struct small_spring_sums small_springs_points(const struct small_run *r, const struct body *of);

/* What lasts of the springs of a touch, a slot or a point at the end of the interval; false: nothing does. b has its key. */
bool small_springs_keep_touch(const struct small_run *r, struct small_touch *t, struct bond *b);
bool small_springs_keep_slot(const struct small_run *r, int64_t slot, struct bond *b);
bool small_springs_keep_point(const struct small_run *r, const struct small_meeting *m,
                              const struct small_point *t, struct bond *b);
/* The springs that a contact has, whose bond has been kept (or NULL) */
void small_springs_law(struct contact_law *law, const struct packing *p, const struct contact *c,
                       const struct bond *b);
