/*
 * solve/walk.h: how the threads of a sweep share its bundles: group after group, each thread a
 * share of every group, or, where there are two halves, a half each [solve/schedule.h].
 * For the files that are compiled once for each vector width.
 */
#pragma once

#include "base/team.h"
#include "solve/exchange.h"
#include "solve/problem.h"

/*
 * How many bundles ahead data are fetched: first into the second-level cache, since the first-level
 * cache waits for a dozen lines at a time at most; then bodies all the way.
 */
enum {
    BUNDLES_AHEAD = 10, /* bundles ahead: a bundle, into the second level */
    BODIES_AHEAD = 6,   /* bundles ahead: its bodies, into the second level */
    BODIES_NEXT = 2     /* bundles ahead: its bodies, into the first level */
};

ALWAYS_INLINE void fetch_bodies(const struct problem *p, const struct bundle *c)
{
    for (int k = 0; k < BUNDLE; k++) {
        __builtin_prefetch(body_at(p->body, c->a[k]), 1);
        __builtin_prefetch(body_at(p->body, c->b[k]), 1);
    }
}

ALWAYS_INLINE void fetch_bodies_to_second_level(const struct problem *p, const struct bundle *c)
{
    for (int k = 0; k < BUNDLE; k++) {
        __builtin_prefetch(body_at(p->body, c->a[k]), 0, 2);
        __builtin_prefetch(body_at(p->body, c->b[k]), 0, 2);
    }
}

ALWAYS_INLINE void fetch_lines(const void *lines, size_t bytes)
{
    for (size_t k = 0; k < bytes; k += 64) __builtin_prefetch((const char *)lines + k, 0, 2);
}

/* Fetches what will be needed soon, while bundle i is worked on. */
ALWAYS_INLINE void fetch_ahead(const struct problem *p, int64_t i)
{
    if (p->bundles < FAR_BUNDLES || i + BUNDLES_AHEAD >= p->bundles) return;
    int64_t ahead = i + BUNDLES_AHEAD;
    fetch_lines(bundle_at(p, ahead), bundle_size(p));
    if (p->kind.full) fetch_lines(&p->block[ahead], sizeof *p->block);
    if (!p->body) return;
    if (p->kind.levers) fetch_lines(&p->lever[ahead], sizeof *p->lever);
    fetch_bodies_to_second_level(p, bundle_at(p, i + BODIES_AHEAD));
    fetch_bodies(p, bundle_at(p, i + BODIES_NEXT));
}

/* b_c of lanes k.. of a problem given by W, from the present r of all others */
ALWAYS_INLINE void blocks_gather(const struct problem *p, int64_t bundle, int k, vd b[3])
{
    const struct bundle *c = bundle_at(p, bundle);
    double sum[3][LANES] = { 0 }, one[4];
    int64_t slot = bundle * BUNDLE + k;
    const int together = p->W->common ? bundle_contacts(p, bundle) : 0;
    for (int i = 0; i < LANES && c->a[k + i] >= 0; i++) {
        delassus_gather(&p->sorted, slot + i, p->sorted.q, p->W->r, one);
        if (p->W->common) delassus_add_common(p->W, c->a[k + i], together, one);
        for (int j = 0; j < p->d; j++) sum[j][i] = one[j];
    }
    for (int j = 0; j < 3; j++) b[j] = vload(sum[j]);
}

/* r of lanes k.. into W->r, where the other contacts will read it */
ALWAYS_INLINE void blocks_scatter(struct problem *p, const struct bundle *c, int k)
{
    for (int i = 0; i < LANES && c->a[k + i] >= 0; i++) {
        const double r[3] = { c->r[0][k + i], c->r[1][k + i], c->r[2][k + i] };
        if (p->W->common) delassus_change_common(p->W, c->a[k + i], r);
        for (int j = 0; j < 3 && j < p->d; j++) p->W->r[p->d * c->a[k + i] + j] = r[j];
    }
}

/* Groups that a thread sweeps without waiting in between */
struct leg {
    int64_t first, end;     /* groups first .. end-1 */
    _Atomic int64_t *after; /* counted up by the other thread: to be waited for before; or NULL */
    _Atomic int64_t *done;  /* counted up by this thread at the end; or NULL */
};

/* The legs of a thread's sweep; returns their number. Unless by halves, all groups are one leg. */
ALWAYS_INLINE int legs_of_thread(const struct problem *p, int me, bool by_halves, struct leg leg[3])
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

/* Waits until the other thread has done with the leg's bodies, then fetches them all together,
   which takes less time than one by one. */
ALWAYS_INLINE void begin_leg(const struct problem *p, const struct leg *leg, int me)
{
    if (!leg->done) return;
    team_await(leg->after, atomic_load_explicit(leg->done, memory_order_relaxed) + me);
    for (int64_t i = p->group[leg->first]; i < p->group[leg->end]; i++)
        fetch_bodies(p, bundle_at(p, i));
}

/* Only this thread writes the count; an atomic addition would wait for all stores before it. */
ALWAYS_INLINE void end_leg(const struct leg *leg)
{
    if (!leg->done) return;
    int64_t n = atomic_load_explicit(leg->done, memory_order_relaxed);
    atomic_store_explicit(leg->done, n + 1, memory_order_release);
}

/* What is to be done with bundles first .. end-1 of one group */
typedef void walk_text(struct problem *p, int64_t first, int64_t end, void *task);

/* Calls each() on the share of every group that thread `me` of `threads` has, or on its half. All
   threads must call it. */
ALWAYS_INLINE void walk(struct problem *p, int me, int threads, walk_text *each, void *task)
{
    struct leg leg[3];
    bool by_halves = p->split && threads == 2;
    int legs = legs_of_thread(p, me, by_halves, leg), share = by_halves ? 1 : threads,
        mine = by_halves ? 0 : me;
    const bool common =
        p->W && p->W->common; // every bundle is a group, and one thread has them all
    if (common) delassus_begin(p->W);
    for (int k = 0; k < legs; k++) {
        begin_leg(p, &leg[k], me);
        for (int64_t g = leg[k].first; g < leg[k].end; g++) {
            int64_t first = p->group[g], n = p->group[g + 1] - first;
            each(p, first + n * mine / share, first + n * (mine + 1) / share, task);
            if (common) delassus_end_group(p->W);
            if (share > 1) team_meet();
            if (!p->exchange) continue;
            if (mine == 0) p->exchange->after_group(p->exchange, p, g);
            if (share > 1) team_meet();
        }
        end_leg(&leg[k]);
    }
}
