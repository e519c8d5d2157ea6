/*
 * solve/exchange.h: a contact problem of which several processes have a part each, and what a part
 * asks of the others. Solvers go the same way in all of them: whatever they decide by is a number
 * that is the same everywhere.
 *
 * A process has bodies of its own and copies of others'. A contact that several have is counted by
 * one of them; in the others it lies in bundles of copies.
 */
#pragma once

#include <stdbool.h>
#include <stdint.h>

struct problem;

/* What is added up */
struct summands {
    int64_t chunk; /* bundles of a partial sum */
    int parts, terms;
    const double *term; /* [slots][parts][terms] */
};

struct exchange {
    void *with;                /* of the functions below: how they reach the other processes */
    int64_t contacts, bundles; /* of all processes */
    bool halves;               /* the order of all contacts has halves */
    double mean_mass;          /* kg: of all bodies that move */
    int64_t *copies;           /* [n_copies] pairs first, end of bundles that another counts */
    int64_t n_copies;
    /* [contacts here] steps are shorter by this factor, at least 1 [solve/mass_splitting.h]; NULL: none is */
    const double *slower;
    bool may_want; /* set before the solve: one process could start again with all contacts */
    bool
        wants_whole; /* set by a solver, which then ends: only such a process continues from here */

    /* A walk over the bundles has done with this group. */
    void (*after_group)(struct exchange *s, struct problem *p, int64_t group);
    /* The bodies have their free motion; contacts are about to be pushed, slot after slot. */
    void (*begin)(struct exchange *s, struct problem *p);
    /* They have been: copies of bodies become what the bodies are. */
    void (*settle)(struct exchange *s, struct problem *p);
    /* Before and after the errors are computed */
    void (*judging)(struct exchange *s, struct problem *p, bool begins);
    /*
     * Sums are made in one of two ways: exactly one of sum and add is there, the other is NULL.
     *
     * out[terms][8] = the sums over all contacts, part after part, lane by lane of the bundles of the
     * order of all: the bits of one process that has them all.
     */
    void (*sum)(struct exchange *s, const struct problem *p, const struct summands *of,
                double *out);
    /* The sum of term[slots] along the order of all slots */
    double (*sum_along)(struct exchange *s, const struct problem *p, const double *term);
    /* The largest of all processes' numbers; how many all have counted; what the first one says */
    double (*most)(struct exchange *s, double x);
    int64_t (*count)(struct exchange *s, int64_t n);
    double (*agree)(struct exchange *s, double x);
    /* Memory is short: ends all processes, for the others wait for this one. */
    void (*fail)(struct exchange *s);
    /* x[n] = the sums of all processes' x, in the order of processes: other bits for another number of them */
    void (*add)(struct exchange *s, double *x, int n);
};

/* Are the contacts of this bundle counted by another process? */
static inline bool exchange_is_copy(const struct exchange *s, int64_t bundle)
{
    int64_t lo = 0, hi = s->n_copies;
    while (lo < hi) { // the last range that begins at or before the bundle
        int64_t middle = (lo + hi) / 2;
        if (s->copies[2 * middle] <= bundle)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo > 0 && bundle < s->copies[2 * lo - 1];
}
