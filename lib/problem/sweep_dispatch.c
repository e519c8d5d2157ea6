/*
 * problem/sweep_dispatch.c: chooses the inner loops of problem/sweep.h, problem/judge.h and problem/mixing.h
 * for the widest vectors that the machine has. A file compiled once for each width has its table here.
 */
#include "problem/judge.h"
#include "problem/mixing.h"
#include "problem/sweep.h"

#include <pthread.h>
#include <stdlib.h>

extern const struct sweep sweep_2, sweep_4, sweep_8;
extern const struct judge judge_2, judge_4, judge_8;
extern const struct mixing_loops mixing_2, mixing_4, mixing_8;

static struct {
    const struct sweep *sweep;
    const struct judge *judge;
    const struct mixing_loops *mixing;
} widest;

void sweep_narrow(int lanes)
{
    widest.sweep = &sweep_2, widest.judge = &judge_2, widest.mixing = &mixing_2;
#ifdef __x86_64__
    if (lanes >= 4 && __builtin_cpu_supports("avx2"))
        widest.sweep = &sweep_4, widest.judge = &judge_4, widest.mixing = &mixing_4;
    if (lanes >= 8 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
        widest.sweep = &sweep_8, widest.judge = &judge_8, widest.mixing = &mixing_8;
#endif
}

static void choose_first(void)
{
    const char *most = widest.sweep ? NULL : getenv("NSD_LANES");
    if (!widest.sweep) sweep_narrow(most ? atoi(most) : BUNDLE);
}

static void choose(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, choose_first);
}

const struct sweep *sweep_widest(void)
{
    choose();
    return widest.sweep;
}

const struct judge *judge_widest(void)
{
    choose();
    return widest.judge;
}

const struct mixing_loops *mixing_widest(void)
{
    choose();
    return widest.mixing;
}
