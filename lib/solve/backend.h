/*
 * solve/backend.h: the backends, a table: kernels that solve, push, judge and mix the bundles of a problem. Each is
 * sweep.c, judge.c and mixing.c compiled for one vector width; the width changes no bit of a result.
 *
 * Another backend is a row of the table in backend.c, and the three structs of kernels that the row names. One that
 * has a memory of its own is a row of the table of devices [solve/device.h].
 */
#pragma once

#include "solve/judge.h"
#include "solve/mixing.h"
#include "solve/small.h"
#include "solve/sweep.h"

struct backend {
    int lanes; /* contacts that a kernel works on at once */
    const struct sweep *sweep;
    const struct judge *judge;
    const struct mixing_loops *mixing;
    const struct small_kernels *small;
};

/* The backend with the widest vectors that the machine has, of at most NSD_LANES lanes (environment) */
const struct backend *backend_widest(void);
/* From now on at most this many lanes, or the next smaller number that there is; for the tests */
void backend_narrow(int lanes);
