/*
 * step/substeps.h: a step that is made in substeps, since bodies meet within it [contact/time_of_impact.h].
 *
 * Substeps are steps of the same equations, each with a length of its own; they share the step's number, and their
 * lengths add up to its dt: the next step begins at the same time as if it had not been divided. Reactions of a
 * contact are added up over the substeps, so that r/dt is its mean force over the step; so are balances and counts.
 * Depths and errors are the worst of the substeps.
 */
#pragma once

#include "state/packing.h"
#include "state/report.h"

struct substeps {
    double dt, t, t0; /* s: of the step; at its beginning */
    int64_t step, step0;
    double done, length; /* s: made so far; of the substep in hand, or the one before */
    double longest;      /* s: no substep is longer */
    int64_t made;
    bool ends;            /* the step is made, or cannot be made */
    struct contacts sum;  /* of the substeps made, where there are several */
    struct memory memory; /* of the packing, while a short substep is made */
    struct report report;
};

enum {
    SUBSTEPS_MOST = 1000
}; /* the default of --substeps: a path of 50 thicknesses, always touching */

/* The packing at the beginning of a step */
void substeps_begin(struct substeps *s, const struct packing *p);
void substeps_free(struct substeps *s);
/* s: of the step that is still to be made */
static inline double substeps_rest(const struct substeps *s)
{
    return s->dt - s->done;
}
/* Is the one in hand the last; and is it the whole step? */
static inline bool substeps_last(const struct substeps *s)
{
    return s->length >= s->dt - s->done;
}
static inline bool substeps_alone(const struct substeps *s)
{
    return s->length >= s->dt;
}
/* s: substeps that are halved for walls are not shorter. The one before has looked as far ahead as its length. */
static inline double substeps_least(const struct substeps *s)
{
    return s->made ? s->length : 1e-6 * s->dt;
}
/* p has the step's dt, where bodies stand */
void substeps_whole(const struct substeps *s, struct packing *p);
/* The next substep is so long (s); after substeps_begin() or substeps_made(). */
void substeps_choose(struct substeps *s, double length);
/* p is to make that substep. */
void substeps_enter(const struct substeps *s, struct packing *p);
/* After the substep: p is at its end, and at the end of the step if it was the last. */
void substeps_leave(const struct substeps *s, struct packing *p);
/* The same of the reactions that p remembers. They are forces over a step: the substep begins with its share of them, and
   where it is short, with the impulses of impacts, they are afterwards what they were before. Returns 0 or
   EX_SOFTWARE. */
int substeps_remember(struct substeps *s, struct packing *p, struct failure *failure);
void substeps_recall(struct substeps *s, struct packing *p);
/* The substep that p has left is made. */
void substeps_count(struct substeps *s);
/* Counts it, and adds its contacts and its report; of the last one they become those of the step.
   Returns 0 or EX_SOFTWARE. */
int substeps_add(struct substeps *s, const struct packing *p, struct contacts *contacts,
                 struct report *report, struct failure *failure);
