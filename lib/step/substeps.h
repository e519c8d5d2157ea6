/*
 * step/substeps.h: a step that is made at once in equal parts, where small steps were asked for, and could not make it.
 *
 * Parts are steps of the same equations; they share the step's number, and their lengths add up to its dt: the next step begins
 * at the same time as if it had not been divided. Reactions of a contact are added up over the parts, so that r/dt is its mean
 * force over the step; so are balances and counts. Depths and errors are the worst of the parts.
 */
#pragma once

#include "state/packing.h"
#include "state/report.h"

struct substeps {
    double dt, t, t0; /* s: of the step; at its beginning */
    int64_t step, step0;
    int64_t n, made;     /* parts; made so far */
    double done;         /* s */
    bool ends;           /* the step is made, or cannot be made */
    struct contacts sum; /* of the parts made, where there are several */
    struct report report;
};

/* The packing at the beginning of a step of so many parts; 0 is one, too. */
void substeps_begin(struct substeps *s, const struct packing *p, int64_t parts);
void substeps_free(struct substeps *s);
static inline bool substeps_alone(const struct substeps *s)
{
    return s->n == 1;
}
/* p is to make the next part, from its share of the reactions that it remembers. */
void substeps_enter(const struct substeps *s, struct packing *p);
/* After the part: p is at its end, and at the end of the step if it was the last. */
void substeps_leave(const struct substeps *s, struct packing *p);
/* The part that p has left is made. */
void substeps_count(struct substeps *s);
/* Counts it, and adds its contacts and its report; of the last one they become those of the step.
   Returns 0 or EX_SOFTWARE. */
int substeps_add(struct substeps *s, const struct packing *p, struct contacts *contacts,
                 struct report *report, struct failure *failure);
