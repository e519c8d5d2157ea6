/* problem/sweep_dispatch.c: which of the sweep's widths; see problem/sweep.h. */
#include "problem/sweep.h"

#include <stdlib.h>

extern const struct sweep sweep_2, sweep_4, sweep_8;

static const struct sweep *widest;

void sweep_narrow(int lanes)
{
    widest = &sweep_2;
#ifdef __x86_64__
    if (lanes >= 4 && __builtin_cpu_supports("avx2")) widest = &sweep_4;
    if (lanes >= 8 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
        widest = &sweep_8;
#endif
}

const struct sweep *sweep_widest(void)
{
    const char *most = widest ? NULL : getenv("NSD_LANES");
    if (!widest) sweep_narrow(most ? atoi(most) : BUNDLE);
    return widest;
}
