/* ranks/company.c: the ranks of a run [cli/crew.h]. The leader tells the others what is next, and all do it. */
#include "cli/crew.h"

#include "cli/options.h"
#include "ranks/stride.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

enum word { LEAVE, BEGIN, OTHER_BODIES, STEP };

static struct {
    struct talk talk;
    struct stride stride;
    bool begun;
} crew;

/* Where a process of the run ends before its time mpirun stops the others by this signal. */
static void stopped(int signal)
{
    static const char text[] =
        "nsd-step: another process of the run has ended, or the run was stopped: "
        "its frames so far are whole, and nsd-step -i goes on from the last\n";
    ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
    (void)written;
    _exit(128 + signal);
}

bool crew_join(void)
{
    int level;
    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &level);
    crew.talk.comm = MPI_COMM_WORLD;
    MPI_Comm_rank(MPI_COMM_WORLD, &crew.talk.me), MPI_Comm_size(MPI_COMM_WORLD, &crew.talk.n);
    if (!crew.talk.me) signal(SIGTERM, stopped);
    return crew.talk.me == 0;
}

bool crew_started(void)
{
    return true;
}

int crew_size(void)
{
    return crew.talk.n;
}

static enum word next(enum word w)
{
    int word = w;
    MPI_Bcast(&word, 1, MPI_INT, 0, crew.talk.comm);
    return (enum word)word;
}

int crew_follow(void)
{
    struct packing none = { 0 };
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct why why = { 0 };
    for (enum word w; (w = next(LEAVE)) != LEAVE;) {
        if (w == BEGIN) stride_begin(&crew.stride, &crew.talk, options.hypergraph, &none);
        if (w == OTHER_BODIES) stride_begin_again(&crew.stride, &none);
        if (w != STEP) continue;
        const struct step_opt o = options_step(crew.stride.part.p.dt, false);
        stride_step(&crew.stride, &none, &s, &o, &rep, &why);
    }
    crew_leave();
    report_free(&rep);
    return 0;
}

int crew_step(struct packing *p, struct contacts *s, struct neighbours *near, bool other_bodies,
              const struct step_opt *o, struct report *rep, struct why *why)
{
    (void)near;
    if (!crew.begun)
        next(BEGIN), stride_begin(&crew.stride, &crew.talk, options.hypergraph, p);
    else if (other_bodies)
        next(OTHER_BODIES), stride_begin_again(&crew.stride, p);
    crew.begun = true;
    next(STEP);
    return stride_step(&crew.stride, p, s, o, rep, why);
}

const char *crew_leave(void)
{
    static char text[500];
    const struct stride *y = &crew.stride;
    if (!crew.talk.me) next(LEAVE);
    double mine[4] = { (double)y->solved[0], (double)y->solved[1], y->busy[0], y->busy[1] },
           most[4] = { 0 };
    MPI_Reduce(mine, most, 4, MPI_DOUBLE, MPI_MAX, 0, crew.talk.comm);
    double sweeps = y->sweeps > 0 ? (double)y->sweeps : 1;
    struct rusage used;
    getrusage(RUSAGE_SELF, &used);
    double kb = (double)used.ru_maxrss, memory[2] = { 0 };
    MPI_Reduce(&kb, &memory[0], 1, MPI_DOUBLE, MPI_MAX, 0, crew.talk.comm);
    MPI_Reduce(&kb, &memory[1], 1, MPI_DOUBLE, MPI_SUM, 0, crew.talk.comm);
    snprintf(
        text, sizeof text,
        "%d ranks: %.3g bytes in %.3g messages a sweep, of the one that sends most; contacts of "
        "the fullest %.3g of the mean on average, %.3g at most, %lld cuts; %lld steps solved by "
        "the first alone; memory %.3g MB, of the largest %.3g MB; "
        "%.3g s without waiting, %.3g s of them in the solver",
        crew.talk.n, most[0] / sweeps, most[1] / sweeps,
        y->steps ? y->uneven / (double)y->steps : 1, y->worst, (long long)y->part.cuts,
        (long long)y->alone, memory[1] / 1024, memory[0] / 1024, most[3], most[2]);
    if (crew.begun || crew.talk.me) stride_free(&crew.stride);
    MPI_Finalize();
    return text;
}
