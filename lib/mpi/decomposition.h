/*
 * mpi/decomposition.h: which rank has which part of space. Any point has one owner; a box is met by the ranks whose
 * parts it reaches into. Zoltan cuts; in which way, is one of a table.
 */
#ifndef NSD_DECOMPOSITION_H
#define NSD_DECOMPOSITION_H

#include "base/vec.h"
#include "mpi/comm.h"

struct decomposition;

/* way: 0 by bisection, 1 by the hypergraph */
struct decomposition *decomposition_new(struct comm *t, int way);
void decomposition_free(struct decomposition *y);
/* New cuts, so that the weights of the points x[n] of all ranks are shared out evenly. Collective. */
void decomposition_cut(struct decomposition *y, int64_t n, const vec3 *x, const float *weight);
/* The owner of a point; the ranks that meet the box lo .. hi, into rank[t->n]: returns how many. */
int decomposition_owner(const struct decomposition *y, vec3 x);
int decomposition_meets(const struct decomposition *y, vec3 lo, vec3 hi, int *rank);

/* A way: the same of what its begin() has made */
struct cuts {
    void *(*begin)(struct comm *t);
    void (*end)(void *made);
    void (*cut)(void *made, int64_t n, const vec3 *x, const float *weight);
    int (*owner)(const void *made, vec3 x);
    int (*meets)(const void *made, vec3 lo, vec3 hi, int *rank);
};
extern const struct cuts cuts_bisection, cuts_hypergraph;

/* Zoltan, with these parameters, pairs of a name and a value up to a NULL */
struct Zoltan_Struct *decomposition_zoltan(struct comm *t, const char *const set[][2]);

#endif
