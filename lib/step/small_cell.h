/*
 * step/small_cell.h: a cell that moves, in small steps. Its edges go through each small step as through a step of the
 * theta method [shape/cell.h]; images of bodies move with the edges, and where their rates change bodies follow the flow.
 * Ways of bodies, on which the number of small steps and lists depend, are those relative to the flow.
 */
#pragma once

#include "step/small_run.h"

/* The flow that speeds of balls are relative to, and by how much (m/s) it moves two of them that touch; none where there are
   walls or shapes */
struct small_flow {
    struct cell_flow flow;
    double stretch;
};
struct small_flow small_cell_flow(const struct packing *p);
/* m/s: of the fastest point of body i, of a ball its centre relative to the flow */
double small_body_speed(const struct packing *p, const struct small_flow *f, int64_t i);

/* May any edge move in the step that begins where the packing is? */
bool small_cell_moves(const struct packing *p);
/* r->cell: where the packing's is */
void small_cell_init(struct small_run *r);
/* A small step begins: edges where contacts act, rates and flow; by one thread */
void small_cell_begin(struct small_run *r);
/* Thread `me` of `threads` moves the images of pairs. */
void small_cell_images(struct small_run *r, int me, int threads);
/* m/s: v of a body at x relative to the flow */
vec3 small_cell_peculiar(const struct small_run *r, vec3 x, vec3 v);
/* m/s: half of how fast the flow moves two bodies that are near each other */
double small_cell_stretch(const struct small_run *r);
/* After the sweeps of a small step, before reactions are settled: what edges do by images, and their motion; by one thread */
void small_cell_end(struct small_run *r);
