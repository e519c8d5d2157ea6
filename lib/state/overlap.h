/*
 * state/overlap.h: what a step does about overlaps, besides keeping bodies from approaching.
 *
 *     keep         nothing: u_n >= 0, as the paper
 *     gap          u_n + max(0, g)/dt >= 0: bodies that are apart may close the gap g, not more
 *                  [Jean 1999, the quasi-shock law of LMGC90]
 *     push         u_n + g/dt >= 0: an overlap is left with a velocity
 *     project      bodies are moved apart after the step, without a velocity [step/project.h]; the
 *                  law sees the gaps of those that are near, as with gap
 *     gap-project  gap and project
 *
 * Near is a pair whose gap is at most OVERLAP_NEAR of the smaller radius, and what loads may close of
 * it in a step. What a projection opens is near: else the next step would not know the contact, and what
 * it has carried would go into an overlap. gap, push and gap-project also see pairs that are farther
 * apart and approach.
 */
#ifndef NSD_OVERLAP_H
#define NSD_OVERLAP_H

#include <stdbool.h>

enum overlap {
    OVERLAP_UNSAID, /* by a document: keep */
    OVERLAP_KEEP,
    OVERLAP_GAP,
    OVERLAP_PUSH,
    OVERLAP_PROJECT,
    OVERLAP_GAP_PROJECT,
    OVERLAP_COUNT
};

/* As options and documents have them; that of OVERLAP_UNSAID is "" */
extern const char *const overlap_name[OVERLAP_COUNT];

/* Radii of the smaller: half of what a contact is moved apart in a step, where it overlaps by little. A
   random packing has some 3 % more contacts so; with 1e-4 cells under a pressure still collapse that
   moves a grain by 0.4 % of its radius in a step. */
#define OVERLAP_NEAR 1e-3

/* Whether the law sees gaps, also those of pairs that are not near and approach; overlaps too; and
   whether bodies are moved apart */
static inline bool overlap_sees_gaps(enum overlap o)
{
    return o > OVERLAP_KEEP;
}
static inline bool overlap_meets(enum overlap o)
{
    return overlap_sees_gaps(o) && o != OVERLAP_PROJECT;
}
static inline bool overlap_pushes(enum overlap o)
{
    return o == OVERLAP_PUSH;
}
static inline bool overlap_projects(enum overlap o)
{
    return o == OVERLAP_PROJECT || o == OVERLAP_GAP_PROJECT;
}

#endif
