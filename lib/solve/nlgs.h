/*
 * solve/nlgs.h: the non-linear Gauss-Seidel method [paper, 3.1], sweeps over the contacts: as a
 * solver and for the solvers that are built on sweeps.
 */
#pragma once

#include "solve/solver.h"

/* When the criterion was last judged and when it is due again; starts with due = INFINITY. */
struct watch {
    double due;          /* m/s: judge when a sweep changes no normal velocity by more than this */
    double change;       /* m/s: the largest such change in the last sweep */
    int32_t last_judged; /* sweeps made when the criterion was last judged */
    int32_t judge_all_until; /* sweeps of the solve up to this one are all judged */
    bool just_judged;        /* the last nlgs_sweep() ended with a judgement */
};

/* One sweep with this omega, judged if due. Returns 0 to go on; 1 when the criterion is met, sweeps
   or seconds are spent, or the value is not finite; -1 when memory is short. */
int nlgs_sweep(struct solve *s, double omega, struct watch *w);
/* `sweeps` sweeps with this omega, or fewer when the solve is over before; the last one is judged.
   Returns 0, or -1 when memory is short. */
int nlgs_sweeps(struct solve *s, int32_t sweeps, double omega);
