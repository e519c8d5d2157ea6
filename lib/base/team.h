/*
 * base/team.h: threads that share the work of a process. Results never depend on their number, so that a team
 * may have fewer threads than asked: where none can be had or, for a while, where one waits long for another,
 * because other programs want the processor's cores. A process has one team: a thread that finds it working works
 * alone.
 *
 * Who waits spins at first, for some tens of microseconds; then it spins on but offers its core to others all the
 * time, for half a millisecond, since between two works of a step less time passes, and to wake a thread of a
 * virtual machine takes a tenth of that; then it sleeps.
 */
#pragma once

#include <stdatomic.h>
#include <stdint.h>

/* What one of the threads does; me = 0 is the caller's. */
typedef void team_work(void *arg, int me, int threads);

/* Has work(arg, me, n) done by n threads at once, 1 <= n <= threads, and returns when all are done. Not to be
   called by what they do. */
void team_do(int threads, team_work *work, void *arg);

/* Nobody in team_do continues before all have arrived. All must call it. */
void team_meet(void);

/*
 * Has some(arg, first, end) called for parts of 0 .. n-1 of at least `least` each, which together are all of it;
 * in one thread, all at once, where there is not more than that.
 */
typedef void team_part(void *arg, int64_t first, int64_t end);
void team_share(int threads, int64_t n, int64_t least, team_part *some, void *arg);

/* The largest number that `some` finds in such parts, at least 0 */
typedef double team_look(void *arg, int64_t first, int64_t end);
double team_most(int threads, int64_t n, int64_t least, team_look *some, void *arg);

/* Threads for whatever the calling thread does and is not told how many it may have: 1, unless the caller says otherwise;
   and how many */
void team_set_size(int threads);
int team_size(void);

/* Waits until *count is at least n; whoever counts up need not know that somebody waits. */
void team_await(const _Atomic int64_t *count, int64_t n);
