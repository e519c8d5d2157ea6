/*
 * step/small_part.h: small steps that several processes divide, with the same bytes for any number of them.
 *
 * Each process has the whole packing and makes the same list, with the same groups. The bodies are divided by where they are; a process
 * sweeps the pairs in which it owns a body, in the order of one process, and moves its own bodies. A pair whose bodies belong to two
 * processes is swept by both, alike. For that a process has copies of the other's bodies: before a group in which a
 * copy is swept, its owner tells what pairs have made of it of which the copy's process knows nothing. The list says which bodies these
 * are, so that processes agree without asking. A group is swept in two parts: first the pairs after which something is to be told,
 * then, while messages fly, the others.
 *
 * Sums over bodies are sums of integers, or are made of what all processes have collected, in the order of one.
 */
#pragma once

#include "step/small_run.h"

struct gathered {
    size_t first, size;
};

/* What processes tell each other; all is collective but send() and receive() */
struct small_ranks {
    int me, n;
    /* x[n] = the largest of all, element by element */
    void (*most)(struct small_ranks *y, double *x, int n);
    int64_t (*sum)(struct small_ranks *y, int64_t x);
    /* Messages to a rank arrive in their order; `bytes` may be changed afterwards. */
    void (*send)(struct small_ranks *y, int rank, const void *bytes, size_t size);
    void (*receive)(struct small_ranks *y, int rank, void *bytes, size_t size);
    /* The bytes of all, to be freed; at[n]: where those of each rank are. NULL: memory was short */
    char *(*gather)(struct small_ranks *y, const void *bytes, size_t size, struct gathered *at);
};

/* Doubles of a message, of each body at most */
enum { MESSAGE = 16 };

/* In a group: pairs after which something is told, others, and those of other processes alone */
enum pair_kind { PAIR_EARLY, PAIR_LATER, PAIR_FOREIGN };

/* Bodies on their way between this process and another one, which is its neighbour. Phase 0 comes after the touches of a sweep,
   phase g + 1 with group g. */
struct small_wire {
    int rank;
    int64_t *go, *come; /* [phases + 1] bodies go_body[go[k]] .. of phase k */
    int32_t *go_body, *come_body;
    int64_t lends, borrows; /* own bodies that it has copies of, and copies here */
    int32_t *lend, *borrow;
};

struct small_part {
    struct small_ranks *ranks;
    int64_t bodies, lists; /* lists made since the bodies were divided; 0: they are to be */
    int32_t *owner;        /* [bodies] */
    int64_t owns;
    int32_t *own; /* [owns] this process's bodies */
    int64_t phases;
    int wires;
    struct small_wire *wire; /* [wires] */
    int64_t *along;          /* [pairs] pairs in the order of one process's slots */
    int64_t *pair;           /* [lanes] the pair in a slot; -1: none */
    double *message;         /* [MESSAGE (1 + the bodies of the longest)] */
};

/* Bodies of this process, and the k-th of them */
static inline int64_t small_bodies_here(const struct small_run *r)
{
    return r->part ? r->part->owns : r->l->s.bodies;
}
static inline int64_t small_body_here(const struct small_run *r, int64_t k)
{
    return r->part ? r->part->own[k] : k;
}

/* Is body i this process's own? */
static inline bool small_is_own(const struct small_run *r, int64_t i)
{
    return !r->part || r->part->owner[i] == r->part->ranks->me;
}

/* N s: the reaction in lane i, along the slots of one process, of the bundles of the list or of a copy */
static inline vec3 small_along(const struct small_run *r, const struct small_bundle *bundle,
                               int64_t i)
{
    const int64_t slot = r->part ? r->l->slot[r->part->along[i]] : i;
    const struct small_bundle *c = &bundle[slot / BUNDLE];
    const int k = (int)(slot % BUNDLE);
    return v3(c->f[0][k], c->f[1][k], c->f[2][k]);
}

/* What each process has found of the pairs becomes the list of all, unless one has failed. Returns 0 or a status. */
int small_part_join(struct pairs *s, struct small_ranks *ranks, struct failure *failure);
/* The pairs of l, in groups in[pairs], are divided: their kinds. False when memory is short. */
bool small_part_divide(struct small_part *y, const struct small_list *l, const int64_t *in,
                       uint8_t *kind);
/* Pairs have their slots. False when memory is short. */
bool small_part_laid(struct small_part *y, const struct small_list *l);
void small_part_free(struct small_part *y);

/* A small step begins: copies are where their bodies are, with their velocities before it. */
void small_part_begin(struct small_run *r);
/* In a sweep: what goes in a phase, and what comes, for which this waits */
void small_part_send(struct small_run *r, int64_t phase);
void small_part_receive(struct small_run *r, int64_t phase);
/* All copies move as their bodies do. */
void small_part_refresh(struct small_run *r);
/* Everybody has all bodies, touches and pairs as their owners have them. False when memory is short. */
bool small_part_collect(struct small_run *r);
