/*
 * step/small_loop.h: the loop over the small steps of an interval, by a team of threads [solve/small.h has the passes].
 */
#pragma once

#include "step/small_run.h"

/* team_work of a struct small_run: small steps until all are made, or `stop` */
void small_loop(void *run, int me, int threads);

/* r->wall, where contacts act in the small step that begins */
void small_set_walls(struct small_run *r);
/* m/s: the fastest point of walls, with their belts */
double small_wall_speed(const struct packing *p);
/* Where the body of t is against its wall: n, v, arm. False: it is farther than `reach` (m). */
bool small_look_at_touch(const struct small_run *r, struct small_touch *t, double reach);
