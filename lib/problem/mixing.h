/*
 * problem/mixing.h: the inner loops of Anderson's acceleration (solve/anderson.c), one text for every width.
 *
 * A vector is [bundles][d][8]: the components of the reactions as the rows have them, N s. Where
 * reactions of different contacts meet in a sum they are weighed by lambda_max(W~_cc), so that a sum
 * of squares is an energy whatever the masses.
 *
 * With f = g - x, x where the sweeps began and g where they ended, dg[] and df[] are what g and f were
 * more than the time before. While the sweeps run, the oldest of them, which the next will replace, is
 * not wanted any more: its room keeps g of the time before (in dg) and x (in df).
 */
#ifndef NSD_MIXING_H
#define NSD_MIXING_H

#include "problem/problem.h"

enum { MIXING_DEPTH = 5, MIXING_DEPTH_MANY = 2 }; /* differences; where contacts are many, few */

struct mixing {
    bool few; /* MIXING_DEPTH_MANY of them */
    int slot; /* where the next difference comes */
    double *f, *dg[MIXING_DEPTH], *df[MIXING_DEPTH];
};

/* In eight slots each, lane k of every bundle in slot k */
struct mixing_sums {
    double f2[BUNDLE], ff[MIXING_DEPTH][BUNDLE], fd[MIXING_DEPTH][BUNDLE];
};

static inline void mixing_sums_add(struct mixing_sums *t, const struct mixing_sums *s)
{
    for (int k = 0; k < BUNDLE; k++) t->f2[k] += s->f2[k];
    for (int j = 0; j < MIXING_DEPTH; j++)
        for (int k = 0; k < BUNDLE; k++) t->ff[j][k] += s->ff[j][k], t->fd[j][k] += s->fd[j][k];
}

/* a.b of LANES contacts, weighed, into s */
ALWAYS_INLINE void mixing_add(vd *s, vd a, const double *b)
{
    *s += a * vload(b);
}

/* Bundles first .. end-1: f, dg[slot], df[slot]; adds f.f, df[slot].df[], f.df[] to the sums. m, d and
   memory come by value, so that what is stored cannot change them. */
ALWAYS_INLINE void mixing_measure_text(const struct problem *p, const struct mixing m, int d,
                                       int memory, int64_t first, int64_t end,
                                       struct mixing_sums *t)
{
    double *dg = m.dg[m.slot], *df = m.df[m.slot];
    for (int k = 0; k < BUNDLE; k += LANES) {
        vd f2 = vload(t->f2 + k), ff[MIXING_DEPTH], fd[MIXING_DEPTH];
        for (int j = 0; j < memory; j++) ff[j] = vload(t->ff[j] + k), fd[j] = vload(t->fd[j] + k);
        for (int64_t i = first; i < end; i++) {
            const struct bundle *c = &p->bundle[i];
            vd lambda = bundle_lambda(c, k);
            for (int l = 0; l < d; l++) {
                int64_t at = (i * d + l) * BUNDLE + k;
                vd g = vload(c->r[l] + k), f = g - vload(df + at), change = f - vload(m.f + at);
                vstore(dg + at, g - vload(dg + at)), vstore(df + at, change);
                vstore(m.f + at, f);
                vd wf = lambda * f, wdf = lambda * change;
                f2 += wf * f;
                for (int j = 0; j < memory; j++)
                    mixing_add(&ff[j], wdf, m.df[j] + at), mixing_add(&fd[j], wf, m.df[j] + at);
            }
        }
        vstore(t->f2 + k, f2);
        for (int j = 0; j < memory; j++) vstore(t->ff[j] + k, ff[j]), vstore(t->fd[j] + k, fd[j]);
    }
}

/* x = g + leap f - sum_j gamma_j dg_j of lanes k.. of bundle i, whose r is g: d components of it */
ALWAYS_INLINE void mixing_point(const struct mixing *m, const struct bundle *c, int d, int memory,
                                double leap, const double gamma[MIXING_DEPTH], int64_t i, int k,
                                vd x[3])
{
    for (int l = 0; l < d; l++) {
        int64_t at = (i * d + l) * BUNDLE + k;
        x[l] = vload(c->r[l] + k) + leap * vload(m->f + at);
        for (int j = 0; j < memory; j++) x[l] -= gamma[j] * vload(m->dg[j] + at);
    }
}

#endif
