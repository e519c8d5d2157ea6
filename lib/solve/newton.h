/*
 * solve/newton.h: the Newton of EAL for all contacts at once, within a proximal step: from x_0,
 * solve
 *
 *     Z_c(x, v) = x_c - proj(x_c - rho v_c, C) = 0,   v = W x + q + a (x - x_0)      [predbipo]
 *
 * Each contact's Z and its derivatives A and B are those of solve/local_eal.h, so that a step solves
 *
 *     (A + B (W + a I)) dx = -Z.
 *
 * a > 0 regularises a singular W (more contacts stick than the bodies have degrees of freedom for).
 * rho is large, 50 in units in which the diagonal of W is 1, except in newton_finish().
 */
#pragma once

#include "solve/system.h"

struct newton {
    struct scaled a;       /* the problem */
    struct system *system; /* factorises it; NULL before newton_factors() */
    double price;          /* ns: of a step [solve/solver.h] */
    double rho;            /* of the projection, in units in which W's diagonal is 1 */
    double alpha;          /* a, in multiples of the mean diagonal of W */
    int omega;             /* which over-relaxation its sweeps use */
    double *room;          /* holds all of the following: */
    double *x, *v, *z;     /* [n d]: the iterate, its velocity, a right-hand side */
    double *from, *start;  /* [n d]: x_0; the x to go back to */
    double *trial, *dx;    /* [n d] */
    double *L, *D;         /* [n][9] */
};

/*
 * For the problem of s. Returns 0; -1 when memory is short; 1 where the problem is too large or the
 * time left too short. There is something to free only after 0.
 */
int newton_init(struct newton *w, struct solve *s);
/* The same in two parts: everything but the factors, without which no steps can be made; then the
   factors. Where newton_factors() fails, what newton_assemble() made stays. */
int newton_assemble(struct newton *w, struct solve *s);
int newton_factors(struct newton *w, struct solve *s);
void newton_free(struct newton *w);

/* The number of sweeps that cost as much as a Newton step, within 200 to 2000 */
int32_t newton_sweeps_per_step(const struct newton *w, const struct problem *p);

/*
 * Full steps with this rho from x[n d], near enough to the solution that the status of each contact
 * is right. True where they lead to it: then it is the iterate, judged. Where they do not, mostly
 * the first step shows it.
 */
bool newton_finish(struct newton *w, struct solve *s, const double *x, double rho);

/*
 * Steps from the iterate, with sweeps of the same cost between them, until the criterion is met,
 * sweeps or seconds are spent, or `patience` steps in a row have not halved it. alpha: the first.
 * Ends with the best iterate restored.
 */
void newton_polish(struct newton *w, struct solve *s, double alpha, int patience);
