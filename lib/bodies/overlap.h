/*
 * bodies/overlap.h: what a step does about overlaps, besides keeping bodies from approaching.
 *
 *     keep         nothing: u_n >= 0, as the paper
 *     gap          u_n + max(0, g)/dt >= 0: bodies that are apart may close the gap g, not more
 *                  [Jean 1999, the quasi-shock law of LMGC90]
 *     push         u_n + g/dt >= 0: an overlap is left with a velocity
 *     project      bodies are moved apart after the step, without a velocity [bodies/project.h]
 *     gap-project  gap and project
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

/* Whether the law sees gaps, overlaps too, and whether bodies are moved apart */
static inline bool overlap_sees_gaps(enum overlap o)
{
    return o == OVERLAP_GAP || o == OVERLAP_PUSH || o == OVERLAP_GAP_PROJECT;
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
