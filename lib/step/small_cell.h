/*
 * step/small_cell.h: a cell that moves, in small steps. Its edges go through each small step as through a step of the
 * theta method [shape/cell.h]; images of bodies move with the edges, and where their rates change bodies follow the flow.
 * An edge that yields to a stress gets the reactions of a small step at its end, by the stress that they make; contacts see
 * that in the next one. Ways of bodies, on which the number of small steps and lists depend, are those relative to the flow.
 */
#pragma once

#include "step/small_run.h"

/* May any edge move in the step that begins where the packing is? */
bool small_cell_moves(const struct packing *p);
/* 1/s: how fast the flow of the cell stretches at most */
double small_cell_strain(const struct packing *p);
/* m/s: of a body relative to the flow, the fastest; where there are walls, the fastest of all */
double small_cell_speed(const struct packing *p);

/* Why small steps cannot follow the stress of the cell, in words; NULL: they can */
const char *small_cell_lacks(const struct packing *p);
/* m/s^2: the acceleration of a body that the stress of the cell presses from one side */
double small_cell_presses(const struct packing *p);
/* J: of edges that yield, and of the size */
double small_cell_energy(const struct packing *p);

/* r->cell: where the packing's is. Returns 0 or EX_SOFTWARE. */
int small_cell_init(struct small_run *r, struct failure *failure);
void small_cell_free(struct small_run *r);
/* A small step begins: edges where contacts act, rates and flow; by one thread */
void small_cell_begin(struct small_run *r);
/* Thread `me` of `threads` moves the images of pairs. */
void small_cell_images(struct small_run *r, int me, int threads);
/* m/s: v of a body at x relative to the flow */
vec3 small_cell_peculiar(const struct small_run *r, vec3 x, vec3 v);
/* m/s: half of how fast the flow moves two bodies that are near each other */
double small_cell_stretch(const struct small_run *r);
/* After the sweeps of a small step, before reactions are settled, by all threads: the stress of the reactions; */
void small_cell_stress(struct small_run *r, int me, int threads);
/* by one: what it makes of edges that yield, what edges do by images, and their motion; */
void small_cell_end(struct small_run *r);
/* and bodies first .. end-1 follow those that yield. */
void small_cell_follow(struct small_run *r, int64_t first, int64_t end);
