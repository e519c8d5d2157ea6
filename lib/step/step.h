/*
 * step/step.h: one time step: detect, solve, move. The pipeline nsd-detect | nsd-solve | nsd-move
 * makes the same three calls.
 */
#pragma once

#include "contact/neighbours.h"
#include "solve/plan.h"
#include "solve/solver.h"
#include "step/balance.h"
#include "step/impulse.h"
#include "step/project.h"
#include "step/small_list.h"
#include "step/substeps.h"

struct step_opt {
    double gap;   /* m: a contact is a pair with at most this gap */
    double alpha; /* > 0: rho = alpha m_red; else the method's default */
    enum order order;
    bool
        warm; /* start from the reactions of the contacts given, those of the packing's memory; else from 0 */
    bool small_warm; /* likewise, small steps, for which criterion and order do not choose */
    bool as_is; /* reactions that have not converged act whatever they give: the paper's protocol */
    bool bare;  /* nobody reads the report's balance of this step: it is left out */
    double
        small; /* radii: a step is made in small ones, of which each moves a body by so much at most
                      [step/small_step.h]; 0: at once */
    double bound; /* of what is missing of the reactions of small steps; 0: none */
    struct small_part
        *part; /* of small steps that several processes divide [step/small_part.h]; NULL: alone */
    bool compare; /* reactions of small steps are compared with converged ones, on a copy */
    struct solve_opt solve;
};

/* What a run keeps from step to step, empty at first: not to find it again. Results are the same without. */
struct step_memory {
    struct neighbours near;
    struct plan *plan;
    struct small_list small;
};
void step_forget(struct step_memory *m); /* all; m is empty again */

/* All that follow return 0, or EX_SOFTWARE or EX_DATAERR with the reason in why. */

/* Solves the contacts, whose bases and gaps are known; their found[] gets r, u and status. */
int step_solve(const struct packing *pack, struct contacts *s, const struct step_opt *o,
               struct report *rep, struct failure *failure);

/* The same for a problem given by W: r (N s) in W->r, u[n d] (m/s). */
int step_solve_delassus(struct delassus *W, double *u, const struct step_opt *o, struct report *rep,
                        struct failure *failure);

/* A step in small ones, where o asks for them and the packing has nothing that they lack. *made: false where the packing is as it
   was, and the step is to be made at once; *parts > 0: in so many parts. step_after_parts() follows. */
int step_in_small(struct packing *p, struct contacts *s, struct step_memory *m,
                  const struct step_opt *o, struct report *rep, bool *made, int64_t *parts,
                  struct failure *failure);
/* Reactions from which small steps would begin, and which may be those of an impact, are forgotten. */
void step_after_parts(struct packing *p, const struct step_opt *o, int64_t parts);

/*
 * One whole step; if warm, from the packing's memory. s: the contacts of this step, in place of others. m may be NULL. Where the
 * solve diverged, or something would not be finite after the step, nothing moves: report_made()
 */
int step_advance(struct packing *p, struct contacts *s, struct step_memory *m,
                 const struct step_opt *o, struct report *rep, struct failure *failure);

/*
 * What a step asks of those who make it: one process, or the ranks of a run (mpi/rank_step.h). Each returns 0
 * or a status, with the reason in why.
 */
struct step_makers {
    /* This process has no packing of its own: it takes part in finding and solving contacts, and another one
       reports and moves. */
    bool helps;
    /* The contacts, with their last reactions if warm */
    int (*detect)(struct step_makers *m, struct packing *p, struct contacts *s,
                  const struct step_opt *o, struct failure *failure);
    /* rep->err.max_overlap and rep->depth */
    int (*measure)(struct step_makers *m, const struct packing *p, const struct contacts *s,
                   struct report *rep, struct failure *failure);
    /* found[], and the report of the solve */
    int (*solve)(struct step_makers *m, const struct packing *p, struct contacts *s,
                 const struct step_opt *o, struct report *rep, struct failure *failure);
    /* The sums of the reactions become those of all who push a body; NULL: they are. */
    void (*add_impulses)(struct step_makers *m, struct impulses *sum);
    /* The balances of the step */
    int (*balance)(struct step_makers *m, const struct packing *p, const struct contacts *s,
                   const struct impulses *sum, struct balance *b, struct failure *failure);
    /* rep->endless becomes that of all who make the step; NULL: it is. */
    void (*agree)(struct step_makers *m, struct report *rep);
    /* rep->unsolved */
    void (*find_unsolved)(struct step_makers *m, const struct packing *p, const struct contacts *s,
                          struct report *rep);
    /* Bodies that overlap are moved apart, where the packing needs it; did, or NULL: what that has done, and the energy
       then */
    int (*move_apart)(struct step_makers *m, struct packing *p, const struct contacts *s,
                      struct projected *did, struct failure *failure);
    /* rep->fast and rep->fast_id: how many bodies move in a step by more than they are thick */
    void (*watch)(struct step_makers *m, const struct packing *p, struct report *rep);
};
/* The step, or a part of it, by these makers */
int step_make(struct step_makers *m, struct packing *p, struct contacts *s,
              const struct step_opt *o, struct report *rep, struct failure *failure);
/* What one process does: a process that has a whole packing */
int step_measure_whole(struct step_makers *m, const struct packing *p, const struct contacts *s,
                       struct report *rep, struct failure *failure);
void step_watch_whole(struct step_makers *m, const struct packing *p, struct report *rep);
void step_unsolved_whole(struct step_makers *m, const struct packing *p, const struct contacts *s,
                         struct report *rep);
int step_balance_whole(struct step_makers *m, const struct packing *p, const struct contacts *s,
                       const struct impulses *sum, struct balance *b, struct failure *failure);
int step_move_apart_whole(struct step_makers *m, struct packing *p, const struct contacts *s,
                          struct projected *did, struct failure *failure);
/* What the report's balance has after the motion */
void step_report_moved(struct report *rep, const struct packing *p, const struct projected *did);

/* Parts of it. */
/* found[], and the report of the solve; kept: of struct prepare_opt, or NULL. Impacts that would gain energy
   are solved again with less restitution [step/balance.h]; and this alone, of contacts that are solved. */
int step_solve_contacts(const struct packing *pack, struct contacts *s, struct plan **kept,
                        const struct step_opt *o, struct report *rep, struct failure *failure);
int step_bound_impacts(const struct packing *pack, struct contacts *s, struct plan **kept,
                       const struct step_opt *o, struct report *rep, struct failure *failure);
/* The options of a part */
struct step_opt step_opt_part(const struct step_opt *o, const struct substeps *s);
