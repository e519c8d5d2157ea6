/* mpi/comm.c: parcels over MPI [mpi/comm.h]. */
#include "mpi/comm.h"

#include "base/failure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    PIECE = 1 << 30, /* bytes of a message, at most: MPI counts them in an int */
    TAG = 7
};

void comm_fail(const struct comm *t, int status, const char *text)
{
    fprintf(stderr, "nsd-step: rank %d: %s\n", t->me, text);
    MPI_Abort(t->mpi, status);
    _Exit(status);
}

void *comm_new(const struct comm *t, int64_t n, size_t size)
{
    void *p = calloc((size_t)n + 1, size);
    if (!p) comm_fail(t, EX_SOFTWARE, "no memory");
    return p;
}

void parcel_put(struct comm *t, struct parcel *p, const void *from, size_t size)
{
    if (p->size + size > p->room) {
        p->room = p->size + size + p->room / 2 + 64;
        char *more = realloc(p->bytes, p->room);
        if (!more) comm_fail(t, EX_SOFTWARE, "no memory for the messages of the ranks");
        p->bytes = more;
    }
    if (size) memcpy(p->bytes + p->size, from, size);
    p->size += size;
}

void parcel_take(struct comm *t, struct parcel *p, void *to, size_t size)
{
    if (size > p->size - p->at) comm_fail(t, EX_SOFTWARE, "ranks disagree: a parcel is too short");
    if (size) memcpy(to, p->bytes + p->at, size);
    p->at += size;
}

void parcel_put_array(struct comm *t, struct parcel *p, const void *from, int64_t n, size_t size)
{
    parcel_put(t, p, &n, sizeof n);
    parcel_put(t, p, from, (size_t)n * size);
}

int64_t parcel_take_array(struct comm *t, struct parcel *p, void *to, size_t size)
{
    int64_t n;
    parcel_take(t, p, &n, sizeof n);
    if (n < 0 || (size_t)n > (p->size - p->at) / size)
        comm_fail(t, EX_SOFTWARE, "ranks disagree: an array is too short");
    void *a = comm_new(t, n, size);
    parcel_take(t, p, a, (size_t)n * size);
    memcpy(to, &a, sizeof a);
    return n;
}

void parcel_free(struct parcel *p)
{
    free(p->bytes);
    *p = (struct parcel){ 0 };
}

struct parcel *parcels_new(struct comm *t)
{
    return comm_new(t, t->n, sizeof(struct parcel));
}

void parcels_free(const struct comm *t, struct parcel *p)
{
    for (int k = 0; p && k < t->n; k++) parcel_free(&p[k]);
    free(p);
}

static int pieces(size_t size)
{
    return (int)((size + PIECE - 1) / PIECE);
}

static void send_all(struct comm *t, const struct parcel *p, int to, MPI_Request *r)
{
    for (size_t at = 0; at < p->size; at += PIECE) {
        size_t n = p->size - at < PIECE ? p->size - at : PIECE;
        MPI_Isend(p->bytes + at, (int)n, MPI_BYTE, to, TAG, t->mpi, r++);
        t->bytes += (int64_t)n, t->messages++;
    }
}

static void receive_all(struct comm *t, struct parcel *p, int64_t size, int from, MPI_Request *r)
{
    parcel_free(p);
    p->bytes = comm_new(t, size, 1);
    p->size = p->room = (size_t)size;
    for (size_t at = 0; at < p->size; at += PIECE) {
        size_t n = p->size - at < PIECE ? p->size - at : PIECE;
        MPI_Irecv(p->bytes + at, (int)n, MPI_BYTE, from, TAG, t->mpi, r++);
    }
}

/* What goes to and comes from each rank; sizes are known to both sides. */
static void pass(struct comm *t, struct parcel *out, struct parcel *in, const int64_t *come)
{
    int n = 0, k = 0;
    for (int q = 0; q < t->n; q++) n += pieces(out[q].size) + pieces((size_t)come[q]);
    MPI_Request *r = comm_new(t, n, sizeof(MPI_Request));
    for (int q = 0; q < t->n; q++) {
        if (q == t->me) continue;
        receive_all(t, &in[q], come[q], q, r + k), k += pieces((size_t)come[q]);
    }
    for (int q = 0; q < t->n; q++)
        if (q != t->me) send_all(t, &out[q], q, r + k), k += pieces(out[q].size);
    double since = comm_busy();
    MPI_Waitall(k, r, MPI_STATUSES_IGNORE);
    comm_waited(t, since);
    free(r);
    parcel_free(&in[t->me]);
    in[t->me] = out[t->me], out[t->me] = (struct parcel){ 0 };
    for (int q = 0; q < t->n; q++) parcel_free(&out[q]);
}

void comm_exchange(struct comm *t, struct parcel *out, struct parcel *in)
{
    int64_t *go = comm_new(t, t->n, sizeof *go), *come = comm_new(t, t->n, sizeof *come);
    for (int q = 0; q < t->n; q++) go[q] = (int64_t)out[q].size;
    double since = comm_busy();
    MPI_Alltoall(go, 1, MPI_INT64_T, come, 1, MPI_INT64_T, t->mpi);
    comm_waited(t, since);
    pass(t, out, in, come);
    free(go), free(come);
}

void comm_gather(struct comm *t, struct parcel *mine, struct parcel *in)
{
    struct parcel *out = parcels_new(t), *got = t->me ? parcels_new(t) : in;
    int64_t size = (int64_t)mine->size, *come = comm_new(t, t->n, sizeof *come);
    double since = comm_busy();
    MPI_Gather(&size, 1, MPI_INT64_T, come, 1, MPI_INT64_T, 0, t->mpi);
    comm_waited(t, since);
    out[0] = *mine, *mine = (struct parcel){ 0 };
    pass(t, out, got, come);
    if (t->me) parcels_free(t, got);
    parcels_free(t, out);
    free(come);
}

void comm_scatter(struct comm *t, struct parcel *out, struct parcel *mine)
{
    struct parcel *none = t->me ? parcels_new(t) : NULL, *in = parcels_new(t);
    int64_t *go = comm_new(t, t->n, sizeof *go), *come = comm_new(t, t->n, sizeof *come);
    for (int q = 0; q < t->n && !t->me; q++) go[q] = (int64_t)out[q].size;
    double since = comm_busy();
    MPI_Scatter(go, 1, MPI_INT64_T, come, 1, MPI_INT64_T, 0, t->mpi);
    comm_waited(t, since);
    pass(t, t->me ? none : out, in, come);
    parcel_free(mine);
    *mine = in[0], in[0] = (struct parcel){ 0 };
    parcels_free(t, none), parcels_free(t, in);
    free(go), free(come);
}

void comm_spread(struct comm *t, struct parcel *p)
{
    int64_t size = (int64_t)p->size;
    MPI_Bcast(&size, 1, MPI_INT64_T, 0, t->mpi);
    if (t->me) {
        parcel_free(p);
        p->bytes = comm_new(t, size, 1), p->size = p->room = (size_t)size;
    }
    for (size_t at = 0; at < p->size; at += PIECE) {
        size_t n = p->size - at < PIECE ? p->size - at : PIECE;
        MPI_Bcast(p->bytes + at, (int)n, MPI_BYTE, 0, t->mpi);
    }
    if (t->n > 1 && !t->me) t->bytes += size, t->messages++;
}

double comm_busy(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void comm_waited(struct comm *t, double since)
{
    t->waited += comm_busy() - since;
}

double comm_most(struct comm *t, double x)
{
    double most, since = comm_busy();
    MPI_Allreduce(&x, &most, 1, MPI_DOUBLE, MPI_MAX, t->mpi);
    comm_waited(t, since);
    return most;
}

int64_t comm_sum(struct comm *t, int64_t n)
{
    int64_t sum;
    double since = comm_busy();
    MPI_Allreduce(&n, &sum, 1, MPI_INT64_T, MPI_SUM, t->mpi);
    comm_waited(t, since);
    return sum;
}
