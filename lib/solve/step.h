/*
 * solve/step.h: one time step: detect, solve, move. The pipeline nsd-detect | nsd-solve | nsd-move makes
 * the same three calls.
 */
#ifndef NSD_STEP_H
#define NSD_STEP_H

#include "bodies/neighbours.h"
#include "solve/solver.h"

struct step_opt {
    double gap;   /* m: what counts as a contact */
    double alpha; /* > 0: rho = alpha m_red; else the method's default */
    enum order order;
    bool warm; /* start from the reactions of the contacts given, else from 0 */
    struct solve_opt solve;
};

/* Solves the contacts (frames and gaps are there); r, u, status go into them. */
int step_solve(const struct packing *, struct contacts *, const struct step_opt *, struct report *,
               struct why *);

/* The same for a problem given by W: r in W->r, u[n d]. */
int step_solve_delassus(struct delassus *, double *u, const struct step_opt *, struct report *,
                        struct why *);

/*
 * One whole step. contacts: in, the last step's (empty at first), to start from; out, this one's.
 * neighbours: of the steps before (empty at first), or NULL.
 * Where the solve diverged (its error is not finite) nothing has moved.
 */
int step_advance(struct packing *, struct contacts *, struct neighbours *, const struct step_opt *,
                 struct report *, struct why *);

#endif
