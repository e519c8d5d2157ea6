/*
 * state/bond.h: what lasts of a pair from one step to the next: a liquid bridge, the intensity of
 * adhesion. Found again by the key of the pair's contact.
 */
#pragma once

#include "base/failure.h"
#include "base/vec.h"
#include "state/contact.h"

/* Of a bond: there is a liquid bridge, also one that is new, whose energy has not been accounted for */
enum { BOND_WET = 1, BOND_WETTED };

struct bond {
    int32_t a, b, feature; /* the key, as in struct contact */
    int8_t shift[3];
    int8_t wet;     /* BOND_WET ...; 0: no liquid bridge */
    int8_t pressed; /* 1: a contact with a stiffness, which pushes, or overlaps from the start; 0 */
    double beta;    /* intensity of adhesion; 0 where there is none, or it is broken */
    double gap;     /* m: expected at the next step, at the predicted positions */
    vec3 n;         /* the contact's normal when this was kept */
    vec3 slip;      /* m: across n: how far the bond, or the spring, is sheared, b against a */
    double rest;    /* m, at most 0: the gap at which the spring does not push */
    double spring;  /* N/m: k_n of the last step, where the step decides it; else 0 */
    vec3 turn;      /* rad: how far the spring of the moment is turned, b against a */
    /* Of grains that are no balls, a bond keeps the place where it was made [contact/bond_anchor.h]. */
    double area;     /* m^2; 0: none has been kept, and what follows is 0 */
    vec3 at_a, at_b; /* m: in the frames of a, a body or a wall, and of b */
    vec3 axis;       /* the normal in the frame of b */
};

static inline bool bond_anchored(const struct bond *x)
{
    return x->area > 0;
}

static inline struct contact_key bond_key(const struct bond *x)
{
    return (
        struct contact_key){ x->a, x->b, x->feature, { x->shift[0], x->shift[1], x->shift[2] } };
}

/* Sorted as contacts are, each key once. */
struct bonds {
    int64_t n, room;
    struct bond *bond; /* [n] */
};

void bonds_free(struct bonds *bonds);
/* Appends one; NULL when memory is short. */
struct bond *bonds_add(struct bonds *bonds, const struct bond *bond);
/* Back into order, after keys have changed */
void bonds_sort(struct bonds *bonds);
/* That of a contact, or NULL. *from, 0 at first, is where to look from on: contacts are asked for in
   their order. */
const struct bond *bonds_find(const struct bonds *bonds, const struct contact *c, int64_t *from);

/* Has an anchored bond of this pair broken, which is still remembered? from: as above */
bool bonds_broken(const struct bonds *bonds, int32_t a, int32_t b, int64_t from);

/* Do bodies and walls exist, are keys in order, numbers in range, and where dim is 2 places in the plane?
   Returns 0, or EX_DATAERR with the first bond that fails. */
int bonds_check(const struct bonds *bonds, int dim, int64_t bodies, int32_t walls,
                struct failure *failure);
