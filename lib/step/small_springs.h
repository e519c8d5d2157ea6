/*
 * step/small_springs.h: contacts with a stiffness and bonds of adhesion in an interval of small steps: what lasts of them, and what
 * they store [step/small_stiff.h, solve/small_spring.h].
 */
#pragma once

#include "step/small_run.h"

/* The list, just made, gets the springs of the packing, false when memory is short; those of points where they have been found */
bool small_springs_recall(struct small_run *r);
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
