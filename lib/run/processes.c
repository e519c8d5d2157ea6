/* run/processes.c: a process alone, or on its way to become one of several [run/processes.h]. */
#include "run/processes.h"

#include "run/cli.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What the starters of MPI programs say to them: Open MPI, and those who speak PMI */
static int ranks_started(void)
{
    const char *said = getenv("OMPI_COMM_WORLD_SIZE");
    if (!said) said = getenv("PMI_SIZE");
    return said ? atoi(said) : 0;
}

bool processes_started(void)
{
    return ranks_started() > 0;
}

/* PATH-mpi of this program's PATH */
static bool processes_beside(char path[PATH_MAX])
{
    static const char end[] = "-mpi";
    ssize_t n = readlink("/proc/self/exe", path, PATH_MAX - sizeof end);
    if (n < 1) return false;
    memcpy(path + n, end, sizeof end);
    return true;
}

bool processes_join(void)
{
    char path[PATH_MAX] = "nsd-step-mpi";
    int ranks = ranks_started();
    if (ranks < 2) return true;
    if (processes_beside(path)) execv(path, cli_arguments());
    const char *reason = errno == ENOENT ? "is missing" : strerror(errno);
    die(EX_UNAVAILABLE,
        "%d processes were started together, and this nsd-step has no MPI: %.300s %s; install it, "
        "or build "
        "nsd where MPI is installed, or use threads of one process: nsd-step -j %d",
        ranks, path, reason, ranks);
}

int processes_size(void)
{
    return 1;
}

int processes_follow(void)
{
    return 0;
}

struct distributed *processes_take_bodies(bool contacts)
{
    (void)contacts;
    return NULL;
}

int processes_step(struct frame *f, struct step_memory *m, struct changes changes,
                   const struct step_opt *o, struct failure *failure)
{
    (void)changes; // the driver has forgotten what is of other bodies
    return step_advance(&f->packing, &f->contacts, m, o, &f->report, failure);
}

const char *processes_leave(void)
{
    return NULL;
}
