/* mpi/answers.h: what solvers ask [solve/exchange.h] that ranks answer alike, in whatever order they solve. */
#ifndef NSD_ANSWERS_H
#define NSD_ANSWERS_H

#include "solve/exchange.h"
#include "mpi/comm.h"

/* Sets s->with, most, count, agree and fail. */
void answers_alike(struct exchange *s, struct comm *t);

#endif
