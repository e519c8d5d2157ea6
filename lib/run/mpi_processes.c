/* run/mpi_processes.c: the ranks of a run [run/processes.h]. The leader tells the others what is next, and all do it. */
#include "run/processes.h"

#include "mpi/rank_small.h"
#include "mpi/rank_step.h"
#include "mpi/rows.h"
#include "run/options.h"
#include "step/small_step.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

enum mpi_processes_word { LEAVE, BEGIN, BEGIN_ROWS, OTHER_BODIES, ACT, STEP, SMALL, TAKE, FILL };

static struct {
    struct comm comm;
    struct rank_step step;
    struct rank_small small;
    bool moved; /* the first has made small steps since the parts of others have heard of it */
    struct rows rows;
    struct distributed distributed;
    bool begun;
    bool contacts; /* are wanted of steps that are kept */
} self;

/* Where a process of the run ends before its time mpirun stops the others by this signal. */
static void stopped(int signal)
{
    static const char text[] =
        "nsd-step: another process of the run has ended, or the run was stopped: "
        "its frames so far are whole, and nsd-step -i resumes from the last\n";
    ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
    (void)written;
    _exit(128 + signal);
}

bool processes_join(void)
{
    int level;
    // Nobody shares a pointer into a file. For such pointers Open MPI may make files beside it, and a kill leaves them.
    setenv("OMPI_MCA_sharedfp", "^lockedfile", false);
    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &level);
    self.comm.mpi = MPI_COMM_WORLD;
    MPI_Comm_rank(MPI_COMM_WORLD, &self.comm.me), MPI_Comm_size(MPI_COMM_WORLD, &self.comm.n);
    rank_small_begin(&self.small, &self.comm);
    if (!self.comm.me) signal(SIGTERM, stopped);
    return self.comm.me == 0;
}

bool processes_started(void)
{
    return true;
}

int processes_size(void)
{
    return self.comm.n;
}

static enum mpi_processes_word mpi_processes_next(enum mpi_processes_word w)
{
    int word = w;
    MPI_Bcast(&word, 1, MPI_INT, 0, self.comm.mpi);
    return (enum mpi_processes_word)word;
}

static void mpi_processes_begin(enum mpi_processes_word w, const struct packing *p)
{
    struct decomposition *space = decomposition_new(&self.comm);
    rank_step_begin(&self.step, &self.comm, space, p, w == BEGIN_ROWS ? &self.rows : NULL);
    self.begun = true;
}

static int mpi_processes_fill(hid_t file, const char *path, const struct unfilled *place,
                              int places, struct failure *failure)
{
    const struct files_wish wish = { file, path, place, places, getenv("NSD_GATHER") != NULL };
    return files_fill(&self.rows, self.begun ? &self.step.part : NULL, &wish, failure);
}

/* ---- bodies that no process has all of ---- */

static bool wants(struct distributed *e, const struct packing *settings, int64_t n)
{
    const struct step_opt o = options_step(settings->dt, false);
    e->n = n;
    return rank_step_scatters(settings, &o) && !settings->breakage;
}

static int mpi_processes_take(struct distributed *e, const struct packing *block, int64_t first,
                              struct failure *failure)
{
    (void)failure;
    mpi_processes_next(TAKE);
    rows_take(&self.rows, &self.comm, block, first, e->n);
    return 0;
}

static int mpi_processes_give(struct distributed *e, hid_t file, const char *path,
                              const struct unfilled *place, int places, struct failure *failure)
{
    (void)e;
    mpi_processes_next(FILL);
    return mpi_processes_fill(file, path, place, places, failure);
}

struct distributed *processes_take_bodies(bool contacts)
{
    self.contacts = contacts;
    self.distributed = (struct distributed){ .wants = wants,
                                             .take = mpi_processes_take,
                                             .give = mpi_processes_give };
    return &self.distributed;
}

/* ---- steps ---- */

static void mpi_processes_follow_small(void)
{
    const struct step_opt o = options_step(1, false);
    struct failure failure = { 0 };
    bool made;
    int64_t parts;
    rank_small_make(&self.small, NULL, &o, &made, &parts, &failure);
}

int processes_follow(void)
{
    struct packing none = { 0 };
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct failure failure = { 0 };
    for (enum mpi_processes_word w; (w = mpi_processes_next(LEAVE)) != LEAVE;) {
        if (w == BEGIN || w == BEGIN_ROWS) mpi_processes_begin(w, &none);
        if (w == TAKE) rows_take(&self.rows, &self.comm, NULL, 0, 0);
        if (w == FILL)
            mpi_processes_fill(-1, NULL, NULL, 0, &failure); // the leader says what was wrong
        if (w == OTHER_BODIES) rank_step_begin_again(&self.step, &none);
        if (w == ACT) rank_step_act(&self.step, &none);
        if (w == SMALL) mpi_processes_follow_small();
        if (w != STEP) continue;
        const struct step_opt o = options_step(self.step.part.p.dt, false);
        rank_step_make(&self.step, &none, &s, &o, &rep, &failure);
    }
    processes_leave();
    report_free(&rep);
    return 0;
}

/* By all processes; parts: of the step, or 0 */
static int mpi_processes_step(struct frame *f, struct changes changes, int64_t parts,
                              const struct step_opt *o, struct failure *failure)
{
    if (!self.begun)
        mpi_processes_begin(mpi_processes_next(f->distributed ? BEGIN_ROWS : BEGIN), &f->packing);
    else if (changes.bodies || self.moved)
        mpi_processes_next(OTHER_BODIES), rank_step_begin_again(&self.step, &f->packing);
    const bool moved = self.moved;
    self.moved = false;
    if (changes.acts || moved) mpi_processes_next(ACT), rank_step_act(&self.step, &f->packing);
    self.step.contacts = self.contacts, self.step.may_end = options_end_on_failure();
    self.step.parts = parts;
    mpi_processes_next(STEP);
    return rank_step_make(&self.step, &f->packing, &f->contacts, o, &f->report, failure);
}

/* As step_in_small(): by all processes, where they can divide it */
static int mpi_processes_small(struct frame *f, struct step_memory *m, struct changes changes,
                               const struct step_opt *o, bool *made, int64_t *parts,
                               struct failure *failure)
{
    struct packing *p = &f->packing;
    const bool divides = o->small > 0 && self.comm.n > 1 && !small_lacks(p);
    if (changes.bodies || changes.acts) self.small.same = false;
    if (!divides || small_undivided(p, o->bound)) {
        self.small.same = false;
        return step_in_small(p, &f->contacts, m, o, &f->report, made, parts, failure);
    }
    const struct rank_small_step first = { p, &f->contacts, m, &f->report };
    mpi_processes_next(SMALL);
    return rank_small_make(&self.small, &first, o, made, parts, failure);
}

int processes_step(struct frame *f, struct step_memory *m, struct changes changes,
                   const struct step_opt *o, struct failure *failure)
{
    bool made = false;
    int64_t parts = 0;
    if (f->packing.breakage)
        return step_advance(&f->packing, &f->contacts, m, o, &f->report, failure);
    if (!f->distributed && mpi_processes_small(f, m, changes, o, &made, &parts, failure))
        return failure->status;
    self.moved = self.moved || made; // others have not heard of it
    if (made) return 0;
    const int status = mpi_processes_step(f, changes, parts, o, failure);
    step_after_parts(&f->packing, o, parts);
    return status;
}

const char *processes_leave(void)
{
    static char text[700];
    const struct rank_step *y = &self.step;
    if (!self.comm.me) mpi_processes_next(LEAVE);
    const struct rank_small *small = &self.small;
    double mine[7] = { (double)y->solved[0], (double)y->solved[1],    y->busy[0], y->busy[1],
                       (double)small->bytes, (double)small->messages, small->busy },
           most[7] = { 0 };
    MPI_Reduce(mine, most, 7, MPI_DOUBLE, MPI_MAX, 0, self.comm.mpi);
    double sweeps = y->sweeps > 0 ? (double)y->sweeps : 1;
    struct rusage used;
    getrusage(RUSAGE_SELF, &used);
    double kb = (double)used.ru_maxrss, memory[2] = { 0 };
    MPI_Reduce(&kb, &memory[0], 1, MPI_DOUBLE, MPI_MAX, 0, self.comm.mpi);
    MPI_Reduce(&kb, &memory[1], 1, MPI_DOUBLE, MPI_SUM, 0, self.comm.mpi);
    int at = snprintf(text, sizeof text, "%d ranks: ", self.comm.n);
    const double divided = small->steps > 0 ? (double)small->steps : 1;
    if (small->steps)
        at +=
            snprintf(text + at, sizeof text - (size_t)at,
                     "%lld small steps divided, %.3g bytes in %.3g messages per small step, of the "
                     "one that sends most, %.3g s without waiting; ",
                     (long long)small->steps, most[4] / divided, most[5] / divided, most[6]);
    if (y->steps)
        at += snprintf(
            text + at, sizeof text - (size_t)at,
            "%.3g bytes in %.3g messages per sweep, of the one that sends most; contacts of the "
            "fullest %.3g of the mean on average, %.3g at most, %lld cuts; %lld steps solved by "
            "the first alone; %.3g s without waiting, %.3g s of them in the solver; ",
            most[0] / sweeps, most[1] / sweeps, y->uneven / (double)y->steps, y->worst,
            (long long)y->part.cuts, (long long)y->alone, most[3], most[2]);
    snprintf(text + at, sizeof text - (size_t)at, "memory %.3g MB, of the largest %.3g MB",
             memory[1] / 1024, memory[0] / 1024);
    if (self.begun) rank_step_free(&self.step);
    rank_small_free(&self.small);
    rows_free(&self.rows);
    MPI_Finalize();
    return text;
}
