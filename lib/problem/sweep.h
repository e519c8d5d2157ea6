/*
 * problem/sweep.h: the inner loops, over bundles, in three widths of one text (problem/sweep.c). The width changes no
 * bit; it is the widest that the machine has, or that the environment's NSD_LANES allows.
 */
#ifndef NSD_SWEEP_H
#define NSD_SWEEP_H

#include "law/method.h"
#include "problem/mixing.h"
#include "problem/problem.h"

enum { SWEEP_FAR = 1024 }; /* bundles, 1.2 MB: more are not near when a sweep comes back to them */

struct sweep_opt {
    struct local_opt local;
    double relax; /* omega: r + omega (r_new - r), back onto the cone */
    bool keep;    /* what the method believes u to be: wanted where the sweep may be judged */
};

/* Of a sweep, lane by lane */
struct tally {
    double change[BUNDLE]; /* m/s: the largest change of a normal velocity */
    double newton[BUNDLE], safeguarded[BUNDLE], gave_up[BUNDLE];
};

/* Sums over contacts, in eight slots: lane k of every bundle goes into slot k. */
struct sums {
    double motion[BUNDLE], proj[BUNDLE], bipotential[BUNDLE], penetration[BUNDLE];
    double natural2[BUNDLE], siconos2[BUNDLE], velocity2[BUNDLE], r2[BUNDLE];
    double max_pen[BUNDLE], max_true[BUNDLE];
};

enum err_terms { ERR_TERMS = 1, ERR_NATURAL = 2, ERR_ALL = 3 };

/* Every row once, group after group: the part of thread `me` of so many, all of which must call it.
   Two threads take a half each where there are halves. */
typedef void sweep_text(struct problem *, int me, int threads, const struct sweep_opt *,
                        struct tally *);

struct sweep {
    int lanes;
    sweep_text *sweep[METHOD_COUNT]; /* one local solve a row, r into bodies or W at once */
    /* bundles first .. end-1: what problem/err.h defines, added to the sums */
    void (*judge)(const struct problem *, int64_t first, int64_t end, bool believes, enum err_terms,
                  struct sums *);
    /* u = the motion's */
    void (*velocities)(struct problem *, int64_t first, int64_t end);
    /* f, and how g and f differ from the last, into the next slot; adds f.f, and df[slot] and f
       times df[], to the sums */
    void (*mixing_measure)(const struct problem *, const struct mixing *, int64_t first,
                           int64_t end, struct mixing_sums *);
    /* r = x = g + leap f - sum_j gamma_j dg_j, back to what friction allows; bodies move accordingly.
       Shared by threads as a sweep. */
    void (*mixing_react)(struct problem *, int me, int threads, const struct mixing *, double leap,
                         const double gamma[MIXING_DEPTH]);
};

/* The widest that there is, of at most NSD_LANES lanes. */
const struct sweep *sweep_widest(void);
/* From now on of at most so many; for the tests. Where there is no such width, the next narrower. */
void sweep_narrow(int lanes);

#endif
