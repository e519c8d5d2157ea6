/*
 * step/small_pull.h: forces on single bodies in small steps. Those of a program or a document last for the whole
 * interval; signals are seen at the middle of each small step. They are part of a body's free motion, of which nothing
 * persists [solve/small.h].
 */
#pragma once

#include "step/small_run.h"

/* Of a body in the small step in hand */
struct small_pull {
    double dv[3], dw[3]; /* m/s, rad/s: its free motion, with gravity and the flow of the cell; */
    double gain[3];      /* m/s: that of the flow */
    /* In the interval, before this step and half of it */
    double work, carried; /* J: of the forces, and of the flow */
    double impulse[3];    /* N s: of the flow, with all of this step */
};

/* r->pull, where the packing has forces, or a cell that moves. Returns 0 or EX_SOFTWARE. */
int small_pull_init(struct small_run *r, struct failure *failure);
/* As begin_bodies() [step/small_loop.c], with forces */
double small_pull_bodies(struct small_run *r, int64_t first, int64_t end);
/* work, carried and impulse of all bodies, when all small steps of the interval have been made */
struct small_pull small_pull_sum(const struct small_run *r);
/* m/s^2: the acceleration of a body that its own force and those of all bodies behind it push, from any side; 0 without
   forces */
double small_pull_presses(const struct packing *p);
