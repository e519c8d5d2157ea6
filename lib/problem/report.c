/* problem/report.c: names, clocks [problem/report.h]. */
#include "problem/report.h"

#include <stdlib.h>
#include <time.h>

const char *const criterion_name[] = { "glob", "scaled", "natural", "velocity" };

double report_seconds(enum report_clock clock)
{
    struct timespec t;
    clock_gettime(clock == CLOCK_CPU ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void report_free(struct report *r)
{
    free(r->options), free(r->history);
    *r = (struct report){ 0 };
}
