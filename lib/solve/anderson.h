/*
 * solve/anderson.h: Gauss-Seidel accelerated by Anderson's mixing [solve/anderson.c], as a solver
 * and for auto, which interrupts it to look at the iterate; the sweeps then go on as if
 * uninterrupted.
 */
#pragma once

#include "solve/solver.h"

struct anderson;

/* Borrows s. NULL when memory is short. */
struct anderson *anderson_new(struct solve *s);
void anderson_free(struct anderson *a);

/* `sweeps` more sweeps, or a few beyond, unless the solve is over before. The iterate is judged
   after the last. 0, or -1 when memory is short. */
int anderson_sweeps(struct anderson *a, int32_t sweeps);
/* The criterion of the best iterate since anderson_new() or anderson_restart() */
double anderson_best_value(const struct anderson *a);
/* Goes back to that iterate; mixing begins again from there. */
void anderson_restore_best(struct anderson *a);
/* To be called when something else has changed the iterate: everything begins again from it. */
void anderson_restart(struct anderson *a);
