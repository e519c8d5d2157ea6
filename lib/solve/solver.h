/*
 * solve/solver.h: the solvers of a whole contact problem, siblings behind one table; each stands in a file
 * of its own. All end at the same criterion, recomputed from the reactions and the problem alone.
 */
#ifndef NSD_SOLVER_H
#define NSD_SOLVER_H

#include "law/method.h"
#include "problem/err.h"

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
    struct problem *p;
    const struct solve_opt *o;
    struct report *rep;
    bool believes; /* u of the rows is a local method's own */
    double value;  /* of the criterion, of what the rows hold */
    double start;  /* s on the wall */
};

/* run: from the r that the rows have to the criterion, or to where it sees no way on. Returns 0, or
   -1 when memory is short: then the rows are as good as before. */
struct solver {
    const char *name;
    double relax; /* omega where none is asked for */
    int (*run)(struct solve *);
};

extern const struct solver *const solvers[]; /* NULL ends it; the first is the default */
extern const struct solver solver_auto, solver_nlgs, solver_anderson, solver_cg, solver_prox,
    solver_ipm;

/*
 * Solves problem from the r that it has. The rows then hold r and u. Fills err (all of it but
 * max_overlap), criterion, eps, sweeps, converged, counts, seconds and history of the report.
 * Returns 0, or -1 when memory is short for the history, the only thing that cannot be left out.
 */
int solve_problem(struct problem *, const struct solve_opt *, struct report *);

/* ---- for the solvers ---- */

/* The criterion of what the rows hold, into value; tells the progress. */
double solve_judge(struct solve *);
/* value is at most eps; or there are no sweeps or seconds left. */
bool solve_met(const struct solve *);
bool solve_spent(const struct solve *);
/* The sweep's terms into the report, where a history is asked for; -1 when memory is short. */
int solve_history(struct solve *);

/* contacts: of more, less is kept */
enum { MANY = 100000 };

/* The best (r, u) that was judged, for solvers whose way is not straight */
struct kept {
    double value;   /* of the criterion */
    double (*r)[3]; /* [rows] */
    double (*u)[3]; /* [rows]; NULL, of MANY: u is then what the motion makes */
};
int kept_init(struct kept *, const struct problem *); /* 0, or -1 */
void kept_free(struct kept *);
void kept_offer(struct kept *, const struct solve *); /* what the rows hold, just judged */
void kept_back(const struct kept *, struct solve *);  /* into the rows, unless they hold better */

/* When the criterion was last judged, and when it is due again; begins with due INFINITY */
struct watch {
    double due;     /* m/s: a sweep's largest change of a normal velocity at which to judge */
    int32_t judged; /* after so many sweeps */
    int32_t all;    /* so many of a solve's first sweeps are all judged */
    bool looked;    /* by the last nlgs_sweep() */
    double change;  /* m/s: of that one */
};
/* How many threads share a sweep. */
int nlgs_team(const struct solve *);
/* One sweep, judged where that is due. Returns 0 to go on, 1 when the criterion is met, something is
   spent or not finite, -1 when memory is short. */
int nlgs_sweep(struct solve *, double omega, struct watch *);
/* At most so many sweeps with this omega, until the criterion is met or something is spent. */
int nlgs_sweeps(struct solve *, int32_t sweeps, double omega);

/*
 * The same accelerated. After so many sweeps or a few more it pauses where it is, judged, and goes on
 * from there the next time as if it had not paused. anderson_back() returns to the best that it has
 * judged, of value anderson_best(); anderson_anew() says that the reactions are others, whose like it
 * has not judged. NULL, or -1, when memory is short.
 */
struct anderson;
struct anderson *anderson_new(struct solve *);
int anderson_sweeps(struct anderson *, int32_t sweeps);
double anderson_best(const struct anderson *);
void anderson_back(struct anderson *);
void anderson_anew(struct anderson *);
void anderson_free(struct anderson *);

#endif
