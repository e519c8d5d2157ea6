/*
 * solve/solver.h: the solvers of a whole contact problem, siblings behind one table; each stands in a file
 * of its own. All end at the same criterion, and it counts as met only when it holds for the velocities
 * that the reactions make, computed anew from the problem and the reactions alone.
 *
 * A solver is a row of turns over one iterate: the reactions in the problem's slots, the velocities that
 * they make (of bodies, or by W), what a local method believes u to be, and their error.
 */
#ifndef NSD_SOLVER_H
#define NSD_SOLVER_H

#include "law/method.h"
#include "problem/err.h"
#include "solve/best.h"

struct solver;

struct solve_opt {
    const struct solver *global;
    const struct method *method; /* the local one, of the sweeps */
    struct local_opt local;
    enum criterion criterion;
    double eps;
    int32_t max_sweeps;
    double max_seconds; /* s on the wall; 0: any */
    double relax; /* omega: r + omega (r_new - r), back onto the cone; 0: the solver's choice */
    int threads;
    bool every_sweep; /* evaluate the criterion after every sweep, not only when it may be met */
    bool history;     /* keep the terms of every sweep (implies every_sweep) */
    void (*progress)(int32_t sweeps, double value); /* told of each evaluation; or NULL */
};

/* A solve on its way */
struct solve {
    struct problem *p;  /* the iterate's r, u, and velocities */
    bool believes;      /* u of the slots is a local method's own, else the motion's */
    bool renewed;       /* the velocities were made anew and nothing was added to them since */
    int32_t renewed_at; /* the number of the sweep at which they were last */
    double value;       /* the criterion of the iterate as it was judged last */

    const struct solve_opt *o;
    struct report *rep;
    double start;     /* s on the wall */
    double pace;      /* s that a priced ns has taken, of the slowest Newton step so far */
    struct best best; /* the best iterate that was judged since solve_keep_best() */
};

/* run: from the iterate given to the criterion, or to where it sees no way on. Returns 0, or -1 when
   memory is short: then the iterate is as good as before. */
struct solver {
    const char *name;
    const char *help;
    double relax; /* omega where none is asked for; 0: it varies */
    int (*run)(struct solve *s);
};

/* NULL ends it; the first is the default. */
extern const struct solver *const solvers[];
extern const struct solver solver_auto, solver_nlgs, solver_anderson, solver_cg, solver_prox,
    solver_ipm;

/*
 * Solves a problem from the r that it has. Its slots then hold r and u. Fills method, err (all of it but
 * max_overlap), criterion, eps, sweeps, converged, counts, work, fallback, seconds and history of the
 * report. Returns 0, or -1 when memory is short for what cannot be left out.
 */
int solve_problem(struct problem *p, const struct solve_opt *o, struct report *rep);

/* ---- for the solvers ---- */

/*
 * The criterion of the iterate, into value. Where it seems met, the velocities are made anew and it is
 * judged again. The best iterate is kept; progress is told.
 */
double solve_judge(struct solve *s);
/* value is at most eps; or there are no sweeps or seconds left. */
bool solve_met(const struct solve *s);
bool solve_spent(const struct solve *s);
/* Either: nothing more is to be done. */
bool solve_over(const struct solve *s);
/* s on the wall that are left; INFINITY where any are */
double solve_seconds_left(const struct solve *s);

/* r[slots][3] become the iterate's reactions, with the velocities that they make; not yet judged. */
void solve_react(struct solve *s, const double *r);

/*
 * From now on the best iterate is kept, this one the first, which has been judged; and back to it, unless
 * the iterate is as good: so a solve ends. 0, or -1 when memory is short.
 */
int solve_keep_best(struct solve *s);
void solve_restore_best(struct solve *s);
/* The same with a keeper of the solver's own: room for iterates; what was just judged offered; back. */
int solve_best_init(struct best *b, const struct problem *p);
void solve_best_offer(const struct solve *s, struct best *b);
void solve_best_restore(struct solve *s, const struct best *b);

/* The sweep's terms into the report, where a history is asked for; -1 when memory is short. */
int solve_history(struct solve *s);
/* Whether the seconds that are left, where they are limited, are enough for something of this price: by
   the pace of the Newton steps so far. */
bool solve_affords(const struct solve *s, double price);
/* A Newton step of this price, begun at `since` (s on the wall), into the report */
void solve_count_newton(struct solve *s, double price, double since);
/* contacts: of more, a keeper has no room for u */
enum { MANY_CONTACTS = 100000 };

#endif
