/*
 * solve/newton.h: the Newton of EAL for all contacts at once, within a proximal step: from x_0,
 *
 *     Z_c(x, v) = x_c - proj(x_c - rho v_c, C) = 0,   v = W x + q + a (x - x_0)      [predbipo]
 *
 * each contact's Z and its derivatives A, B those of law/local_eal.h, so that a step solves
 *
 *     (A + B (W + a I)) dx = -Z.
 *
 * a > 0 makes a W regular that is not (a packing in which more contacts stick than its bodies can
 * tell apart); rho is large, 50 where the diagonal of W is 1, but for the last steps.
 */
#ifndef NSD_NEWTON_H
#define NSD_NEWTON_H

#include "solve/solver.h"
#include "solve/system.h"

struct newton {
    struct scaled whole;
    struct system *system; /* NULL before newton_factors() */
    double rho;            /* of the projection, in units in which W's diagonal is 1 */
    double alpha;          /* a, in multiples of the mean diagonal of W */
    int omega;             /* which over-relaxation its sweeps are at */
    double *x, *v, *z;     /* [n d]: the iterate, its velocity, a right-hand side */
    double *from, *start;  /* [n d]: x_0; the x to go back to */
    double *trial, *dx;    /* [n d] */
    double *L, *D;         /* [n][9] */
    double *best;          /* [n d] the best iterate that was judged, and */
    double value;          /* its criterion */
    double sweep_cost;     /* of a sweep and */
    double cost;           /* of a Newton step, in one unit */
    int64_t aside;         /* Newton steps of parts [solve/subset.h], which cost next to nothing */
};

/* 0, or -1 where the problem is too large for it: then there is nothing to free. */
int newton_init(struct newton *, const struct problem *);
/* The same in two: all but what factorises, without which there are no steps, and then that, which may
   be too large by itself. */
int newton_assemble(struct newton *, const struct problem *);
int newton_factors(struct newton *);
void newton_free(struct newton *);

/* ns, or so, of a sweep */
double newton_sweep_cost(const struct problem *);
/* Sweeps that cost as much as a Newton step, or so */
int32_t newton_share(const struct newton *);

/* The rows' reactions become x; x goes into the rows and is judged, and kept when it is the best. */
void newton_get(struct newton *, struct solve *);
void newton_put(struct newton *, struct solve *);
/* The best iterate into the rows. */
void newton_back(struct newton *, struct solve *);

/* The natural map at x, scaled; v is x's. */
double newton_map(struct newton *);

/*
 * Full steps with this rho, from an x that knows what each contact does, to the solution, into the
 * rows. False where they do not lead there, which the first one tells: x is as it was.
 */
bool newton_finish(struct newton *, struct solve *, double rho);

/*
 * Steps from the rows' x, with sweeps between them that cost as much, until the criterion is met,
 * something is spent, or so many steps have not halved it. alpha is where it begins.
 */
void newton_polish(struct newton *, struct solve *, double alpha, int patience);

#endif
