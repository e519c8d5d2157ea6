/*
 * solve/solver.h: the solvers of a whole contact problem, in one table; each has a file of its own.
 * All end at the same criterion. It counts as met only when it holds for the velocities computed
 * again from the problem and the reactions alone.
 *
 * The solvers share one iterate, which they change in place: the reactions in the problem's slots,
 * the velocities that they make (of the bodies, or by W), u as a local method believes it to be,
 * and the value of the criterion.
 */
#pragma once

#include "solve/err.h"
#include "solve/method.h"
#include "solve/problem.h"

#include <stdint.h>

/* The best of all points judged, for methods that do not improve at every step. */

struct best {
    double value; /* of the point kept, smaller is better; INFINITY: none is kept */
    int64_t size; /* numbers of a point */
    double *x;    /* [size] the point kept */
    int place;    /* of it on a device [solve/device.h] */
};

/* Allocates room for a point. Returns 0, or -1 when memory is short: then nothing is ever kept. */
int best_init(struct best *b, int64_t size);
void best_free(struct best *b);

/* Where to write a point of this value, if it is better than the one kept; else NULL */
double *best_offer(struct best *b, double value);
/* Forgets the point kept; the next one offered with a finite value is kept. */
void best_forget(struct best *b);

/*
 * What the parts of a solve cost, for the strategies that choose between them.
 *
 * Prices are ns of an ordinary core, but they are counted and not timed, so that the same problem
 * is solved in the same way everywhere. Their sum over a solve is its report's `work`.
 */

/* A sweep over all contacts */
double price_sweep(const struct problem *p);

/* A Newton step with its one factorisation: `multiplications` of the factorisation (known from its
   fill), `entries` of the matrix's pattern */
double price_newton_step(double multiplications, double entries);
/* Finding the fill of a pattern with this many entries, before its first factorisation */
double price_analysis(double entries);
/* Making W's blocks, with this many entries, from the bodies or from another W */
double price_assembly(double entries);

struct solver;

struct solve_opt {
    const struct solver *global; /* the solver of all contacts */
    const struct method *method; /* the local method of its sweeps */
    struct local_opt local;
    enum criterion criterion;
    double eps;         /* the criterion is met at this value or below */
    int32_t max_sweeps; /* sweeps, at most */
    double max_seconds; /* s on the wall; 0: no limit */
    double relax; /* omega: r + omega (r_new - r), back onto the cone; 0: the solver's choice */
    int threads;
    struct device *device; /* borrowed: makes the sweeps [solve/device.h]; NULL: the CPU does */
    bool every_sweep; /* evaluate the criterion after every sweep, not only when it may be met */
    bool history;     /* keep the terms of every sweep (implies every_sweep) */
    void (*progress)(int32_t sweeps, double value); /* called at each evaluation; or NULL */
};

/* A solve in progress */
struct solve {
    struct problem *p; /* the iterate's r, u, and velocities */
    bool believes;     /* u of the slots is a local method's own, else the motion's */
    bool renewed;      /* nothing was added to the velocities since they were last computed again */
    int32_t renewed_at; /* sweeps made when they were */
    double value;       /* the criterion of the iterate when it was last judged */
    bool jammed;        /* so were contacts: nothing is to make their reactions grow faster */
    int32_t enough;     /* sweeps after which eps suffices; before them a part of it is aimed at */

    const struct solve_opt *o;
    struct report *rep;
    double start;     /* s on the wall */
    double pace;      /* s on the wall per priced ns, of the slowest Newton step so far */
    struct best best; /* the best iterate judged since solve_keep_best() */
};

struct solver {
    const char *name;
    const char *help;
    double relax; /* omega where none is asked for; 0: it varies */
    /* Improves the iterate until the criterion is met, sweeps or seconds are spent, or it knows no
       further way. Returns 0, or -1 when memory is short. */
    int (*run)(struct solve *s);
};

/* NULL ends it; the first is the default. */
extern const struct solver *const solvers[];
extern const struct solver solver_auto, solver_nlgs, solver_anderson;

/*
 * Solves a problem, starting from the r in its slots; afterwards they hold r and u. Fills method,
 * err (all but max_overlap), criterion, eps, sweeps, converged, counts, work, given_up,
 * seconds and history of the report. Returns 0, or -1 when memory is short for what the solver
 * cannot do without.
 */
int solve_problem(struct problem *p, const struct solve_opt *o, struct report *rep);

/* ---- for the solvers ---- */

/*
 * Judges the iterate: puts the criterion into value and returns it. Where it seems met, the
 * velocities are computed again and it is evaluated again. Keeps the iterate if it is the best, and
 * calls progress.
 */
double solve_judge(struct solve *s);
/* What the value has to reach: eps; of CRITERION_VELOCITY less, as long as sweeps are cheap */
double solve_target(const struct solve *s);
/* The value has reached it. */
bool solve_met(const struct solve *s);
/* No sweeps or no seconds are left. */
bool solve_spent(const struct solve *s);
/* Either: the solver is to return. */
bool solve_over(const struct solve *s);
/* s left on the wall; INFINITY without a limit */
double solve_seconds_left(const struct solve *s);

/* r[slots][3] (N s) become the iterate's reactions, with their velocities; not yet judged. */
void solve_react(struct solve *s, const double *r);

/* From now on keeps the best iterate, beginning with this one, which must have been judged. 0, or
   -1 when memory is short. */
int solve_keep_best(struct solve *s);
/* Goes back to the best iterate kept, unless the present one is as good. Every solve ends so. */
void solve_restore_best(struct solve *s);
/* The same three steps with a `struct best` of the solver's own: room for an iterate; the iterate
   just judged is kept if it is better; back to the one kept */
int solve_best_init(struct best *b, const struct problem *p);
void solve_best_offer(const struct solve *s, struct best *b);
void solve_best_restore(struct solve *s, const struct best *b);

/* Appends the sweep's terms to the report where a history is asked for; -1 when memory is short. */
int solve_history(struct solve *s);
/* Whether the seconds left suffice for this price (ns), at the pace of the Newton steps so far */
bool solve_affords(const struct solve *s, double price);
/* Adds to the report a Newton step of this price (ns), begun at `since` (s on the wall). */
void solve_count_newton(struct solve *s, double price, double since);

/* contacts: with more, memory matters: no u is kept with the best iterate, and less for mixing */
enum { MANY_CONTACTS = 100000 };
