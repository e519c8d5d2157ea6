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

#include "solve/system.h"

struct newton {
    struct scaled a;       /* the problem, */
    struct system *system; /* and what factorises it; NULL before newton_factors() */
    double price;          /* of a step [solve/prices.h] */
    double rho;            /* of the projection, in units in which W's diagonal is 1 */
    double alpha;          /* a, in multiples of the mean diagonal of W */
    int omega;             /* which over-relaxation its sweeps are at */
    double *room;          /* of all these: */
    double *x, *v, *z;     /* [n d]: the iterate, its velocity, a right-hand side */
    double *from, *start;  /* [n d]: x_0; the x to go back to */
    double *trial, *dx;    /* [n d] */
    double *L, *D;         /* [n][9] */
};

/*
 * Of a solve's problem. 0; -1 when memory is short; else 1, with *reason (a literal), where the problem is
 * too large for it. Only after 0 is there something to free.
 */
int newton_init(struct newton *w, struct solve *s, const char **reason);
/* The same in two: all but what factorises, without which there are no steps; and that, which may be too
   large by itself: then the first part stays. */
int newton_assemble(struct newton *w, struct solve *s, const char **reason);
int newton_factors(struct newton *w, struct solve *s, const char **reason);
void newton_free(struct newton *w);

/* Sweeps that cost as much as a Newton step, within limits that serve */
int32_t newton_sweeps_per_step(const struct newton *w, const struct problem *p);

/*
 * Full steps with this rho from x[n d], which knows what each contact does, to the solution, which becomes
 * the iterate, judged. False where they do not lead there, which the first one tells.
 */
bool newton_finish(struct newton *w, struct solve *s, const double *x, double rho);

/*
 * Steps from the iterate, with sweeps between them that cost as much, until the criterion is met,
 * something is spent, or `patience` steps in a row have not halved it. alpha is where it begins. The best
 * iterate is back in the end.
 */
void newton_polish(struct newton *w, struct solve *s, double alpha, int patience);

#endif
