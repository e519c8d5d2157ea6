/*
 * step/small_pull.h: forces on single bodies in small steps. Those of a program or a document last for the whole
 * interval; signals are seen at the middle of each small step. They are part of a body's free motion, of which nothing
 * persists [solve/small.h].
 */
#pragma once

#include "step/small_run.h"

/* r->pull, where the packing has forces, or a cell that moves. Returns 0 or EX_SOFTWARE. */
int small_pull_init(struct small_run *r, struct failure *failure);
/* As begin_bodies() [step/small_loop.c], with forces */
double small_pull_bodies(struct small_run *r, double warm, int64_t first, int64_t end);
/* work, carried and impulse of all bodies, when all small steps of the interval have been made */
struct small_pull small_pull_sum(const struct small_run *r);
/* m/s^2: the acceleration of a body that its own force and those of all bodies behind it push, from any side; 0 without
   forces */
double small_pull_presses(const struct packing *p);
/* m/s^2: what the loads of walls would give to all bodies together */
double small_pull_load(const struct packing *p);
