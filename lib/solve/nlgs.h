/*
 * solve/nlgs.h: sweeps over the contacts, the non-linear Gauss-Seidel method, for itself and for the
 * solvers that are made of sweeps.
 */
#ifndef NSD_NLGS_H
#define NSD_NLGS_H

#include "solve/solver.h"

/* When the criterion was last judged, and when it is due again; begins with due INFINITY */
struct watch {
    double due;          /* m/s: a sweep's largest change of a normal velocity at which to judge */
    int32_t last_judged; /* the number of the sweep after which it was */
    int32_t judge_all_until; /* a solve's first sweeps up to this number are all judged */
    bool just_judged;        /* the last nlgs_sweep() has judged */
    double change;           /* m/s: of that sweep, see due */
};

/* One sweep, judged where that is due. Returns 0 to go on, 1 when the criterion is met, something is
   spent or not finite, -1 when memory is short. */
int nlgs_sweep(struct solve *s, double omega, struct watch *w);
/* Up to `sweeps` of them with this omega, until the criterion is met or something is spent; the last one
   is judged. 0, or -1 when memory is short. */
int nlgs_sweeps(struct solve *s, int32_t sweeps, double omega);
/* The solver cannot do what was asked, for this reason (a literal), and sweeps instead, to the end: the
   report says so. */
int nlgs_fall_back(struct solve *s, const char *reason);

#endif
