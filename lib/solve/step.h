/*
 * solve/step.h: one time step: detect, solve, move. The pipeline nsd-detect | nsd-solve | nsd-move
 * makes the same three calls.
 */
#ifndef NSD_STEP_H
#define NSD_STEP_H

#include "bodies/neighbours.h"
#include "problem/plan.h"
#include "solve/solver.h"

struct step_opt {
    double gap;   /* m: a contact is a pair with at most this gap */
    double alpha; /* > 0: rho = alpha m_red; else the method's default */
    enum order order;
    bool
        warm; /* start from the reactions of the contacts given, those of the packing's memory; else from 0 */
    bool bare; /* nobody reads the report's balance of this step: it is left out */
    struct solve_opt solve;
};

/* What a run keeps from step to step, empty at first: not to find it anew. Results are the same without. */
struct step_memory {
    struct neighbours near;
    struct plan *plan;
};
void step_forget(struct step_memory *m); /* all; m is empty again */

/* Does this solver make sweeps alone of what bonds and moments hold together? Others want a W. */
bool step_sweeps(const struct solver *global);

/* All that follow return 0, or EX_SOFTWARE or EX_DATAERR with the reason in why. */

/* Solves the contacts, whose bases and gaps are known; their found[] gets r, u and status. */
int step_solve(const struct packing *pack, struct contacts *s, const struct step_opt *o,
               struct report *rep, struct why *why);

/* The same for a problem given by W: r (N s) in W->r, u[n d] (m/s). */
int step_solve_delassus(struct delassus *W, double *u, const struct step_opt *o, struct report *rep,
                        struct why *why);

/*
 * One whole step; if warm, from the packing's memory. s: the contacts of this step, in place of others. m may be NULL. Where the solve diverged (its error is not finite) nothing moves.
 */
int step_advance(struct packing *p, struct contacts *s, struct step_memory *m,
                 const struct step_opt *o, struct report *rep, struct why *why);

/* Its parts. The contacts, with their last reactions if warm */
int step_detect(struct packing *p, struct contacts *s, struct neighbours *near,
                const struct step_opt *o, struct report *rep, struct why *why);
/* found[], and the report of the solve; kept: of problem_prepare_again(), or NULL. Impacts that would gain energy
   are solved anew with less restitution [solve/rebound.h]; and this alone, of contacts that are solved. */
int step_solve_contacts(const struct packing *pack, struct contacts *s, struct plan **kept,
                        const struct step_opt *o, struct report *rep, struct why *why);
int step_bound_impacts(const struct packing *pack, struct contacts *s, struct plan **kept,
                       const struct step_opt *o, struct report *rep, struct why *why);
/* The balances alone; or the balances and the motion */
int step_balance(const struct packing *p, const struct contacts *s, const struct step_opt *o,
                 struct report *rep, struct why *why);
int step_move(struct packing *p, struct contacts *s, const struct step_opt *o, struct report *rep,
              struct why *why);
/* After it: adds to the report which of the first n bodies have gone through something. surface: [walls] of those
   that are meshes */
void step_watch(const struct packing *p, int64_t n, const struct surface *surface,
                struct report *rep);

#endif
