/* state/contact.h: contacts as they are detected, stored in documents and shown. */
#pragma once

#include "base/failure.h"
#include "base/vec.h"
#include "state/pair_columns.h"

#include <stdbool.h>
#include <stdint.h>

struct contact {
    int32_t a, b;    /* bodies; the normal points from a to b. Wall w is -1-w and always a. */
    int32_t feature; /* tells apart the contacts of one pair, and lasts from step to step: a
                        triangle of a mesh; 0 where a pair has one contact */
    int8_t shift[3]; /* of the cell: b is met at x_b + sum of shift[k] edge[k] */
    vec3 x;          /* m: the point of contact, between the bodies at their predicted positions */
    vec3 n, t1;      /* of the right-handed basis (n, t1, t2); in the plane t1 = z x n, t2 = z */
    double gap;      /* m, predicted; < 0: overlap */
    EACH_PAIR_COLUMN(PAIR_NUMBER) /* mu, en, et: of the materials of its bodies */
};

/* What a solver finds at a contact. Apart, so that it takes memory only after a solve. */
struct found {
    double r[3];   /* N s: reaction on b, components (n, t1, t2) */
    double u[3];   /* m/s: velocity of b relative to a as the law sees it, (u+ + e u-)/(1 + e) */
    int8_t status; /* enum local_status */
};

/* States beyond the law's: the contact has no solution, its reaction has grown without end [solve/judge.h]; or its
   reaction is the sum of those of parts of a step [step/substeps.h], each of which had a state of its own. */
enum { STATUS_JAMMED = 3, STATUS_SUMMED = 4 };

/* Of a contact's tie: what is kept of it, and what is new in this step */
enum {
    CONTACT_LAW_WET = 1,
    CONTACT_LAW_BONDED = 2,
    CONTACT_LAW_NEW_BRIDGE = 4,
    CONTACT_LAW_MEETS = 8, /* an impact of bodies that push no spring yet [contact/spring.h] */
    CONTACT_LAW_STATES = 16
};

/* What laws beyond friction and restitution do at a contact [contact/contact_law.h]. Apart, so that it takes
   memory only where there are such laws. */
struct contact_law {
    double pull;       /* N: f_c */
    double stiff[2];   /* N/m: S beta^2 c_n, S beta^2 c_t */
    double jump[3];    /* m: d, in the contact's basis; of springs, how far they are stretched */
    double beta;       /* intensity of adhesion at the beginning of the step */
    double offset;     /* m/s: what Signorini's condition adds to u_n, because the pair is apart */
    double mu_r, mu_p; /* m: rolling and pivoting friction */
    double spring[2];  /* N/m: k_n, k_t of the contact; 0: rigid */
    double hit[3];     /* N s: the impulse of the impact, were the pair alone */
    double roll;       /* N m: stiffness of the contact's moment; 0: rigid */
    double turn[3];    /* rad: how far its spring is turned, b against a, in the contact's basis */
    int8_t state;      /* CONTACT_LAW_... */
};

/* What tells contacts apart, as in struct contact */
struct contact_key {
    int32_t a, b, feature;
    int8_t shift[3];
};
static inline struct contact_key contact_key(const struct contact *c)
{
    return (
        struct contact_key){ c->a, c->b, c->feature, { c->shift[0], c->shift[1], c->shift[2] } };
}
/* < 0, 0, > 0: x comes before y, is y, comes after it */
static inline int contact_key_order(struct contact_key x, struct contact_key y)
{
    if (x.a != y.a) return x.a < y.a ? -1 : 1;
    if (x.b != y.b) return x.b < y.b ? -1 : 1;
    if (x.feature != y.feature) return x.feature < y.feature ? -1 : 1;
    for (int k = 0; k < 3; k++)
        if (x.shift[k] != y.shift[k]) return x.shift[k] < y.shift[k] ? -1 : 1;
    return 0;
}

static inline int contact_compare(const struct contact *c, const struct contact *d)
{
    return contact_key_order(contact_key(c), contact_key(d));
}

/* Is b an image? */
static inline bool contact_shifted(const struct contact *c)
{
    return c->shift[0] || c->shift[1] || c->shift[2];
}

/* Sorted by their keys, a first, so that walls come first; each key occurs once. */
struct contacts {
    int64_t n, room;     /* contacts; how many c has memory for */
    struct contact *c;   /* [n] */
    struct found *found; /* [n]; NULL: not solved */
    double (*moment)[3]; /* [n] N m s: on b, in (n, t1, t2); NULL: not solved, or without moments */
    struct contact_law *law; /* [n]; NULL: friction and restitution are all */
};

void contacts_free(struct contacts *contacts);
/* found[n], all zero, in place of the old one; -1 when memory is short. */
int contacts_alloc_found(struct contacts *contacts);
/* moment[n], likewise */
int contacts_alloc_moment(struct contacts *contacts);
/* tie[n], all zero, in place of the old ones; -1 when memory is short. */
int contacts_alloc_laws(struct contacts *contacts);
void contacts_free_tie(struct contacts *contacts);
/* found and moment */
void contacts_free_found(struct contacts *contacts);
/* to = a deep copy of from; to need not be initialised; -1 when memory is short. */
int contacts_copy(struct contacts *to, const struct contacts *from);
/* Appends a contact, zero but for a and b; NULL when memory is short. */
struct contact *contacts_add(struct contacts *contacts, int32_t a, int32_t b);
/* Sorts the new last contact among those of its pair, of which each key is there once: the deeper of two is
   kept. */
void contacts_settle(struct contacts *contacts);
/* Makes room for so many more; false when memory is short. */
bool contacts_reserve(struct contacts *contacts, int64_t more);

/* Do bodies and walls exist, are numbers finite and in range, bases orthonormal (to 1e-6)?
   Returns 0, or EX_DATAERR with the first contact that fails. */
int contacts_check(const struct contacts *contacts, int64_t bodies, int32_t walls,
                   struct failure *failure);

/* c->n = n, a unit vector, and c->t1: in the plane as above, in space as [Duff et al. 2017], which
   is continuous in n but where n_z changes sign. */
void contact_basis(struct contact *c, int dim, vec3 n);
static inline vec3 contact_t2(const struct contact *c)
{
    return v3_cross(c->n, c->t1);
}

/* Are they of a step in substeps, whose reactions are sums and no solution of one problem? */
static inline bool contacts_summed(const struct contacts *s)
{
    return s->found && s->n && s->found[0].status == STATUS_SUMMED;
}

/* A vector (n, t1, t2) of the contact's basis, in space */
static inline vec3 contact_in_space(const struct contact *c, const double r[3])
{
    vec3 normal = v3_scale(r[0], c->n);
    return v3_axpy(v3_axpy(normal, r[1], c->t1), r[2], contact_t2(c));
}

/* The solved contact that is farthest from its law: the jammed one of the largest reaction, else the one whose bodies
   approach fastest; -1: there is none. *off: by how much, to compare contacts of several lists. */
int64_t contacts_unsolved(const struct contacts *contacts, double *off);

/* m: the deepest overlap, 0 where there is none */
double contacts_max_overlap(const struct contacts *contacts);

/* The lever arms la, lb (m) of a contact between bodies whose centres are at xa and, that of the image
   that a meets, xb (m), along its normal; a wall has none: la = 0, whatever xa. */
void contact_arms(const struct contact *c, vec3 xa, vec3 xb, double *la, double *lb);
