/*
 * solve/mixing.h: the inner loops of Anderson's acceleration (solve/anderson.c), written once for
 * every vector width.
 *
 * A vector is [bundles][d][8], the reactions as the slots have them, N s; where there are bonds or moments
 * [bundles][9][8], r, z and m. In a sum over contacts
 * each contact is weighted by lambda_max(W~_cc), so that a sum of squares is an energy whatever the
 * masses.
 *
 * Sweeps lead from x to g, and f = g - x. dg[] and df[] are the last changes of g and f from one
 * mixing to the next. While the sweeps run, the oldest change is no longer needed, since the next
 * one will replace it: until then its memory holds the g of the last mixing (in dg) and x (in df).
 */
#pragma once

#include "solve/problem.h"

enum {
    MIXING_DEPTH = 5,     /* changes kept; with 2, 3 and 6 more sweeps are needed */
    MIXING_DEPTH_MANY = 2 /* changes kept of MANY_CONTACTS: each takes 16 d bytes a contact */
};

/* The numbers of a slot in a vector */
static inline int mixing_width(const struct problem *p)
{
    return p->kind.extra ? 3 + BESIDE_R : p->d;
}

struct mixing {
    int depth; /* MIXING_DEPTH or MIXING_DEPTH_MANY */
    int next;  /* 0 .. depth-1: where the next change will be stored */
    double *f, *dg[MIXING_DEPTH], *df[MIXING_DEPTH];
};

/* Sums over the contacts, each in eight partial sums: lane k of every bundle is in sum k */
struct mixing_sums {
    double f2[BUNDLE], ff[MIXING_DEPTH][BUNDLE], fd[MIXING_DEPTH][BUNDLE];
};

static inline void mixing_sums_add(struct mixing_sums *t, const struct mixing_sums *s)
{
    for (int k = 0; k < BUNDLE; k++) t->f2[k] += s->f2[k];
    for (int j = 0; j < MIXING_DEPTH; j++)
        for (int k = 0; k < BUNDLE; k++) t->ff[j][k] += s->ff[j][k], t->fd[j][k] += s->fd[j][k];
}

/* The loops for one vector width */
struct mixing_loops {
    /* After the sweeps, in bundles first .. end-1: computes f, and the changes of g and f into
       dg[next] and df[next]; adds f.f, df[next].df[] and f.df[] to the sums. */
    void (*measure)(const struct problem *p, const struct mixing *m, int64_t first, int64_t end,
                    struct mixing_sums *sums);
    /* r = x = g + leap f - sum_j gamma_j dg_j, projected onto the discs of friction; the bodies get
       the velocities that go with it. Shared by threads as a sweep is. */
    void (*react)(struct problem *p, int me, int threads, const struct mixing *m, double leap,
                  const double gamma[MIXING_DEPTH]);
};
