/*
 * mpi/subdomain.h: what a rank has of a packing: the bodies in its territory, which it owns, and copies of those
 * of others that may meet them. Bodies lie in the order of their rows in the whole packing, so that contacts
 * are found in the order in which one process would find them.
 */
#pragma once

#include "mpi/decomposition.h"
#include "state/contact.h"
#include "state/packing.h"

/* Bodies that are here and at another rank too, in the order of rows */
struct border {
    int64_t n;
    int32_t *body; /* [n] of this rank's packing */
};

/* Of all ranks; not collective */
void borders_free(const struct comm *t, struct border *b);

struct subdomain {
    struct comm *comm;
    struct decomposition *territory;
    struct packing p; /* own bodies and copies */
    int64_t all;      /* bodies of the whole */
    int64_t own;
    int32_t *row;        /* [p.n] in the whole, ascending */
    int32_t *owner;      /* [p.n] rank */
    struct border *lent; /* [ranks] own bodies that rank q has copies of */
    struct border *here; /* [ranks] copies of bodies of rank q */
    double margin; /* m: that bodies may come nearer to each other before they are dealt again */
    vec3 *dealt;   /* [p.n] m: where they were when they were dealt */
    int32_t *load; /* [p.n] contacts of a body when they were last counted */
    struct whole whole; /* p.whole */
    int64_t deals;      /* how often bodies were dealt, and divided again */
    int64_t cuts;
};

/* The first rank's packing becomes parts: its bodies are copied from it, and it stays as it is. Those of the
   others are not looked at. space is taken over. Collective, as all that follows. */
void subdomain_begin(struct subdomain *y, struct comm *t, struct decomposition *space,
                     const struct packing *whole);
void subdomain_free(struct subdomain *y);
/* Rows of the bodies that a rank has */
struct own_rows {
    const struct packing *p; /* of these bodies */
    int64_t first, all;      /* the row of its first body; rows of all ranks */
};
/* The same where each rank has some rows of the bodies: they become its own. settings: the first rank's packing, all
   but its bodies. */
void subdomain_begin_rows(struct subdomain *y, struct comm *t, struct decomposition *space,
                          const struct packing *settings, const struct own_rows *rows);
/* The same of a packing that has other bodies than before */
void subdomain_begin_again(struct subdomain *y, const struct packing *whole);

/* y->whole of all, again */
void subdomain_measure(struct subdomain *y);
/* Deals the bodies so that every pair with a gap of at most `reach` (m) at the predicted positions meets in
   the owners of both, now and until bodies have gone half the margin. Returns whether it had to. */
bool subdomain_deal(struct subdomain *y, double reach);

/* Own bodies' contacts per rank, the largest over the mean: 1 is balanced. Notes them for the next cut. */
double subdomain_imbalance(struct subdomain *y, const struct contacts *s);
/* New cuts, by what was noted; bodies are dealt at the next subdomain_deal(). */
void subdomain_recut(struct subdomain *y);

/* What a program does to the first rank's packing as a step begins. scattered: no rank has the bodies of whole, on
   which nothing acts then. */
void subdomain_act(struct subdomain *y, const struct packing *whole, bool scattered);
/* Where bodies are and how they move, of the first rank's whole packing; and the same back */
void subdomain_follow(struct subdomain *y, const struct packing *whole);
void subdomain_collect(const struct subdomain *y, struct packing *whole);
/* Copies become what the bodies are: their places and motion. */
void subdomain_refresh(struct subdomain *y);

/* The body of this rank's packing that has this row in the whole; -1: it is not here. Not collective */
int32_t subdomain_find(const struct subdomain *y, int32_t row);

/* Whose is the contact of this rank's packing? That of b counts it. */
static inline bool subdomain_counts(const struct subdomain *y, const struct contact *c)
{
    return y->owner[c->b] == y->comm->me;
}
/* Has this rank a body in it? */
static inline bool subdomain_has(const struct subdomain *y, const struct contact *c)
{
    return subdomain_counts(y, c) || (c->a >= 0 && y->owner[c->a] == y->comm->me);
}
