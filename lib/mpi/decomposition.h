/*
 * mpi/decomposition.h: which rank has which part of space. Any point has one owner; a box is met by the ranks whose
 * parts it reaches into. Zoltan cuts space into boxes, by recursive bisection.
 */
#pragma once

#include "base/vec.h"
#include "mpi/comm.h"

struct decomposition;

struct decomposition *decomposition_new(struct comm *t);
void decomposition_free(struct decomposition *y);
/* New cuts, so that the weights of the points x[n] of all ranks are shared out evenly. Collective. */
void decomposition_cut(struct decomposition *y, int64_t n, const vec3 *x, const float *weight);
/* The owner of a point; the ranks that meet the box lo .. hi, into rank[t->n]: returns how many. */
int decomposition_owner(const struct decomposition *y, vec3 x);
int decomposition_meets(const struct decomposition *y, vec3 lo, vec3 hi, int *rank);
