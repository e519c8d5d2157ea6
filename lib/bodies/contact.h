/* bodies/contact.h: contacts as they are detected, stored and shown: fat cold records. */
#ifndef NSD_CONTACT_H
#define NSD_CONTACT_H

#include "base/vec.h"
#include "base/why.h"

#include <stdbool.h>
#include <stdint.h>

struct contact {
    int32_t a, b; /* bodies, the normal points from a to b; wall w is -1-w and always a */
    vec3 x;       /* m: where it acts, in the predicted position */
    vec3 n, t1;   /* of the frame (n, t1, t2), right-handed; in the plane t1 = z x n, t2 = z */
    double gap;   /* m, predicted; < 0: overlap */
    double mu, en, et;
};

/* What a solve finds of a contact. Apart, for it takes room only when that is over. */
struct found {
    double r[3];   /* N s: reaction on b, components (n, t1, t2) */
    double u[3];   /* m/s: velocity of b relative to a as the law sees it, (u+ + e u-)/(1 + e) */
    int8_t status; /* enum local_status */
};

/* Sorted by (a, b) with walls first, each pair once. */
struct contacts {
    int64_t n, room;
    struct contact *c;
    struct found *found; /* [n]; NULL: not solved */
};

void contacts_free(struct contacts *);
/* Room for what will be found, zero; -1 when memory is short. */
int contacts_alloc_found(struct contacts *);
/* Not solved, again */
void contacts_free_found(struct contacts *);
/* to = a deep copy of from; to need not be initialised; -1 when memory is short. */
int contacts_copy(struct contacts *to, const struct contacts *from);
/* One more, zeroed but for a and b; NULL when memory is short. */
struct contact *contacts_add(struct contacts *, int32_t a, int32_t b);

/* Are the bodies there, all numbers finite and the frames orthonormal? Returns 0 or EX_DATAERR, naming
   the first contact that is not so. */
int contacts_check(const struct contacts *, int64_t bodies, int32_t walls, struct why *);

/* The frame of a unit normal, continuous but at n = -z. */
void contact_basis(struct contact *, int dim, vec3 n);
static inline vec3 contact_t2(const struct contact *c)
{
    return v3_cross(c->n, c->t1);
}

/* Reactions of old, turned into the frames of new, for the pairs that are in both; 0 for others. -1
   when memory is short. */
int contacts_match(struct contacts *new, const struct contacts *old);

#endif
