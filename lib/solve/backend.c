/* solve/backend.c: the table of backends, and the choice [solve/backend.h]. */
#include "solve/backend.h"

#include <pthread.h>
#include <stdlib.h>

extern const struct sweep sweep_2, sweep_4, sweep_8;
extern const struct judge judge_2, judge_4, judge_8;
extern const struct mixing_loops mixing_2, mixing_4, mixing_8;
extern const struct small_kernels small_2, small_4, small_8;

static const struct backend backends[] = { { 2, &sweep_2, &judge_2, &mixing_2, &small_2 },
                                           { 4, &sweep_4, &judge_4, &mixing_4, &small_4 },
                                           { 8, &sweep_8, &judge_8, &mixing_8, &small_8 } };

static const struct backend *chosen;

/* Whether the machine has vectors of that many doubles */
static bool backend_has(int lanes)
{
#ifdef __x86_64__
    if (lanes == 4) return __builtin_cpu_supports("avx2");
    if (lanes == 8) return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
#endif
    return lanes == 2;
}

void backend_narrow(int lanes)
{
    for (size_t k = 0; k < sizeof backends / sizeof *backends; k++)
        if (!k || (backends[k].lanes <= lanes && backend_has(backends[k].lanes)))
            chosen = &backends[k];
}

static void backend_choose(void)
{
    const char *most = chosen ? NULL : getenv("NSD_LANES");
    if (!chosen) backend_narrow(most ? atoi(most) : BUNDLE);
}

const struct backend *backend_widest(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, backend_choose);
    return chosen;
}
