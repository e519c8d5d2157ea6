/*
 * mpi/comm.h: what the ranks of a run tell each other: parcels of bytes, to and from each other, to the
 * first and from it; and how much that was.
 *
 * All functions are collective, unless they say otherwise: every rank calls them in the same order. Where
 * memory is short, or a message is not what was expected, the whole run ends (comm_fail).
 */
#pragma once

#include <mpi.h>
#include <stddef.h>
#include <stdint.h>

struct comm {
    MPI_Comm mpi;
    int me, n; /* this rank, of how many; 0 leads */
    /* Sent by this rank to others so far, point to point: what sums and decisions of all send, a few numbers
       each, is the library's own affair. */
    int64_t bytes, messages;
    double waited; /* s of this processor's time in which this rank has waited for others */
};

/* Bytes that grow; all zero to begin with. */
struct parcel {
    char *bytes;
    size_t size, room, at; /* at: how far they have been taken */
};

/* Appends, and takes from the front; neither is collective. */
void parcel_put(struct comm *t, struct parcel *p, const void *from, size_t size);
void parcel_take(struct comm *t, struct parcel *p, void *to, size_t size);
/* The same of whole arrays: a number and its elements; *to is allocated, [n + 1]. */
void parcel_put_array(struct comm *t, struct parcel *p, const void *from, int64_t n, size_t size);
int64_t parcel_take_array(struct comm *t, struct parcel *p, void *to, size_t size);
void parcel_free(struct parcel *p);

/* n parcels, all empty; and back. Not collective. */
struct parcel *parcels_new(struct comm *t);
void parcels_free(const struct comm *t, struct parcel *p);

/* in[k] = what rank k has put into its out[me]; out[] is emptied. */
void comm_exchange(struct comm *t, struct parcel *out, struct parcel *in);
/* The same between two ranks and no others, in one direction: of all to the first, of the first to all. */
void comm_gather(struct comm *t, struct parcel *mine, struct parcel *in);
void comm_scatter(struct comm *t, struct parcel *out, struct parcel *mine);
/* Everybody gets what the first has in it. */
void comm_spread(struct comm *t, struct parcel *p);

/* s of the processor's time that this thread has had; counts those since then as waited. Not collective */
double comm_busy(void);
void comm_waited(struct comm *t, double since);

double comm_most(struct comm *t, double x);
int64_t comm_sum(struct comm *t, int64_t n);

/* Ends all ranks with this status, and says why; not collective, and does not return. */
void comm_fail(const struct comm *t, int status, const char *text) __attribute__((noreturn));
/* malloc and calloc of n + 1 elements that end the run where memory is short */
void *comm_new(const struct comm *t, int64_t n, size_t size);
