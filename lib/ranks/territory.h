/*
 * ranks/territory.h: which rank has which part of space: a box, by Zoltan's recursive coordinate bisection, whose
 * cuts are kept, or cells of a grid [ranks/cells.h]. Any point has one owner; a box is met by the ranks whose parts
 * it reaches into.
 */
#ifndef NSD_TERRITORY_H
#define NSD_TERRITORY_H

#include "base/vec.h"
#include "ranks/talk.h"

#include <stdbool.h>

struct territory;

struct territory *territory_new(struct talk *t, bool hypergraph);
void territory_free(struct territory *y);
/* New cuts, so that the weights of the points x[n] of all ranks are shared out evenly. Collective. */
void territory_cut(struct territory *y, int64_t n, const vec3 *x, const float *weight);
/* The owner of a point; the ranks that meet the box lo .. hi, into rank[t->n]: returns how many. */
int territory_owner(const struct territory *y, vec3 x);
int territory_meets(const struct territory *y, vec3 lo, vec3 hi, int *rank);

#endif
