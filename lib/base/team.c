#include "base/team.h"

#include <pthread.h>
#include <sched.h>
#include <stdbool.h>
#include <stddef.h>
#include <time.h>

enum {
    THREADS_MOST = 1024,
    SPINS = 1000,          /* looks of one who waits: some 20 us */
    YIELDS = 500,          /* times that it then offers its core to others before it sleeps, */
    LOOKS = 50,            /* with so many looks in between: some 500 us */
    NAP = 20000,           /* ns that it then sleeps between looks, where nobody wakes it */
    WATCH = 3000000,       /* ns of works after which they are judged, */
    WATCH_ALL = 50000,     /* all works that take as many ns, */
    WATCH_EVERY = 8,       /* and one in so many shorter ones */
    ALONE = 20000000,      /* ns that the caller works alone after a bad judgement; twice as long */
    ALONE_MOST = 640000000 /* after each further one, at most this */
};
/* Cores that works have had, at least, to be worth a team: alone there would be 1. With NSD_STEADY any
   team is, so that ThreadSanitizer's findings do not depend on what else the machine has to do. */
#ifdef NSD_STEADY
#define GAIN 0.0
#else
#define GAIN 1.2
#endif

/* A count, and threads that wait for it. */
struct gate {
    _Atomic int64_t count;
    _Atomic int sleepers;
    pthread_mutex_t lock;
    pthread_cond_t changed;
};
#define GATE                                                                                       \
    {                                                                                              \
        0, 0, PTHREAD_MUTEX_INITIALIZER, PTHREAD_COND_INITIALIZER                                  \
    }

static struct {
    int workers;                /* threads that there are besides the caller's */
    bool no_more;               /* more cannot be had */
    int64_t born[THREADS_MOST]; /* works that had begun before worker k was there */
    int threads;                /* of the work in hand; 0: none */
    team_work *work;
    void *arg;
    bool watched;             /* the work in hand is */
    _Atomic int64_t cpu;      /* ns of the processor's cores that watched works took */
    struct gate begun, ended; /* works; workers that have ended theirs, of all works */
    struct gate met;          /* meetings */
    _Atomic int here;         /* threads that have come to the next */
} team = { .begun = GATE, .ended = GATE, .met = GATE };

/* The process has one team. Of two threads that call for it, the one that comes second works alone. */
static atomic_flag busy = ATOMIC_FLAG_INIT;
static _Thread_local int size;     /* threads of works that are not told how many; 0: 1 */
static _Thread_local int together; /* threads of the work in which this one takes part */

/* Whether a team is worth it: of works that were watched */
static struct {
    int64_t works;       /* since the beginning */
    int64_t last;        /* ns that the last one took */
    int64_t together;    /* ns that they took */
    int64_t alone_until; /* ns on the wall's clock */
    int64_t alone;       /* ns: how long, next time */
} judgement = { .alone = ALONE };

static int64_t clock_now(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

void team_set_size(int threads)
{
    size = threads;
}

int team_size(void)
{
    return size > 1 ? size : 1;
}

/* ---- waiting ---- */

static void rest(void)
{
#if defined __x86_64__ || defined __i386__
    __builtin_ia32_pause();
#endif
}

/* Looks so many times whether the count is there. */
static bool spun(const _Atomic int64_t *count, int64_t n, int looks)
{
    for (int k = 0; k < looks; k++) {
        if (atomic_load_explicit(count, memory_order_acquire) >= n) return true;
        rest();
    }
    return false;
}

/* The same, for some time; false where it takes longer. */
static bool came(const _Atomic int64_t *count, int64_t n)
{
    bool here = spun(count, n, SPINS);
    for (int k = 0; k < YIELDS && !here; k++) sched_yield(), here = spun(count, n, LOOKS);
    return here;
}

static void gate_wait(struct gate *g, int64_t n)
{
    if (came(&g->count, n)) return;
    pthread_mutex_lock(&g->lock);
    atomic_fetch_add(&g->sleepers, 1); // seen by who counts up next, or its count is seen here
    while (atomic_load(&g->count) < n) pthread_cond_wait(&g->changed, &g->lock);
    atomic_fetch_sub(&g->sleepers, 1);
    pthread_mutex_unlock(&g->lock);
}

static void gate_count(struct gate *g)
{
    atomic_fetch_add(&g->count, 1);
    if (!atomic_load(&g->sleepers)) return;
    pthread_mutex_lock(&g->lock);
    pthread_cond_broadcast(&g->changed);
    pthread_mutex_unlock(&g->lock);
}

void team_await(const _Atomic int64_t *count, int64_t n)
{
    const struct timespec nap = { 0, NAP };
    while (!came(count, n)) nanosleep(&nap, NULL);
}

void team_meet(void)
{
    if (together < 2) return;
    int64_t next = atomic_load(&team.met.count) + 1;
    if (atomic_fetch_add(&team.here, 1) + 1 < team.threads) {
        gate_wait(&team.met, next);
        return;
    }
    atomic_store(&team.here, 0);
    gate_count(&team.met);
}

/* ---- workers ---- */

/*
 * One thread's part of the work in hand. Each asks for its own time: the process's would lack what its other
 * threads have run since the kernel's last tick, 4 ms at 250 a second.
 */
static void do_work(int me)
{
    int64_t before = team.watched ? clock_now(CLOCK_THREAD_CPUTIME_ID) : 0;
    together = team.threads;
    team.work(team.arg, me, team.threads);
    together = 0;
    if (team.watched) atomic_fetch_add(&team.cpu, clock_now(CLOCK_THREAD_CPUTIME_ID) - before);
}

static void *worker(void *arg)
{
    int me = (int)(ptrdiff_t)arg;
    for (int64_t works = team.born[me] + 1;; works++) {
        gate_wait(&team.begun, works);
        if (me < team.threads) do_work(me);
        gate_count(&team.ended);
    }
    return NULL;
}

/* In the new process of a program that forks there is no worker. */
static void forget_workers(void)
{
    const struct gate gate = GATE;
    team.workers = 0, team.no_more = false, team.threads = 0;
    team.begun = team.ended = team.met = gate;
    atomic_store(&team.here, 0);
    atomic_flag_clear(&busy);
}

static void team_watch_forks(void)
{
    pthread_atfork(NULL, NULL, forget_workers);
}

/* The number of threads that there are: `threads` if they can be had */
static int team_gather(int threads)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, team_watch_forks);
    if (threads > THREADS_MOST) threads = THREADS_MOST;
    while (!team.no_more && team.workers + 1 < threads) {
        pthread_t t;
        int me = team.workers + 1;
        team.born[me] = atomic_load(&team.begun.count);
        team.no_more = pthread_create(&t, NULL, worker, (void *)(ptrdiff_t)me) != 0;
        if (!team.no_more) pthread_detach(t), team.workers++;
    }
    return team.workers + 1 < threads ? team.workers + 1 : threads;
}

/* Whether the work that begins is watched: asking for the time of each thread costs half a microsecond. */
static bool watch(void)
{
    return judgement.last > WATCH_ALL || judgement.works++ % WATCH_EVERY == 0;
}

/* A work has taken `wall` ns. How many cores have works had? */
static void team_judge(int64_t now, int64_t wall)
{
    judgement.last = wall;
    if (!team.watched) return;
    judgement.together += wall;
    if (judgement.together < WATCH) return;
    if ((double)atomic_load(&team.cpu) < GAIN * (double)judgement.together) {
        judgement.alone_until = now + judgement.alone;
        judgement.alone = judgement.alone < ALONE_MOST ? 2 * judgement.alone : ALONE_MOST;
    } else {
        judgement.alone = judgement.alone / 2 > ALONE ? judgement.alone / 2 : ALONE;
    }
    judgement.together = 0;
    atomic_store(&team.cpu, 0);
}

void team_do(int threads, team_work *work, void *arg)
{
    int64_t since = threads > 1 ? clock_now(CLOCK_MONOTONIC) : 0;
    bool mine = threads > 1 && !atomic_flag_test_and_set(&busy);
    threads = mine && since >= judgement.alone_until ? team_gather(threads) : 1;
    if (threads < 2) {
        if (mine) atomic_flag_clear(&busy);
        work(arg, 0, 1);
        return;
    }
    int64_t all = atomic_load(&team.ended.count) + team.workers, now;
    team.threads = threads, team.work = work, team.arg = arg, team.watched = watch();
    gate_count(&team.begun);
    do_work(0);
    gate_wait(&team.ended, all);
    team.threads = 0;
    now = clock_now(CLOCK_MONOTONIC);
    team_judge(now, now - since);
    atomic_flag_clear(&busy);
}

/* ---- loops ---- */

struct share {
    int64_t n, least;
    team_part *some;
    void *arg;
    _Atomic int64_t next;
};

/* Parts are taken one after another: some are more work than others. */
static void take_parts(void *arg, int me, int threads)
{
    struct share *s = arg;
    (void)me, (void)threads;
    for (;;) {
        int64_t first = atomic_fetch_add_explicit(&s->next, s->least, memory_order_relaxed);
        if (first >= s->n) return;
        s->some(s->arg, first, s->n - first < s->least ? s->n : first + s->least);
    }
}

void team_share(int threads, int64_t n, int64_t least, team_part *some, void *arg)
{
    if (threads < 2 || n <= least) {
        if (n > 0) some(arg, 0, n);
        return;
    }
    int64_t parts =
        8 * (int64_t)threads; // of such a size that the last thread ends soon after the first
    if (n / parts > least) least = n / parts;
    struct share s = { n, least, some, arg, 0 };
    team_do(threads, take_parts, &s);
}

struct most {
    team_look *some;
    void *arg;
    pthread_mutex_t lock;
    double most;
};

static void team_look_range(void *arg, int64_t first, int64_t end)
{
    struct most *m = arg;
    double most = m->some(m->arg, first, end);
    pthread_mutex_lock(&m->lock);
    m->most = most > m->most ? most : m->most;
    pthread_mutex_unlock(&m->lock);
}

double team_most(int threads, int64_t n, int64_t least, team_look *some, void *arg)
{
    struct most m = { some, arg, PTHREAD_MUTEX_INITIALIZER, 0 };
    team_share(threads, n, least, team_look_range, &m);
    return m.most;
}
