/*
 * step/small_past.h: what a list of small steps takes over from the one before it, and from the step before, as the packing
 * remembers it.
 */
#pragma once

#include "step/small_list.h"

/* Pairs of the list before that have pushed in this interval stay, however far they are: the frame has them. False when memory is
   short. */
bool small_keep_pairs(struct small_list *to, const struct small_list *from);
/* Pairs that were in the list before have what they had there. */
void small_carry_pairs(struct small_list *to, const struct small_list *from);
/* Reactions as p remembers them, of a step that is `part` of p's; sums begin at 0. False when memory is short. */
bool small_list_recall(struct small_list *l, const struct packing *p, double part);
/* p remembers those of the list, of a step `part` times its own. Returns 0 or EX_SOFTWARE. */
int small_list_remember(const struct small_list *l, struct packing *p, double part,
                        struct failure *failure);

/* What a slot has of the past */
struct small_past {
    double f[3], couple[3], sum[3];
    double m[3], turned[3];
    double held[HOLD_COUNT];     /* from HOLD_WET on */
    double spring[SPRING_COUNT]; /* from SPRING_REST to SPRING_GIVEN */
};
struct small_past small_slot_past(const struct small *s, int64_t slot);
void small_slot_set_past(struct small *s, int64_t slot, const struct small_past *x);
