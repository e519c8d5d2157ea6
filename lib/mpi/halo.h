/*
 * mpi/halo.h: bodies' velocities on their way between ranks while contacts are solved. A wire leads to one
 * rank and carries, after each group of contacts, those that the other needs: nothing, mostly.
 */
#pragma once

#include "mpi/comm.h"
#include "mpi/subdomain.h"
#include "solve/exchange.h"
#include "solve/problem.h"

struct wire {
    int rank;
    int64_t *go,
        *come; /* [groups + 1] of group g: bodies go_body[go[g]] .. go_body[go[g + 1] - 1] */
    int32_t *go_body, *come_body;
    double *go_v, *come_v; /* [most of a group][6] */
};

struct halo {
    struct comm *comm;
    int64_t groups;
    int n;
    struct wire *wire; /* [n] */
    MPI_Request *request;
    int requests;
};

/* A body that is to be told to a rank after a group */
struct halo_item {
    int64_t group;
    int32_t rank, body;
};

/* Collective. errand[n], in the order of groups for each rank, of bodies that this rank owns; the others learn
   from it what will come. */
void halo_lay(struct halo *w, const struct subdomain *y, int64_t groups, int64_t n,
              const struct halo_item *errand);
void halo_free(struct halo *w);
/* Sends what goes after group g, and waits for what comes: between them there is time for other work. */
void halo_send(struct halo *w, const struct problem *p, int64_t g);
void halo_wait(struct halo *w, struct problem *p, int64_t g);
/* All copies become what their bodies are. */
void halo_refresh(const struct subdomain *y, struct problem *p);

/* What solvers ask [solve/exchange.h] that ranks answer alike, in whatever order they solve. */

/* Sets s->with, most, count, agree and fail. */
void answers_alike(struct exchange *s, struct comm *t);
