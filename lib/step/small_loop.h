/*
 * step/small_loop.h: the loop over the small steps of an interval, by a team of threads [solve/small.h has the passes].
 */
#pragma once

#include "step/small_run.h"

/* team_work of a struct small_run: small steps until all are made, or `stop` */
void small_loop(void *run, int me, int threads);
