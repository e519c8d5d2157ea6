/*
 * ranks/talk.h: what the ranks of a run tell each other: parcels of bytes, to and from each other, to the
 * first and from it; and how much that was.
 *
 * All functions are collective, unless they say otherwise: every rank calls them in the same order. Where
 * memory is short, or a message is not what was expected, the whole run ends (talk_fail).
 */
#ifndef NSD_TALK_H
#define NSD_TALK_H

#include <mpi.h>
#include <stddef.h>
#include <stdint.h>

struct talk {
    MPI_Comm comm;
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
void parcel_put(struct talk *t, struct parcel *p, const void *from, size_t size);
void parcel_take(struct talk *t, struct parcel *p, void *to, size_t size);
/* The same of whole arrays: a number and its elements; *to is allocated, [n + 1]. */
void parcel_put_array(struct talk *t, struct parcel *p, const void *from, int64_t n, size_t size);
int64_t parcel_take_array(struct talk *t, struct parcel *p, void *to, size_t size);
void parcel_free(struct parcel *p);

/* n parcels, all empty; and back. Not collective. */
struct parcel *parcels_new(struct talk *t);
void parcels_free(const struct talk *t, struct parcel *p);

/* in[k] = what rank k has put into its out[me]; out[] is emptied. */
void talk_exchange(struct talk *t, struct parcel *out, struct parcel *in);
/* The same between two ranks and no others, in one direction: of all to the first, of the first to all. */
void talk_gather(struct talk *t, struct parcel *mine, struct parcel *in);
void talk_scatter(struct talk *t, struct parcel *out, struct parcel *mine);
/* Everybody gets what the first has in it. */
void talk_spread(struct talk *t, struct parcel *p);

/* s of the processor's time that this thread has had; counts those since then as waited. Not collective */
double talk_busy(void);
void talk_waited(struct talk *t, double since);

double talk_most(struct talk *t, double x);
int64_t talk_sum(struct talk *t, int64_t n);

/* Ends all ranks with this status, and says why; not collective, and does not return. */
void talk_fail(const struct talk *t, int status, const char *text) __attribute__((noreturn));
/* malloc and calloc of n + 1 elements that end the run where memory is short */
void *talk_new(const struct talk *t, int64_t n, size_t size);

#endif
