/* base/limits.c: limits of the system [base/limits.h]. */
#include "base/limits.h"

#include <signal.h>
#include <stdio.h>
#include <sys/resource.h>
#include <unistd.h>

enum { SLOWER = SANITIZED ? 10 : 1 };

/* Bytes of addresses that the process has */
static rlim_t address_space(void)
{
    unsigned long long pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (!f || fscanf(f, "%llu", &pages) != 1) pages = 0;
    if (f) fclose(f);
    return (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE);
}

static void set_limit(int which, rlim_t most)
{
    struct rlimit r;
    if (getrlimit(which, &r)) return;
    r.rlim_cur = most < r.rlim_max ? most : r.rlim_max;
    setrlimit(which, &r);
}

void limits_memory(uint64_t bytes)
{
    if (!SANITIZED) set_limit(RLIMIT_AS, address_space() + (rlim_t)bytes);
}

void limits_processor(uint64_t seconds)
{
    struct rusage used;
    if (getrusage(RUSAGE_SELF, &used)) return;
    rlim_t now = (rlim_t)(used.ru_utime.tv_sec + used.ru_stime.tv_sec);
    set_limit(RLIMIT_CPU, now + SLOWER * (rlim_t)seconds);
}

double limits_room(void)
{
    struct rlimit r;
    double room = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (!SANITIZED && !getrlimit(RLIMIT_AS, &r) && r.rlim_cur != RLIM_INFINITY &&
        (double)r.rlim_cur < room)
        room = (double)r.rlim_cur;
    return room;
}

void limits_lift(void)
{
    set_limit(RLIMIT_AS, RLIM_INFINITY), set_limit(RLIMIT_CPU, RLIM_INFINITY);
}

void limits_no_core(void)
{
    set_limit(RLIMIT_CORE, 0);
}

int limits_reason(int signal, const char *name, struct failure *failure)
{
    if (signal == SIGXCPU)
        return failure_set(failure, EX_DATAERR, "%.250s: takes too long to read: damaged, or made to",
                       name);
    if (signal == SIGKILL)
        return failure_set(failure, EX_SOFTWARE, "%.250s: reading it was killed (no memory?)", name);
    return 0;
}
