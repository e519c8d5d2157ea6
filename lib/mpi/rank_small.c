/* mpi/rank_small.c: messages of small steps over MPI, and copies of the packing [mpi/rank_small.h]. */
#include "mpi/rank_small.h"

#include "mpi/settings.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

enum { TAG = 9, BLOCK = 64 /* bytes that MPI counts as one */ };

/* ---- what small steps ask [step/small_part.h] ---- */

static void most_of_ranks(struct small_ranks *ranks, double *x, int n)
{
    struct comm *t = ((struct rank_small *)ranks)->comm;
    const double since = comm_busy();
    MPI_Allreduce(MPI_IN_PLACE, x, n, MPI_DOUBLE, MPI_MAX, t->mpi);
    comm_waited(t, since);
}

static int64_t sum_of_ranks(struct small_ranks *ranks, int64_t x)
{
    return comm_sum(((struct rank_small *)ranks)->comm, x);
}

// NOLINTBEGIN(clang-analyzer-optin.mpi.MPI-Checker): a later call waits for the request of this one
static void send_to_rank(struct small_ranks *ranks, int rank, const void *bytes, size_t size)
{
    struct rank_small *y = (struct rank_small *)ranks;
    const int k = y->next;
    y->next = (k + 1) % RANK_SMALL_FLIES;
    const double since = comm_busy();
    MPI_Wait(&y->flies[k].request, MPI_STATUS_IGNORE);
    comm_waited(y->comm, since);
    if (size > INT_MAX) comm_fail(y->comm, EX_SOFTWARE, "a message of a small step is too long");
    if (size > y->flies[k].room) {
        free(y->flies[k].bytes);
        y->flies[k].bytes = comm_new(y->comm, (int64_t)size, 1), y->flies[k].room = size;
    }
    memcpy(y->flies[k].bytes, bytes, size);
    MPI_Isend(y->flies[k].bytes, (int)size, MPI_BYTE, rank, TAG, y->comm->mpi,
              &y->flies[k].request);
    y->comm->bytes += (int64_t)size, y->comm->messages++;
}
// NOLINTEND(clang-analyzer-optin.mpi.MPI-Checker)

static void receive_from_rank(struct small_ranks *ranks, int rank, void *bytes, size_t size)
{
    struct comm *t = ((struct rank_small *)ranks)->comm;
    const double since = comm_busy();
    MPI_Recv(bytes, (int)size, MPI_BYTE, rank, TAG, t->mpi, MPI_STATUS_IGNORE);
    comm_waited(t, since);
}

static char *gather_ranks(struct small_ranks *ranks, const void *bytes, size_t size,
                          struct gathered *at)
{
    struct comm *t = ((struct rank_small *)ranks)->comm;
    int *blocks = comm_new(t, t->n, sizeof *blocks), *first = comm_new(t, t->n, sizeof *first);
    uint64_t *sizes = comm_new(t, t->n, sizeof *sizes);
    const double since = comm_busy();
    MPI_Datatype block;
    size_t end = 0;
    sizes[t->me] = size;
    MPI_Allgather(MPI_IN_PLACE, 1, MPI_UINT64_T, sizes, 1, MPI_UINT64_T, t->mpi);
    for (int q = 0; q < t->n; q++) {
        at[q] = (struct gathered){ end, sizes[q] };
        first[q] = (int)(end / BLOCK), blocks[q] = (int)((sizes[q] + BLOCK - 1) / BLOCK);
        end += BLOCK * ((sizes[q] + BLOCK - 1) / BLOCK);
        if (end / BLOCK > INT_MAX) comm_fail(t, EX_SOFTWARE, "a packing is too large");
    }
    char *all = malloc(end + 1);
    if (!all) comm_fail(t, EX_SOFTWARE, "no memory for the messages of the ranks");
    if (size) memcpy(all + at[t->me].first, bytes, size);
    MPI_Type_contiguous(BLOCK, MPI_BYTE, &block), MPI_Type_commit(&block);
    MPI_Allgatherv(MPI_IN_PLACE, 0, block, all, blocks, first, block, t->mpi);
    MPI_Type_free(&block);
    comm_waited(t, since);
    t->bytes += (int64_t)size * (t->n - 1), t->messages += t->n - 1;
    free(blocks), free(first), free(sizes);
    return all;
}

void rank_small_begin(struct rank_small *y, struct comm *t)
{
    *y = (struct rank_small){ .ranks = { .me = t->me,
                                         .n = t->n,
                                         .most = most_of_ranks,
                                         .sum = sum_of_ranks,
                                         .send = send_to_rank,
                                         .receive = receive_from_rank,
                                         .gather = gather_ranks },
                              .comm = t };
    y->part.ranks = &y->ranks;
    for (int k = 0; k < RANK_SMALL_FLIES; k++) y->flies[k].request = MPI_REQUEST_NULL;
}

void rank_small_free(struct rank_small *y)
{
    for (int k = 0; k < RANK_SMALL_FLIES; k++) {
        // NOLINTNEXTLINE(clang-analyzer-optin.mpi.MPI-Checker): requests of earlier calls
        MPI_Wait(&y->flies[k].request, MPI_STATUS_IGNORE);
        free(y->flies[k].bytes);
    }
    packing_free(&y->p), contacts_free(&y->s), report_free(&y->report), step_forget(&y->memory);
    small_part_free(&y->part);
}

/* ---- steps ---- */

/* What the first rank alone knows of a step */
struct small_told {
    double small, bound;
    int32_t warm, small_warm, bare, compare, same;
};

int rank_small_make(struct rank_small *y, const struct rank_small_step *first,
                    const struct step_opt *o, bool *made, int64_t *parts, struct failure *failure)
{
    struct comm *t = y->comm;
    struct step_opt of_all = *o;
    const struct rank_small_step mine = { &y->p, &y->s, &y->memory, &y->report };
    const struct rank_small_step *step = t->me ? &mine : first;
    struct small_told told;
    memset(&told, 0, sizeof told);
    if (!t->me) {
        told.small = o->small, told.bound = o->bound, told.same = y->same;
        told.warm = o->warm, told.small_warm = o->small_warm;
        told.bare = o->bare, told.compare = o->compare;
    }
    const double since = comm_busy() - t->waited;
    const int64_t bytes = t->bytes, messages = t->messages;
    const double before = comm_busy();
    MPI_Bcast(&told, sizeof told, MPI_BYTE, 0, t->mpi);
    comm_waited(t, before);
    of_all.small = told.small, of_all.bound = told.bound, of_all.warm = told.warm;
    of_all.small_warm = told.small_warm, of_all.bare = told.bare, of_all.compare = told.compare;
    of_all.part = &y->part;
    if (!told.same)
        settings_spread_all(t, step->p), step_forget(&y->memory), small_part_free(&y->part);
    step_in_small(step->p, step->s, step->memory, &of_all, step->report, made, parts, failure);
    // what is wrong with the packing the first says; others wait
    if (t->me && failure->status == EX_SOFTWARE) comm_fail(t, failure->status, failure->text);
    y->same = *made;
    y->steps += step->report->small;
    y->bytes += t->bytes - bytes, y->messages += t->messages - messages;
    y->busy += comm_busy() - t->waited - since;
    return failure->status;
}
