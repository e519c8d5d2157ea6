/*
 * solve/anderson.h: Gauss-Seidel accelerated by Anderson's mixing, for itself and for auto, which lets it
 * pause: it goes on later as if it had not paused.
 */
#ifndef NSD_ANDERSON_H
#define NSD_ANDERSON_H

#include "solve/solver.h"

struct anderson;

/* NULL when memory is short */
struct anderson *anderson_new(struct solve *s);
void anderson_free(struct anderson *a);

/* `sweeps` more, or a few beyond; the iterate is judged then. 0, or -1 when memory is short. */
int anderson_sweeps(struct anderson *a, int32_t sweeps);
/* The criterion of the best iterate since the beginning, or since anderson_restart() */
double anderson_best_value(const struct anderson *a);
/* Back to that iterate; the mixing begins anew from there. */
void anderson_restore_best(struct anderson *a);
/* The iterate has been changed from outside: everything begins anew from it. */
void anderson_restart(struct anderson *a);

#endif
