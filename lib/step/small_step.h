/*
 * step/small_step.h: a step in many small ones, each of one sweep [solve/small.h].
 *
 * The step's dt is an interval of n small steps of h = dt/n, which are steps of the theta method as any. It counts as one
 * step: reactions are sums over the interval, and balances are those of its beginning and its end. An interval in which sweeps
 * carry the reactions too slowly, as where a heavy body strikes light ones, is not made: the step is then made at once,
 * by today's solvers.
 */
#pragma once

#include "contact/neighbours.h"
#include "state/report.h"
#include "step/small_list.h"

struct small_opt {
    double
        overlap; /* R: of its size a body is moved by at most in a small step, against what is near it */
    int threads;
    struct neighbours *near; /* surfaces of meshes, kept from step to step */
    bool bare;               /* nobody reads the errors and the contacts of this step */
    bool compare;            /* its last reactions are compared with converged ones */
    double bound;            /* of what is missing of reactions in each small step; 0: none */
    struct small_part *part; /* this process's, of several with the same packing; NULL: alone */
    bool warm;               /* the first one starts from what the packing remembers */
};

/* What of a packing small steps do not have, in words; NULL: they have all */
const char *small_lacks(const struct packing *p);
/* What steps of a packing, whose errors may be bounded, are not divided between processes, in words; NULL: they are */
const char *small_undivided(const struct packing *p, double bound);
/* Is a step of a packing that they lack something for divided as finely as one that they give up? */
bool small_divides(const struct packing *p);
/* How many of them the step from where the packing is needs, that none moves a body by more than `overlap`
   radii of the smallest: of its state alone; 0: too many */
int64_t small_count(const struct packing *p, double overlap);
/* In how many parts a step is solved that small steps could not make: none moves a body by more than four times `overlap` */
int64_t small_parts(const struct packing *p, double overlap);
/* The step: rep but for its criterion, and s, as of step_advance(). *made: false where the packing is as it was, for the step is to
   be made at once. Returns 0, EX_SOFTWARE or EX_DATAERR. */
int small_advance(struct packing *p, struct contacts *s, struct small_list *l,
                  const struct small_opt *o, struct report *rep, bool *made,
                  struct failure *failure);
