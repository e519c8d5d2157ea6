/*
 * problem/sweep.h: the inner loops over bundles: local solves, velocities, errors. One text (sweep.c) in
 * three widths; the width changes no bit. It is the widest that the machine has, or that the
 * environment's NSD_LANES allows.
 */
#ifndef NSD_SWEEP_H
#define NSD_SWEEP_H

#include "law/method.h"
#include "problem/problem.h"

struct sweep_opt {
    struct local_opt local;
    double relax; /* omega: r + omega (r_new - r), back onto the cone */
    bool keep;    /* write down what the method believes u to be: only wanted before a judgement */
};

/* Counts of a sweep, lane by lane */
struct tally {
    double change[BUNDLE]; /* m/s: the largest change of a normal velocity */
    double newton[BUNDLE], safeguarded[BUNDLE], gave_up[BUNDLE];
};

/* Sums over contacts, in eight partial sums: lane k of every bundle goes into sum k. */
struct sums {
    double motion[BUNDLE], proj[BUNDLE], bipotential[BUNDLE], penetration[BUNDLE];
    double natural2[BUNDLE], siconos2[BUNDLE], velocity2[BUNDLE], r2[BUNDLE];
    double max_pen[BUNDLE], max_true[BUNDLE];
};

enum err_terms { ERR_TERMS = 1, ERR_NATURAL = 2, ERR_ALL = 3 };

/* Every slot once, group after group: the share of thread `me` of `threads`, all of which must call
   it. Two threads take a half each where there are halves. */
typedef void sweep_text(struct problem *p, int me, int threads, const struct sweep_opt *o,
                        struct tally *t);

/* The loops of one width */
struct sweep {
    int lanes;
    sweep_text *sweep[METHOD_COUNT]; /* one local solve a slot, r into bodies or W at once */
    /* Bundles first .. end-1: what problem/err.h defines, added to the sums */
    void (*judge)(const struct problem *p, int64_t first, int64_t end, bool believes,
                  enum err_terms terms, struct sums *s);
    /* Bundles first .. end-1: u becomes the motion's. */
    void (*velocities)(struct problem *p, int64_t first, int64_t end);
    /* All reactions move the bodies. Shared by threads as a sweep. */
    void (*push)(struct problem *p, int me, int threads);
};

/* The widest that there is, of at most NSD_LANES lanes */
const struct sweep *sweep_widest(void);
/* From now on of at most so many lanes; for the tests. Where there is no such width, the next narrower. */
void sweep_narrow(int lanes);

#endif
