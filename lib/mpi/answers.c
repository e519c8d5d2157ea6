/* mpi/answers.c: what ranks answer alike [mpi/answers.h]. */
#include "mpi/answers.h"

#include "base/failure.h"

static double most(struct exchange *s, double x)
{
    return comm_most(s->with, x);
}

static int64_t halo_count(struct exchange *s, int64_t n)
{
    return comm_sum(s->with, n);
}

static double agree(struct exchange *s, double x)
{
    double since = comm_busy();
    struct comm *t = s->with;
    MPI_Bcast(&x, 1, MPI_DOUBLE, 0, t->mpi);
    comm_waited(t, since);
    return x;
}

static void halo_fail(struct exchange *s)
{
    comm_fail(s->with, EX_SOFTWARE, "no memory to solve the contacts");
}

void answers_alike(struct exchange *s, struct comm *t)
{
    s->with = t, s->most = most, s->count = halo_count, s->agree = agree, s->fail = halo_fail;
}
