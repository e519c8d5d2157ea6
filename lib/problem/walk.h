/*
 * problem/walk.h: how the threads of a sweep share its bundles: group after group, each thread its part of
 * every group, or, where there are two halves, a half each (problem/two_thread_split.h). For the files
 * that are compiled once a width.
 */
#ifndef NSD_WALK_H
#define NSD_WALK_H

#include "problem/problem.h"

/*
 * How many bundles ahead rows and bodies are sent for: as far as the second-level cache, for the first
 * waits for a dozen lines at a time at most; then the bodies all the way.
 */
enum { ROWS_AHEAD = 10, BODIES_AHEAD = 6, BODIES_NEXT = 2 };

ALWAYS_INLINE void fetch_bodies(const struct problem *p, const struct bundle *c)
{
    for (int k = 0; k < BUNDLE; k++) {
        __builtin_prefetch(body_at(p->body, c->a[k]), 1);
        __builtin_prefetch(body_at(p->body, c->b[k]), 1);
    }
}

ALWAYS_INLINE void bring_bodies_nearer(const struct problem *p, const struct bundle *c)
{
    for (int k = 0; k < BUNDLE; k++) {
        __builtin_prefetch(body_at(p->body, c->a[k]), 0, 2);
        __builtin_prefetch(body_at(p->body, c->b[k]), 0, 2);
    }
}

/* What will be wanted while bundle i is at work */
ALWAYS_INLINE void fetch(const struct problem *p, int64_t i)
{
    if (p->bundles < FAR_BUNDLES || i + ROWS_AHEAD >= p->bundles) return;
    const char *rows = (const char *)&p->bundle[i + ROWS_AHEAD];
    for (size_t k = 0; k < sizeof *p->bundle; k += 64) __builtin_prefetch(rows + k, 0, 2);
    if (!p->body) return;
    bring_bodies_nearer(p, &p->bundle[i + BODIES_AHEAD]);
    fetch_bodies(p, &p->bundle[i + BODIES_NEXT]);
}

/* b_c of lanes k.. of a problem that is given by W: from everybody's r as it is now */
ALWAYS_INLINE void blocks_gather(const struct problem *p, const struct bundle *c, int k, vd b[3])
{
    double sum[3][LANES] = { 0 }, one[4];
    int64_t row = (c - p->bundle) * BUNDLE + k;
    for (int i = 0; i < LANES && c->a[k + i] >= 0; i++) {
        delassus_gather(&p->sorted, row + i, p->sorted.q, p->W->r, one);
        for (int j = 0; j < p->d; j++) sum[j][i] = one[j];
    }
    for (int j = 0; j < 3; j++) b[j] = vload(sum[j]);
}

ALWAYS_INLINE void blocks_scatter(struct problem *p, const struct bundle *c, int k)
{
    for (int i = 0; i < LANES; i++)
        for (int j = 0; j < p->d && c->a[k + i] >= 0; j++)
            p->W->r[p->d * c->a[k + i] + j] = c->r[j][k + i];
}

ALWAYS_INLINE const struct rebound *bundle_rebound(const struct problem *p, const struct bundle *c)
{
    return p->rebound ? p->rebound + (c - p->bundle) : NULL;
}

/* Groups that a thread sweeps: `after` a number that another counts up, counting itself when `done` */
struct leg {
    int64_t first, end;
    _Atomic int64_t *after, *done;
};

/* One thread's legs of a sweep; returns their number. All groups are one leg, but by halves. */
ALWAYS_INLINE int route(const struct problem *p, int me, bool by_halves, struct leg leg[3])
{
    struct two_thread_split *h = p->split;
    if (!by_halves) {
        leg[0] = (struct leg){ 0, p->groups, NULL, NULL };
        return 1;
    }
    if (me == 0) {
        leg[0] = (struct leg){ 0, h->beyond, &h->rims, &h->borders };
        leg[1] = (struct leg){ h->beyond, h->inside, NULL, NULL };
        return 2;
    }
    leg[0] = (struct leg){ h->inside, h->rim, NULL, NULL };
    leg[1] = (struct leg){ h->rim, h->rest, &h->borders, &h->rims };
    leg[2] = (struct leg){ h->rest, p->groups, NULL, NULL };
    return 3;
}

/* Waits until the leg's bodies are ours, and asks for all at once: that takes less than one by one. */
ALWAYS_INLINE void set_out(const struct problem *p, const struct leg *leg, int me)
{
    if (!leg->done) return;
    two_thread_split_wait(leg->after, atomic_load_explicit(leg->done, memory_order_relaxed) + me);
    for (int64_t i = p->group[leg->first]; i < p->group[leg->end]; i++)
        fetch_bodies(p, &p->bundle[i]);
}

/* The count is this thread's alone: no need for an addition that waits for what was stored before. */
ALWAYS_INLINE void arrive(const struct leg *leg)
{
    if (!leg->done) return;
    int64_t n = atomic_load_explicit(leg->done, memory_order_relaxed);
    atomic_store_explicit(leg->done, n + 1, memory_order_release);
}

/* What is done with bundles first .. end-1 of one group, of task's kind */
typedef void walk_text(struct problem *p, int64_t first, int64_t end, void *task);

/*
 * The part of thread `me` of all groups, or its half: each() on every stretch of bundles. All threads
 * must call it.
 */
ALWAYS_INLINE void walk(struct problem *p, int me, int threads, walk_text *each, void *task)
{
    struct leg leg[3];
    bool by_halves = p->split && threads == 2;
    int legs = route(p, me, by_halves, leg), share = by_halves ? 1 : threads,
        mine = by_halves ? 0 : me;
    for (int k = 0; k < legs; k++) {
        set_out(p, &leg[k], me);
        for (int64_t g = leg[k].first; g < leg[k].end; g++) {
            int64_t first = p->group[g], n = p->group[g + 1] - first;
            each(p, first + n * mine / share, first + n * (mine + 1) / share, task);
            if (share == 1) continue;
#pragma omp barrier
        }
        arrive(&leg[k]);
    }
}

#endif
