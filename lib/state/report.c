/* state/report.c: names, clocks [state/report.h]. */
#include "state/report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

const char *const criterion_name[] = { "glob", "scaled", "natural", "velocity" };

static const char *const endless_name[] = {
    [ENDLESS_POSITION] = "the position of body",
    [ENDLESS_VELOCITY] = "the velocity of body",
    [ENDLESS_SPIN] = "the angular velocity of body",
    [ENDLESS_ENERGY] = "the energy of body",
    [ENDLESS_WALL] = "the position or velocity of wall",
    [ENDLESS_CELL] = "the size or rate of the periodic cell",
    [ENDLESS_REPORT] = "an error or a balance of the step",
};

bool report_made(const struct report *r)
{
    return isfinite(r->err.paper.eps_glob) && !r->endless.what;
}

void report_says_end(const struct report *r, char *text, size_t room)
{
    char whose[20] = "";
    const struct endless *e = &r->endless;
    if (e->what && e->what <= ENDLESS_WALL)
        snprintf(whose, sizeof whose, " %d", e->id < 0 ? -1 - e->id : e->id);
    snprintf(text, room, "step %lld: %s%s%s", (long long)r->step,
             e->what ? endless_name[e->what] : "the solve diverged", whose,
             e->what ? " would not be finite" : "");
}

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
