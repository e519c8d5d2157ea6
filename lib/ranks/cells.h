/*
 * ranks/cells.h: space cut into the cells of a grid, each of which is one rank's: by Zoltan's hypergraph
 * partitioner (PHG). A cell weighs what its bodies do. It makes a hyperedge with the cells around it, which
 * weighs as much as it has bodies: these are copied to all ranks that have one of the others, so what the
 * partitioner keeps small is the number of copies [Catalyurek & Aykanat 1999]. Cells without a body go with the
 * nearest that have one, and so do places outside of the grid.
 */
#ifndef NSD_CELLS_H
#define NSD_CELLS_H

#include "base/vec.h"
#include "ranks/talk.h"

struct cells;

struct cells *cells_new(struct talk *t);
void cells_free(struct cells *c);
/* As in ranks/territory.h */
void cells_cut(struct cells *c, int64_t n, const vec3 *x, const float *weight);
int cells_owner(const struct cells *c, vec3 x);
int cells_meet(const struct cells *c, vec3 lo, vec3 hi, int *rank);

#endif
